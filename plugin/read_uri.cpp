// URIs -> bytes: data URIs, and files that may not lie outside the glTF's folder.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "plugin/check_document.h"
#include "plugin/document.h"

namespace gltf_radiosity {
namespace {

int digit_of(char character, int base) {
  if (base == 64) {
    if (character >= 'A' && character <= 'Z') return character - 'A';
    if (character >= 'a' && character <= 'z') return character - 'a' + 26;
    if (character >= '0' && character <= '9') return character - '0' + 52;
    if (character == '+' || character == '-') return 62;
    if (character == '/' || character == '_') return 63;
    return -1;
  }
  if (character >= '0' && character <= '9') return character - '0';
  if (character >= 'a' && character <= 'f') return character - 'a' + 10;
  if (character >= 'A' && character <= 'F') return character - 'A' + 10;
  return -1;
}

std::optional<Bytes> decode_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t group = 0;
  int bits = 0;
  for (const char character : text) {
    const int digit = digit_of(character, 64);
    if (digit < 0) return std::nullopt;
    group = (group << 6) | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(group >> bits));
  }
  return bytes;
}

std::string decode_percent(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? digit_of(text[i + 1], 16) : -1;
    const int low = high >= 0 ? digit_of(text[i + 2], 16) : -1;
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
