#include "tools/report_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "plugin/whole_file.h"

namespace gltf_radiosity::tools {
namespace {

namespace fs = std::filesystem;

std::string_view code_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadInput:
      return "bad-input";
    case ErrorCode::kBadOption:
      return "bad-option";
    case ErrorCode::kCannotWrite:
      return "cannot-write";
    case ErrorCode::kLimit:
      return "limit";
    case ErrorCode::kCancelled:
      return "cancelled";
    case ErrorCode::kInternal:
      return "internal";
  }
  return "internal";
}

/// Bytes of the well-formed UTF-8 sequence that `text` begins with; 0 if there is none (RFC 3629, table in section 4).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto follows = [&byte](std::size_t i) { return byte(i) >= 0x80U && byte(i) <= 0xbfU; };
  const unsigned first = byte(0);
  const unsigned second = byte(1);
  if (first < 0x80U) return 1;
  if (first >= 0xc2U && first <= 0xdfU && follows(1)) return 2;
  const bool second_of_three = first == 0xe0U ? second >= 0xa0U : first == 0xedU ? second <= 0x9fU : true;
  if (first >= 0xe0U && first <= 0xefU && second_of_three && follows(1) && follows(2)) return 3;
  const bool second_of_four = first == 0xf0U ? second >= 0x90U : first == 0xf4U ? second <= 0x8fU : true;
  if (first >= 0xf0U && first <= 0xf4U && second_of_four && follows(1) && follows(2) && follows(3)) return 4;
  return 0;
}

/// Writes and flushes; answers 0 or the errno of what failed.
int write_all(std::FILE* file, std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  return written ? 0 : errno != 0 ? errno : EIO;
}

/// Into a device or a pipe.
int write_through(const std::string& path, std::string_view text) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return errno;
  const int failure = write_all(file, text);
  return std::fclose(file) != 0 && failure == 0 ? errno : failure;
}

std::optional<std::string> replace_file(const std::string& path, std::string_view text) {
  const auto done = write_whole_file(path, text);
  return done ? std::nullopt : std::optional(done.error().text());
}

}  // namespace

std::string json_string(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text.front());
    if (length == 0) {
      json += "\\ufffd";
    } else if (first == '"' || first == '\\') {
      json += {'\\', text.front()};
    } else if (first < 0x20U) {
      json += fmt::format("\\u{:04x}", first);
    } else {
      json += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return json + "\"";
}

std::string to_json(const Error& error) {
  return fmt::format("{{\n  \"error\": {{\n    \"code\": {},\n    \"place\": {},\n    \"message\": {}\n  }}\n}}",
                     json_string(code_of(error.code)), json_string(error.place), json_string(error.message));
}

std::optional<std::string> write_report(const std::string& path, std::string_view json) {
  const std::string text = std::string(json) + "\n";
  std::error_code ignored;
  const bool is_file = path != "-" && (!fs::exists(path, ignored) || fs::is_regular_file(path, ignored));
  if (is_file) return replace_file(path, text);
  const int failure = path == "-" ? write_all(stdout, text) : write_through(path, text);
  if (failure == 0) return std::nullopt;
  return fmt::format("{}: {}", path == "-" ? "stdout" : path, std::strerror(failure));
}

}  // namespace gltf_radiosity::tools
