// A name for content: the same for the same bytes, and for nothing else that is ever met.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

struct XXH3_state_s;

namespace gltf_radiosity {

/// 128 bits of XXH3 over all that is added, in order. Against chance, not against an attacker.
class ContentHash {
 public:
  ContentHash();

  /// Whole arrays: their length counts too. REQUIRES: no padding within T.
  template <typename T>
  void add(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_value(values.size());
    add_bytes(values.data(), values.size_bytes());
  }
  template <typename T>
  void add(const std::vector<T>& values) {
    add(std::span<const T>(values));
  }
  void add(std::string_view text) { add(std::span(text)); }
  template <typename T>
  void add_value(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    add_bytes(&value, sizeof(value));
  }
  template <typename T>
  void add_value(const std::optional<T>& value) {
    add_value(value.has_value());
    if (value) add_value(*value);
  }

  /// 32 digits.
  std::string digits() const;

 private:
  struct Release {
    void operator()(XXH3_state_s* state) const;
  };
  void add_bytes(const void* bytes, std::size_t size);

  std::unique_ptr<XXH3_state_s, Release> state_;
};

}  // namespace gltf_radiosity
