// Random numbers that depend on nothing but a seed and a stream: the same on any thread.
//
// O'Neill. PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random Number Generation.
// 2014 (PCG-XSH-RR 64/32)
#pragma once

#include <bit>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace radiosity {

/// A sequence of its own for each pair of `seed` and `stream`. Not thread-safe: every task has its own.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : increment_(2 * stream + 1) {
    bits();
    state_ += seed;
    bits();
  }

  /// 32 random bits.
  std::uint32_t bits() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005U + increment_;
    const auto mixed = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    return std::rotr(mixed, static_cast<int>(old >> 59U));
  }

  /// Evenly distributed in [0,1).
  float share() { return static_cast<float>(bits() >> 8U) * 0x1p-24F; }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

/// A point of a triangle by the weights of its corners 1 and 2, evenly distributed over its area.
glm::vec2 random_place(Random& random);

/// A direction above the plane of `normal` (unit), as densely as its cosine (density cos / pi).
glm::vec3 cosine_direction(const glm::vec3& normal, Random& random);

}  // namespace radiosity
