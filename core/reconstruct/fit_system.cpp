#include "core/reconstruct/fit_system.h"

#include <algorithm>
#include <cassert>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "core/rgb.h"

namespace radiosity {
namespace {

/// A x, with rows and columns of groups that are held left out.
void multiply_free(const FitMatrix& matrix, std::span<const std::uint8_t> held, const std::vector<glm::dvec3>& x,
                   std::vector<glm::dvec3>& product) {
  std::fill(product.begin(), product.end(), glm::dvec3(0.0));
  for (const FitElement& m : matrix.elements) {
    const auto [a, b, c] = m.group;
    product[a] += m.xx * x[a] + m.xy * x[b] + m.xz * x[c];
    product[b] += m.xy * x[a] + m.yy * x[b] + m.yz * x[c];
    product[c] += m.xz * x[a] + m.yz * x[b] + m.zz * x[c];
  }
  for (std::size_t g = 0; g < held.size(); ++g) {
    if (held[g] != 0) product[g] = glm::dvec3(0.0);
  }
}

glm::dvec3 dot(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
  glm::dvec3 sum(0.0);
  for (std::size_t g = 0; g < a.size(); ++g) sum += a[g] * b[g];
  return sum;
}

glm::dvec3 ratio(const glm::dvec3& a, const glm::dvec3& b) {
  return {b.x > 0.0 ? a.x / b.x : 0.0, b.y > 0.0 ? a.y / b.y : 0.0, b.z > 0.0 ? a.z / b.z : 0.0};
}

/// The squared residual of nothing at all.
glm::dvec3 size_of(const std::vector<glm::dvec3>& right, const FitMatrix& matrix) {
  glm::dvec3 sum(0.0);
  for (std::size_t g = 0; g < right.size(); ++g) {
    if (matrix.diagonal[g] > 0.0) sum += right[g] * right[g] / matrix.diagonal[g];
  }
  return sum;
}

/// Groups whose light came out negative are held at none; returns how many are new.
std::size_t hold_negative(std::vector<glm::dvec3>& x, std::vector<std::uint8_t>& held) {
  std::size_t count = 0;
  for (std::size_t g = 0; g < x.size(); ++g) {
    if (held[g] != 0 || luminance_of(Rgb(x[g])) >= 0.0F) continue;
    held[g] = 1;
    ++count;
  }
  for (std::size_t g = 0; g < x.size(); ++g) {
    if (held[g] != 0) x[g] = glm::dvec3(0.0);
  }
  return count;
}

}  // namespace

void FitMatrix::add(const FitElement& element) {
  diagonal[element.group[0]] += element.xx;
  diagonal[element.group[1]] += element.yy;
  diagonal[element.group[2]] += element.zz;
  elements.push_back(element);
}

std::vector<glm::dvec3> multiply(const FitMatrix& matrix, const std::vector<glm::dvec3>& x) {
  std::vector<glm::dvec3> product(x.size());
  multiply_free(matrix, {}, x, product);
  return product;
}

// Preconditioned by the diagonal. Hestenes and Stiefel 1952.
void solve(const FitMatrix& matrix, const std::vector<glm::dvec3>& right, std::span<const std::uint8_t> held,
           int max_iterations, std::vector<glm::dvec3>& x) {
  const std::size_t count = x.size();
  constexpr double kEnough = 1e-12;  // of the squared right side
  std::vector<glm::dvec3> residual(count), direction(count), scaled(count), product(count);
  multiply_free(matrix, held, x, product);
  for (std::size_t g = 0; g < count; ++g) {
    const bool is_held = !held.empty() && held[g] != 0;
    residual[g] = is_held ? glm::dvec3(0.0) : right[g] - product[g];
    scaled[g] = matrix.diagonal[g] > 0.0 ? residual[g] / matrix.diagonal[g] : glm::dvec3(0.0);
  }
  direction = scaled;
  glm::dvec3 progress = dot(residual, scaled);
  const glm::dvec3 enough = kEnough * size_of(right, matrix);
  assert(!glm::any(glm::isnan(progress)));
  for (int k = 0; k < max_iterations && glm::any(glm::greaterThan(progress, enough)); ++k) {
    multiply_free(matrix, held, direction, product);
    const glm::dvec3 step = ratio(progress, dot(direction, product));
    for (std::size_t g = 0; g < count; ++g) {
      x[g] += step * direction[g];
      residual[g] -= step * product[g];
      if (matrix.diagonal[g] > 0.0) scaled[g] = residual[g] / matrix.diagonal[g];
    }
    const glm::dvec3 next = dot(residual, scaled);
    const glm::dvec3 turn = ratio(next, progress);
    for (std::size_t g = 0; g < count; ++g) direction[g] = scaled[g] + turn * direction[g];
    progress = next;
  }
}

void hold_dark(const FitMatrix& matrix, const std::vector<glm::dvec3>& right, int max_iterations,
               std::vector<glm::dvec3>& x) {
  constexpr int kRounds = 3;
  std::vector<std::uint8_t> held(x.size(), 0);
  for (int round = 0; round < kRounds && hold_negative(x, held) > 0; ++round) {
    solve(matrix, right, held, max_iterations, x);
  }
}

}  // namespace radiosity
