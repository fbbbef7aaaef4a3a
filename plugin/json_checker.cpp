#include "plugin/json_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gltf_radiosity {
namespace {

/// No file this project can bake comes near it, and nothing below it overflows 64 bits when multiplied by a stride.
constexpr std::uint64_t kMaxWholeNumber = std::uint64_t{1} << 40;

}  // namespace

void JsonChecker::fail(std::string place, std::string message) {
  if (!error_) error_ = bad_input(std::move(place), std::move(message));
}

const Json* JsonChecker::object_in(const Json& object, const std::string& key, const std::string& place) {
  const auto it = object.find(key);
  if (it == object.end()) return nullptr;
  if (it->is_object()) return &*it;
  fail(place, fmt::format("\"{}\" is not an object", key));
  return nullptr;
}

const Json& JsonChecker::array_in(const Json& object, const std::string& key, const std::string& place) {
  const auto it = object.find(key);
  if (it != object.end() && !it->is_array()) fail(place, fmt::format("\"{}\" is not an array", key));
  return array_of(object, key);
}

std::uint64_t JsonChecker::number(const Json& object, const std::string& key, std::optional<std::uint64_t> fallback,
                                  const std::string& place) {
  if (!object.contains(key)) {
    if (!fallback) fail(place, fmt::format("\"{}\" is missing", key));
    return fallback.value_or(0);
  }
  const auto value = whole_number(object.at(key));
  if (!value || *value > kMaxWholeNumber) fail(place, fmt::format("\"{}\" is not a whole number in range", key));
  return value.value_or(0);
}

std::optional<std::uint64_t> JsonChecker::index(const Json& object, const std::string& key, const char* array,
                                                const std::string& place, bool required) {
  if (!required && !object.contains(key)) return std::nullopt;
  const std::uint64_t value = number(object, key, std::nullopt, place);
  if (value >= size(array)) {
    fail(place, fmt::format("\"{}\" refers to {}[{}], but there are {}", key, array, value, size(array)));
  }
  return error_ ? std::nullopt : std::optional(value);
}

void JsonChecker::numbers(const Json& object, const std::string& key, std::size_t count, const std::string& place) {
  const Json& values = array_in(object, key, place);
  if (!object.contains(key)) return;
  const bool fine = values.size() == count && std::all_of(values.begin(), values.end(), [](const Json& value) {
                      return value.is_number() && std::isfinite(value.get<float>());
                    });
  if (!fine) fail(place, fmt::format("\"{}\" is not {} finite numbers", key, count));
}

void JsonChecker::number_if_present(const Json& object, const std::string& key, const std::string& place) {
  const auto it = object.find(key);
  if (it == object.end() || (it->is_number() && std::isfinite(it->get<float>()))) return;
  fail(place, fmt::format("\"{}\" is not a finite number", key));
}

void JsonChecker::string_if_present(const Json& object, const std::string& key, const std::string& place) {
  const auto it = object.find(key);
  if (it != object.end() && !it->is_string()) fail(place, fmt::format("\"{}\" is not a string", key));
}

void JsonChecker::bool_if_present(const Json& object, const std::string& key, const std::string& place) {
  const auto it = object.find(key);
  if (it != object.end() && !it->is_boolean()) fail(place, fmt::format("\"{}\" is neither true nor false", key));
}

void JsonChecker::check_weights(const Json& owner, const std::string& place) {
  for (const Json& weight : array_in(owner, "weights", place)) {
    if (!weight.is_number() || !std::isfinite(weight.get<float>())) fail(place, "\"weights\" are not finite numbers");
  }
}

std::optional<std::uint64_t> whole_number(const Json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_number()) return std::nullopt;
  const double real = value.get<double>();
  if (!(real >= 0.0 && real < 9007199254740992.0) || real != std::floor(real)) return std::nullopt;
  return static_cast<std::uint64_t>(real);
}

const Json& array_of(const Json& root, const std::string& key) {
  static const Json empty = Json::array();
  const auto it = root.find(key);
  return it == root.end() || !it->is_array() ? empty : *it;
}

const Json* member_at(const Json& root, std::initializer_list<const char*> path) {
  const Json* at = &root;
  for (const char* key : path) {
    if (!at->is_object()) return nullptr;
    const auto member = at->find(key);
    if (member == at->end()) return nullptr;
    at = &*member;
  }
  return at;
}

const Json* extension_of(const Json& object, const char* name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end() || !extensions->is_object()) return nullptr;
  const auto it = extensions->find(name);
  return it == extensions->end() ? nullptr : &*it;
}

}  // namespace gltf_radiosity
