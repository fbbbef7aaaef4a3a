#include "tools/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <vector>

namespace gltf_radiosity::tools {
namespace {

std::string describe(const Range& range) {
  const bool unbounded = range.most == std::numeric_limits<double>::max();
  if (unbounded && range.open) return fmt::format("above {}", range.least);
  if (unbounded) return fmt::format("not below {}", range.least);
  if (range.open) return fmt::format("between {} and {}, without these two", range.least, range.most);
  return fmt::format("between {} and {}", range.least, range.most);
}

bool contains(const Range& range, double number) {
  if (range.open) return number > range.least && number < range.most;
  return number >= range.least && number <= range.most;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// Whether all of `text` has the form of a number, usable or not.
bool looks_like_a_number(std::string_view text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  return text.empty() || std::from_chars(text.data(), end, number).ptr == end;
}

}  // namespace

double parse_number(std::string_view text, const Range& range) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, number);
  if (failure != std::errc{} || stop != end || !std::isfinite(number)) {
    throw BadValue(fmt::format("'{}' is not a number", text));
  }
  if (!contains(range, number)) throw BadValue(fmt::format("{} is not {}", text, describe(range)));
  return number;
}

int parse_integer(std::string_view text, int least, int most) {
  int number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, number);
  const bool readable = stop == end && !text.empty();
  if (readable && (failure == std::errc::result_out_of_range || number < least || number > most)) {
    throw BadValue(fmt::format("{} is not between {} and {}", text, least, most));
  }
  if (failure != std::errc{} || !readable) throw BadValue(fmt::format("'{}' is not a whole number", text));
  return number;
}

std::array<double, 3> parse_triple(std::string_view text, const std::array<Range, 3>& ranges) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 3) throw BadValue(fmt::format("'{}' is not three numbers separated by commas", text));
  return {parse_number(parts[0], ranges[0]), parse_number(parts[1], ranges[1]), parse_number(parts[2], ranges[2])};
}

std::variant<std::array<double, 3>, std::string> parse_sky(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (!std::all_of(parts.begin(), parts.end(), looks_like_a_number)) return std::string(text);
  return parse_triple(text, {Range{}, Range{}, Range{}});
}

std::uint64_t parse_bytes(std::string_view text) {
  constexpr std::string_view kSuffixes = "KMGT";
  constexpr std::uint64_t kLeast = std::uint64_t{64} << 20U;
  const std::size_t suffix = text.empty() ? std::string_view::npos : kSuffixes.find(text.back());
  if (suffix == std::string_view::npos) throw BadValue(fmt::format("'{}' does not end in K, M, G or T", text));
  const int count = parse_integer(text.substr(0, text.size() - 1), 1, 1 << 20);
  const std::uint64_t bytes = static_cast<std::uint64_t>(count) << (10U * (suffix + 1));
  if (bytes < kLeast) throw BadValue(fmt::format("{} is less than 64M", text));
  return bytes;
}

std::pair<int, int> parse_size(std::string_view text, int least, int most) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 2) throw BadValue(fmt::format("'{}' is not two numbers separated by a comma", text));
  return {parse_integer(parts[0], least, most), parse_integer(parts[1], least, most)};
}

std::pair<std::string, int> parse_subdivide(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0) throw BadValue(fmt::format("'{}' is not NAME=LEVEL", text));
  return {std::string(text.substr(0, equals)), parse_integer(text.substr(equals + 1), 0, 8)};
}

std::pair<std::string, std::string> parse_group(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) {
    throw BadValue("'" + std::string(text) + "' is not NAME=PATTERN");
  }
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

std::string parse_attribute_name(std::string_view text) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (text.empty() || text.size() > 64 || !std::all_of(text.begin(), text.end(), is_allowed)) {
    throw BadValue("'" + std::string(text) + "' is not made of 1 to 64 letters, digits and underscores");
  }
  return std::string(text);
}

Sun parse_sun(std::string_view text) {
  const auto [elevation, azimuth, lux] = parse_triple(text, {Range{-90.0, 90.0}, Range{-360.0, 360.0}, Range{}});
  return {elevation, azimuth, lux};
}

}  // namespace gltf_radiosity::tools
