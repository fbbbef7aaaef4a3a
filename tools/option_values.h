// The values of options, strictly: all of the text counts, nothing is guessed.
//
// CLI11 alone would take "nan", "0x10" or "1e400" for a number. Every function here returns what the text says or
// throws BadValue, whose message command_line.cpp completes with the option's name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "plugin/gltf_radiosity.h"

namespace gltf_radiosity::tools {

/// An option's value that cannot be used. what() is a sentence without the option's name: "'x' is not a number".
struct BadValue : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The numbers an option accepts.
struct Range {
  double least = 0.0;
  double most = std::numeric_limits<double>::max();
  bool open = false;  ///< the ends themselves are refused
};

/// One decimal number: no white space, no plus sign, no nan, no inf, nothing after it.
double parse_number(std::string_view text, const Range& range);

/// One whole number in [least, most].
int parse_integer(std::string_view text, int least, int most);

/// Three numbers separated by commas, each in its own range.
std::array<double, 3> parse_triple(std::string_view text, const std::array<Range, 3>& ranges);

/// Three numbers that are not negative, or the name of a file: whatever is not numbers separated by commas.
std::variant<std::array<double, 3>, std::string> parse_sky(std::string_view text);

/// A whole number of bytes with a suffix K, M, G or T (powers of 1024), at least 64M.
std::uint64_t parse_bytes(std::string_view text);

/// W,H: two whole numbers in [least, most].
std::pair<int, int> parse_size(std::string_view text, int least, int most);

/// NAME=LEVEL, cut at the last equals sign because names may hold one; LEVEL in [0, 8].
std::pair<std::string, int> parse_subdivide(std::string_view text);

/// NAME=PATTERN, cut at the first equals sign; neither is empty.
std::pair<std::string, std::string> parse_group(std::string_view text);

/// The name of a custom attribute: 1 to 64 letters, digits and underscores.
std::string parse_attribute_name(std::string_view text);

/// EL,AZ,LUX: elevation in [-90, 90] and azimuth in [-360, 360] degrees, illuminance not negative.
Sun parse_sun(std::string_view text);

/// The values an option chooses from, by name.
template <typename Value, std::size_t count>
using Choices = std::array<std::pair<std::string_view, Value>, count>;

/// "none|uniform", for the help text and for messages.
template <typename Value, std::size_t count>
std::string names_of(const Choices<Value, count>& choices) {
  std::string names;
  for (const auto& choice : choices) {
    if (!names.empty()) names += '|';
    names += choice.first;
  }
  return names;
}

/// REQUIRES: `value` is one of `choices`.
template <typename Value, std::size_t count>
std::string name_of(Value value, const Choices<Value, count>& choices) {
  for (const auto& choice : choices) {
    if (choice.second == value) return std::string(choice.first);
  }
  return {};
}

/// The value called `text`.
template <typename Value, std::size_t count>
Value parse_choice(std::string_view text, const Choices<Value, count>& choices) {
  for (const auto& choice : choices) {
    if (choice.first == text) return choice.second;
  }
  throw BadValue("'" + std::string(text) + "' is not one of " + names_of(choices));
}

}  // namespace gltf_radiosity::tools
