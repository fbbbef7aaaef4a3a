// One triangle on one face of a hemicube: clipping, projection, and the cells it covers. Used by item_buffer_raster.
//
//        up
//         |  .---------.        A row is scanned in groups of kLanes cells between the edges of the triangle; the signs
//         |  | . / \ . |        of three functions that are linear along the row decide about each centre (.).
//         |  | ./ . \. |
//         |  | /_____\ |
//         |  '---------' right
//
// Sutherland and Hodgman. Reentrant Polygon Clipping. 1974
// Olano and Greer. Triangle Scan Conversion Using 2D Homogeneous Coordinates. 1997
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>

#include "core/visibility/hemicube.h"

namespace radiosity {

/// Planes of a face's frustum: left, right, bottom, top, near.
inline constexpr std::size_t kPlanesPerFace = 5;

/// Cells in a row are visited in groups of this many.
inline constexpr int kLanes = 4;

/// A plane in (u, v, w): what is inside has dot(normal, p) >= offset.
struct Plane {
  glm::vec3 normal;
  float offset;
};

/// The five planes of `face`; nothing nearer to the viewpoint than `near` (metres, along the face's axis) is inside.
std::array<Plane, kPlanesPerFace> planes_of(const Hemicube::Face& face, float near);

/// A convex polygon; a triangle cut by five planes has at most eight corners.
struct Polygon {
  std::array<glm::vec3, 3 + kPlanesPerFace> corner;
  std::size_t count = 0;
};

/// Cuts off what is outside of `plane` (Sutherland and Hodgman). REQUIRES: at least one corner.
Polygon clip(const Polygon& polygon, const Plane& plane);

/// Columns and rows [first, last] of a face.
struct CellBounds {
  int first_column, last_column, first_row, last_row;
  bool empty() const { return first_column > last_column || first_row > last_row; }
};

/// The cells whose centres a clipped polygon may cover: a few more than it does, scan conversion decides exactly.
CellBounds bounds_of(const Polygon& polygon, const Hemicube::Face& face, float near);

/// A triangle ready for scan conversion on one face.
///
/// Seen through the cell along D = (x, y, 1) in the face's axes, corner i weighs in proportion to
/// e_i = D . (p_j x p_k), the signed volume over the edge opposite to it. These are linear in x and y, so there is no
/// perspective to correct and nothing to clip at the eye. Two triangles at one edge get values that differ in nothing
/// but their sign, to the last bit: no cell falls between them.
struct Projected {
  /// a x + b y + c
  struct Function {
    double a, b, c;
  };
  std::array<Function, 3> edge;  ///< e_i, not negative inside
  Function nearness;             ///< 1 / distance along the face's axis
  bool back;                     ///< whether the triangle shows its back
};
Projected project(const std::array<glm::vec3, 3>& corner, const Hemicube::Face& face);

/// The same along one row: a x + b for each function.
struct Row {
  struct Function {
    float a, b;
    float operator()(float x) const { return a * x + b; }
  };
  std::array<Function, 3> edge;
  Function nearness;
};
inline Row at_row(const Projected& triangle, double y) {
  const auto along = [y](const Projected::Function& f) {
    return Row::Function{static_cast<float>(f.a), static_cast<float>(f.b * y + f.c)};
  };
  return {{along(triangle.edge[0]), along(triangle.edge[1]), along(triangle.edge[2])}, along(triangle.nearness)};
}

/// The columns [first, end) of a row between the edges, and one more on either side against rounding, within `bounds`.
inline std::pair<int, int> columns_between_edges(const Row& row, const CellBounds& bounds, int resolution) {
  auto low = static_cast<float>(bounds.first_column);
  auto high = static_cast<float>(bounds.last_column);
  const float scale = 0.5F * static_cast<float>(resolution);
  for (const Row::Function& edge : row.edge) {
    const float crossing = (1.0F - edge.b / edge.a) * scale - 0.5F;  // not a number where the row runs along the edge
    if (edge.a > 0.0F) {
      low = std::max(low, crossing - 1.0F);
    } else if (edge.a < 0.0F) {
      high = std::min(high, crossing + 1.0F);
    }
  }
  return low <= high ? std::pair(static_cast<int>(low), static_cast<int>(high) + 1) : std::pair(0, 0);
}

/// Where the cells of one row are kept; pointers are to column 0.
struct RowCells {
  const float* centre;         ///< x of each column
  float* nearest;              ///< 1 / distance of the surface kept there, 0 if there is none
  float *weight_1, *weight_2;  ///< barycentrics
  std::uint32_t* triangle;
};

/// Keeps an opaque triangle in the cells [first, end) that it covers and where it is nearer than what is there.
/// REQUIRES: `first` and `end` are multiples of kLanes.
void scan(const Row& row, std::uint32_t triangle, int first, int end, const RowCells& cells);

}  // namespace radiosity
