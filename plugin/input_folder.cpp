#include "plugin/input_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "plugin/descriptor.h"

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;

int hex_digit(char character) {
  if (character >= '0' && character <= '9') return character - '0';
  if (character >= 'a' && character <= 'f') return character - 'a' + 10;
  if (character >= 'A' && character <= 'F') return character - 'A' + 10;
  return -1;
}

std::string decode_percent(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
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
  return colon != std::string_view::npos && uri.find_first_of("/\\?#%") > colon;
}

/// For messages: long URIs cut short, nothing that could upset a terminal.
std::string printable(std::string_view uri) {
  std::string text(uri.substr(0, 80));
  for (char& character : text) {
    if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f) character = '?';
  }
  return uri.size() > 80 ? text + "..." : text;
}

/// Whether the name alone leads out: an absolute path or more `..` than folders; also where a backslash separates
/// folders, as it does to those who get the file next.
bool leads_out(const std::string& name) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  return std::ranges::any_of(std::array{name, slashes}, [](const std::string& text) {
    const fs::path normal = fs::path(text).lexically_normal();
    return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
  });
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  const auto mismatch = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return mismatch.first == folder.end() || (mismatch.first->empty() && std::next(mismatch.first) == folder.end());
}

/// Opens a path without symbolic links below `folder`, and follows none. (openat2 with RESOLVE_BENEATH would do the
/// same in one step, but refuses absolute links that stay inside and is missing or forbidden in many containers.)
Descriptor open_below(const fs::path& folder, const fs::path& relative) {
  constexpr int kFolder = O_PATH | O_DIRECTORY | O_CLOEXEC;
  Descriptor at(::open(folder.c_str(), kFolder));
  const fs::path parent = relative.parent_path();
  for (const fs::path& name : parent) {
    if (at.is_open()) at = Descriptor(::openat(at.get(), name.c_str(), kFolder | O_NOFOLLOW));
  }
  if (!at.is_open()) return at;
  return Descriptor(::openat(at.get(), relative.filename().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
}

bool is_regular(const Descriptor& file) {
  struct stat status {};
  return ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode);
}

Result<std::vector<std::uint8_t>> read_open_file(const Descriptor& file, const std::string& place,
                                                 std::uint64_t max_bytes) {
  std::vector<std::uint8_t> bytes;
  switch (const int code = file.read_all(max_bytes, bytes)) {
    case 0:
      return bytes;
    case EFBIG:
      return Error{ErrorCode::kLimit, place,
                   fmt::format("the file is too large: of --max-memory {} bytes are left", max_bytes)};
    case EISDIR:
      return bad_input(place, "is a folder");
    default:
      return bad_input(place, "the file cannot be read: " + std::generic_category().message(code));
  }
}

}  // namespace

Result<fs::path> resolve_uri(const std::string& uri, const InputFolder& folder, const std::string& place) {
  // What the text alone says.
  if (has_scheme(uri)) return bad_input(place, fmt::format("\"{}\" is not a file beside the glTF", printable(uri)));
  const std::string name = decode_percent(uri);
  if (name.empty() || name.find('\0') != std::string::npos) return bad_input(place, "the uri names no file");
  if (folder.path.empty()) {
    return bad_input(place,
                     fmt::format("refers to the file \"{}\", but a glTF in memory has no folder", printable(name)));
  }
  const Error outside =
      bad_input(place, fmt::format("\"{}\" lies outside the glTF's folder (--allow-outside)", printable(name)));
  if (!folder.may_leave && leads_out(name)) return outside;

  // What the file system says: symbolic links may not lead out either.
  std::error_code error;
  const fs::path jail = fs::weakly_canonical(folder.path, error);
  const fs::path file = error ? fs::path(name) : fs::weakly_canonical(folder.path / fs::path(name), error);
  if (error || !fs::exists(file, error)) {
    return bad_input(place, fmt::format("the file \"{}\" is missing", printable(name)));
  }
  if (!folder.may_leave && !lies_in(file, jail)) return outside;
  if (!fs::is_regular_file(file, error)) return bad_input(place, fmt::format("\"{}\" is no file", printable(name)));
  return file;
}

Result<std::vector<std::uint8_t>> read_file_of_uri(const std::string& uri, const InputFolder& folder,
                                                   const std::string& place) {
  const Result<fs::path> file = resolve_uri(uri, folder, place);
  if (!file) return file.error();
  const Error changed = bad_input(place, fmt::format("\"{}\" cannot be opened", printable(uri)));
  std::error_code error;
  const fs::path start = folder.may_leave ? fs::path("/") : fs::weakly_canonical(folder.path, error);
  if (error) return changed;
  const Descriptor open_file = open_below(start, file->lexically_relative(start));
  if (!open_file.is_open() || !is_regular(open_file)) return changed;
  return read_open_file(open_file, place, folder.max_bytes);
}

Result<Done> check_that_inputs_are_spared(std::span<const fs::path> inputs, std::span<const std::string> outputs) {
  for (const std::string& output : outputs) {
    std::error_code error;
    const auto is_output = [&](const fs::path& input) { return fs::equivalent(input, output, error) && !error; };
    if (std::ranges::none_of(inputs, is_output)) continue;
    return Error{ErrorCode::kBadOption, output, "would replace the input or a file that it refers to"};
  }
  return Done{};
}

Result<std::vector<std::uint8_t>> read_file(const fs::path& file, const std::string& place, std::uint64_t max_bytes) {
  const std::string shown = place.empty() ? file.string() : place;
  const Descriptor open_file(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (open_file.is_open()) return read_open_file(open_file, shown, max_bytes);
  if (errno == ENOENT || errno == ENOTDIR) return bad_input(shown, "the file does not exist");
  return bad_input(shown, "the file cannot be opened: " + std::generic_category().message(errno));
}

}  // namespace gltf_radiosity
