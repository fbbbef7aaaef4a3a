#include "core/visibility/hemicube.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <numeric>

namespace radiosity {
namespace {

//            w                 top: up_start = 1, the origin of its cells is a corner
//         ___|___              sides: up_start = 0, they begin at the horizon
//        /   |  /|
//       /____|_/ |-- v         On every face right x up = axis.
//       |   /  | /
//       |__/___|/
//         u
std::array<Hemicube::Face, 5> make_faces(int resolution) {
  const glm::vec3 u(1.0F, 0.0F, 0.0F);
  const glm::vec3 v(0.0F, 1.0F, 0.0F);
  const glm::vec3 w(0.0F, 0.0F, 1.0F);
  const int half = resolution / 2;
  const int top = resolution * resolution;
  const int side = resolution * half;
  return {{{w, u, v, resolution, resolution, 0, 1.0F},
           {u, v, w, resolution, half, top, 0.0F},
           {-u, -v, w, resolution, half, top + side, 0.0F},
           {v, -u, w, resolution, half, top + 2 * side, 0.0F},
           {-v, u, w, resolution, half, top + 3 * side, 0.0F}}};
}

/// Calls `visit(cell, point)` with the centre of every cell on the half cube, in (u, v, w) components.
template <typename Visit>
void for_each_cell(int resolution, const Visit& visit) {
  const double width = 2.0 / resolution;
  for (const Hemicube::Face& face : make_faces(resolution)) {
    for (int row = 0; row < face.rows; ++row) {
      for (int column = 0; column < face.columns; ++column) {
        const double right = (column + 0.5) * width - 1.0;
        const double up = (row + 0.5) * width - static_cast<double>(face.up_start);
        visit(static_cast<std::size_t>(face.first_cell + row * face.columns + column),
              glm::dvec3(face.axis) + right * glm::dvec3(face.right) + up * glm::dvec3(face.up));
      }
    }
  }
}

std::size_t count_cells(int resolution) {
  return 3 * static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution);
}

}  // namespace

Frame frame(const Viewpoint& viewpoint) {
  // Any right-handed axes around w, without a branch that fails near a pole.
  // Duff, Burgess, Christensen, Hery, Kensler, Liani and Villemin. Building an Orthonormal Basis, Revisited. 2017
  const glm::vec3& w = viewpoint.normal;
  const float sign = std::copysign(1.0F, w.z);
  const float a = -1.0F / (sign + w.z);
  const float b = w.x * w.y * a;
  const glm::vec3 s(1.0F + sign * w.x * w.x * a, sign * b, -sign * w.x);
  const glm::vec3 t(b, sign + w.y * w.y * a, -w.y);

  // Turned about w.
  const float cosine = std::cos(viewpoint.twist);
  const float sine = std::sin(viewpoint.twist);
  return {cosine * s + sine * t, cosine * t - sine * s, w};
}

float low_discrepancy_twist(std::uint32_t k) {
  // The fractional part of k times the golden ratio, in units of 2^-32: unsigned arithmetic wraps as it should.
  constexpr std::uint32_t kGoldenRatio = 0x9e3779b9U;
  constexpr float kStep = 0x1p-24F;
  const float fraction = static_cast<float>((k * kGoldenRatio) >> 8U) * kStep;
  return fraction * (std::numbers::pi_v<float> / 2.0F);
}

std::vector<double> raw_delta_form_factors(int resolution) {
  // cos cos' / (pi r^2) dA. On the top both cosines are 1/r, which gives 1 / (pi (x^2 + y^2 + 1)^2) dA; on a side the
  // one at the patch is z/r, which gives z / (pi (y^2 + z^2 + 1)^2) dA. With w = 1 on the top both are one formula.
  std::vector<double> factors(count_cells(resolution));
  const double area = 4.0 / (static_cast<double>(resolution) * resolution);
  for_each_cell(resolution, [&](std::size_t cell, const glm::dvec3& point) {
    const double squared = glm::dot(point, point);
    factors[cell] = point.z * area / (std::numbers::pi * squared * squared);
  });
  return factors;
}

Hemicube::Hemicube(int resolution) : resolution_(resolution), faces_(make_faces(resolution)) {
  assert(resolution >= 2 && resolution % 2 == 0);

  // Sampled at the centres the factors of coarse cells miss 1 by up to a few per cent; light must not be lost to that.
  const std::vector<double> raw = raw_delta_form_factors(resolution);
  const double sum = std::accumulate(raw.begin(), raw.end(), 0.0);
  delta_form_factors_.reserve(raw.size());
  for (const double factor : raw) {
    delta_form_factors_.push_back(static_cast<float>(factor / sum));
  }

  directions_.resize(raw.size());
  for_each_cell(resolution, [&](std::size_t cell, const glm::dvec3& point) {
    directions_[cell] = glm::vec3(glm::normalize(point));
  });
}

}  // namespace radiosity
