// URIs -> bytes: data URIs, and files that may not lie outside the glTF's folder.
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "plugin/base64.h"
#include "plugin/check_document.h"
#include "plugin/document.h"

namespace gltf_radiosity {
namespace {

/// 0 to 15, or -1.
int value_of_hex_digit(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

std::string decode_percent(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? value_of_hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? value_of_hex_digit(text[i + 2]) : -1;
    if (low < 0) {
      decoded += text[i];
    } else {
      decoded += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return decoded;
}

/// "http:", "file:", "C:" ...
bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.find_first_of("/?#%") > colon;
}

/// For messages: long URIs cut short, nothing that could upset a terminal.
std::string printable(std::string_view uri) {
  std::string text(uri.substr(0, 80));
  for (char& character : text) {
    if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f) character = '?';
  }
  return uri.size() > 80 ? text + "..." : text;
}

bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const auto mismatch = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return mismatch.first == folder.end() || (mismatch.first->empty() && std::next(mismatch.first) == folder.end());
}

}  // namespace

Result<std::filesystem::path> resolve_uri(const std::string& uri, const std::filesystem::path& folder,
                                          const std::string& place) {
  // What the text alone says.
  const std::string name = decode_percent(uri);
  if (has_scheme(uri)) return bad_input(place, fmt::format("\"{}\" is not a file beside the glTF", printable(uri)));
  if (name.empty() || name.find('\0') != std::string::npos) return bad_input(place, "the uri names no file");
  if (folder.empty()) {
    return bad_input(place,
                     fmt::format("refers to the file \"{}\", but a glTF in memory has no folder", printable(name)));
  }
  const std::filesystem::path relative(name);
  const std::filesystem::path normal = relative.lexically_normal();
  if (relative.is_absolute() || (!normal.empty() && *normal.begin() == "..")) {
    return bad_input(place, fmt::format("\"{}\" lies outside the glTF's folder", printable(name)));
  }

  // What the file system says: symbolic links may not lead out either.
  std::error_code error;
  const std::filesystem::path jail = std::filesystem::weakly_canonical(folder, error);
  const std::filesystem::path file = error ? normal : std::filesystem::weakly_canonical(folder / normal, error);
  if (error || !std::filesystem::is_regular_file(file, error)) {
    return bad_input(place, fmt::format("the file \"{}\" is missing", printable(name)));
  }
  if (!lies_in(file, jail))
    return bad_input(place, fmt::format("\"{}\" lies outside the glTF's folder", printable(name)));
  return file;
}

Result<Bytes> read_file(const std::filesystem::path& file, const std::string& place) {
  const std::string shown = place.empty() ? file.string() : place;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return bad_input(shown, "the file does not exist");
  if (std::filesystem::is_directory(file, error)) return bad_input(shown, "is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return bad_input(shown, "the file cannot be opened");
  // Read in blocks: pipes have no size.
  Bytes bytes;
  if (const auto size = std::filesystem::file_size(file, error); !error) bytes.reserve(size);
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
    bytes.insert(bytes.end(), block.data(), block.data() + stream.gcount());
  }
  if (stream.bad()) return bad_input(shown, "the file cannot be read");
  return bytes;
}

Result<Bytes> read_uri(const std::string& uri, const std::filesystem::path& folder, const std::string& place) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) {
      return bad_input(place, "the data URI is not base64");
    }
    auto bytes = decode_base64(std::string_view(uri).substr(comma + 1));
    if (!bytes) return bad_input(place, "the data URI is broken base64");
    return std::move(*bytes);
  }
  const Result<std::filesystem::path> file = resolve_uri(uri, folder, place);
  if (!file) return file.error();
  return read_file(*file, place);
}

Result<Bytes> image_bytes(const Document& document, std::size_t image) {
  const Json& json = document.json["images"][image];
  if (!json.contains("bufferView")) {
    return read_uri(json["uri"].get<std::string>(), document.folder, place_of("images", image));
  }
  const Json& view = document.json["bufferViews"][json["bufferView"].get<std::size_t>()];
  const Bytes& buffer = document.buffers[view["buffer"].get<std::size_t>()];
  const auto first = buffer.begin() + static_cast<std::ptrdiff_t>(view.value("byteOffset", std::size_t{0}));
  return Bytes(first, first + static_cast<std::ptrdiff_t>(view["byteLength"].get<std::size_t>()));
}

}  // namespace gltf_radiosity
