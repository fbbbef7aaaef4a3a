// Typed access to a JSON tree that nobody has checked yet.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

#include "plugin/document.h"

namespace gltf_radiosity {

/// A whole number that is not negative: 3 and 3.0 are the same in JSON. None if it is anything else.
std::optional<std::uint64_t> whole_number(const Json& value);

/// `root[key]`, or an empty array if it is missing.
const Json& array_of(const Json& root, const std::string& key);

/// `object.extensions[name]`, or null if it has no such extension.
const Json* extension_of(const Json& object, const char* name);

/// What `path` leads to from `root`, member by member; null if one is missing.
const Json* member_at(const Json& root, std::initializer_list<const char*> path);

/// What checks of a glTF's tree are made of. The first error sticks: every call after it answers a harmless default, so
/// that checks need not look after each one. `place` goes into errors.
class JsonChecker {
 public:
  /// `root` must outlive the checker.
  explicit JsonChecker(const Json& root) : root_(root) {}

 protected:
  /// Records an error, unless there is one already.
  void fail(std::string place, std::string message);
  /// Length of root[array]; 0 if it is missing.
  std::size_t size(const char* array) const { return array_of(root_, array).size(); }
  /// object[key] if it is there and an object; null otherwise, an error if it is something else.
  const Json* object_in(const Json& object, const std::string& key, const std::string& place);
  /// object[key] if it is there and an array; empty otherwise, an error if it is something else.
  const Json& array_in(const Json& object, const std::string& key, const std::string& place);
  /// A whole number up to 2^40; an error if it is missing and there is no `fallback`.
  std::uint64_t number(const Json& object, const std::string& key, std::optional<std::uint64_t> fallback,
                       const std::string& place);
  /// An index into root[array]; none if missing or wrong.
  std::optional<std::uint64_t> index(const Json& object, const std::string& key, const char* array,
                                     const std::string& place, bool required = false);
  // Errors if the member is there but not what the name says. Numbers are finite as floats.
  void numbers(const Json& object, const std::string& key, std::size_t count, const std::string& place);
  void number_if_present(const Json& object, const std::string& key, const std::string& place);
  void string_if_present(const Json& object, const std::string& key, const std::string& place);
  void bool_if_present(const Json& object, const std::string& key, const std::string& place);
  void check_weights(const Json& owner, const std::string& place);

  Result<Done> result() const {
    if (error_) return *error_;
    return Done{};
  }

  const Json& root_;
  std::optional<Error> error_;
};

}  // namespace gltf_radiosity
