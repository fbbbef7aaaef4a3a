// A value or the reason why there is none. No third-party types: part of the public API.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace gltf_radiosity {

/// What kind of failure; tools turn it into an exit code.
enum class ErrorCode {
  kBadInput,     ///< the glTF is broken or uses something unsupported
  kBadOption,    ///< an option's value cannot be used with this input
  kCannotWrite,  ///< the output could not be written
  kLimit,        ///< a limit on memory or time was reached
  kCancelled,    ///< the caller asked to stop
  kInternal,     ///< a bug of ours
};

struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string place;    ///< where in the file: `meshes[3].primitives[0]`, a file name, or empty
  std::string message;  ///< one sentence without a final stop, lower case

  /// "place: message", on one line.
  std::string text() const { return place.empty() ? message : place + ": " + message; }
};

/// Either a T or an Error.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(google-explicit-constructor)

  explicit operator bool() const { return state_.index() == 0; }
  /// REQUIRES: *this holds a value.
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  /// REQUIRES: *this holds an error.
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value.
struct Done {};

inline Error bad_input(std::string place, std::string message) {
  return {ErrorCode::kBadInput, std::move(place), std::move(message)};
}

}  // namespace gltf_radiosity
