// Where the cells of a hemicube look, and how much each one counts.
//
// A hemicube stands in for the hemisphere above a patch: half a cube of half-width 1 whose five
// faces are cut into square cells. An item buffer (item_buffer.h) finds the surface each cell sees;
// adding up the delta form factors of the cells that see patch j gives F_ij (transport/form_factors.h).
//
// Cohen and Greenberg. The Hemi-Cube: A Radiosity Solution for Complex Environments. 1985
// Where it goes wrong -- patches too close together, partly hidden, or smaller than a cell:
// Baum, Rushmeier and Winget. Improving Radiosity Solutions Through the Use of Analytically
// Determined Form-Factors. 1989
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace radiosity {

/// Where a hemicube stands and how it is turned.
struct Viewpoint {
  glm::vec3 position{0.0F};            ///< metres, already lifted off its surface (surface_offset())
  glm::vec3 normal{0.0F, 0.0F, 1.0F};  ///< unit
  float twist = 0.0F;                  ///< rotation about the normal, rad; against banding
};

/// Right-handed axes at a viewpoint, `w` along the normal.
struct Frame {
  glm::vec3 u, v, w;
};
Frame frame(const Viewpoint& viewpoint);

/// The k-th angle of a fixed low-discrepancy sequence over a quarter turn, rad (golden ratio; a hemicube has fourfold
/// symmetry, so a quarter turn is all there is).
float low_discrepancy_twist(std::uint32_t k);

/// Delta form factors as the formula gives them, cell by cell, before Hemicube divides them by their sum: 1.0357 at
/// 4 cells, 1.0021 at 16, 1.00013 at 64.
std::vector<double> raw_delta_form_factors(int resolution);

/// The cells of a hemicube `resolution` cells wide: the top face (resolution^2), then the +u, -u,
/// +v and -v sides (resolution^2 / 2 each, rows counted up from the horizon).
///
/// Immutable once built: one Hemicube serves every patch and may be shared between threads.
class Hemicube {
 public:
  /// A rectangle of cells on one plane. The centre of cell (column, row) is seen along
  /// axis + ((column + 0.5) * 2 / resolution - 1) * right + ((row + 0.5) * 2 / resolution - up_start) * up
  /// with up_start = 1 on the top face and 0 on the sides. Axes are given in (u, v, w) components.
  struct Face {
    glm::vec3 axis, right, up;
    int columns, rows, first_cell;
    float up_start;
  };

  /// REQUIRES: `resolution` is even and at least 2.
  explicit Hemicube(int resolution);

  int resolution() const { return resolution_; }
  int cell_count() const { return static_cast<int>(delta_form_factors_.size()); }
  /// Delta form factor of each cell, [cell_count()], unitless, all positive, summing to 1.
  std::span<const float> delta_form_factors() const { return delta_form_factors_; }
  /// Direction through each cell's centre in (u, v, w) components, unit, [cell_count()].
  std::span<const glm::vec3> directions() const { return directions_; }
  std::span<const Face, 5> faces() const { return faces_; }

 private:
  int resolution_;
  std::array<Face, 5> faces_;
  std::vector<float> delta_form_factors_;
  std::vector<glm::vec3> directions_;
};

}  // namespace radiosity
