// The normal equations of a fit: a sparse symmetric matrix over smooth groups, and what solves them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace radiosity {

/// One element's share: a symmetric 3 x 3 matrix over the groups of its corners.
struct FitElement {
  std::array<std::uint32_t, 3> group{};
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
};

/// A, the sum of the elements' shares. It depends on where samples are, not on their light.
struct FitMatrix {
  std::vector<FitElement> elements;
  std::vector<double> diagonal;  ///< [group_count]

  void add(const FitElement& element);
};

/// A x, three bands at once.
std::vector<glm::dvec3> multiply(const FitMatrix& matrix, const std::vector<glm::dvec3>& x);

/// A x = b by at most so many conjugate gradients, from x on, each band for itself. Where `held` [group_count, or
/// empty] is 1 x stays as it is, which must be 0.
void solve(const FitMatrix& matrix, const std::vector<glm::dvec3>& right, std::span<const std::uint8_t> held,
           int max_iterations, std::vector<glm::dvec3>& x);

/// Where a solution undershoots below zero it is held at zero, and the rest fits itself to that.
void hold_dark(const FitMatrix& matrix, const std::vector<glm::dvec3>& right, int max_iterations,
               std::vector<glm::dvec3>& x);

}  // namespace radiosity
