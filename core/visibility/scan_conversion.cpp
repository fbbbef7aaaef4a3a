#include "core/visibility/scan_conversion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>

namespace radiosity {
namespace {

/// Four neighbouring cells at once: an extension that GCC and Clang share. Left to themselves they branch cell by cell,
/// at half the speed.
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Bits = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

template <typename Lanes, typename Value>
Lanes load(const Value* from) {
  static_assert(sizeof(Lanes) == kLanes * sizeof(Value));
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

/// Overwrites the lanes that `keep` (all bits or none) selects.
template <typename Value, typename Lanes>
void store_where(const Bits& keep, const Lanes& lanes, Value* to) {
  const Bits merged = (keep & std::bit_cast<Bits>(lanes)) | (~keep & load<Bits>(to));
  std::memcpy(to, &merged, sizeof(merged));
}

}  // namespace

std::array<Plane, kPlanesPerFace> planes_of(const Hemicube::Face& face, float near) {
  return {{{face.axis + face.right, 0.0F},
           {face.axis - face.right, 0.0F},
           {face.up_start * face.axis + face.up, 0.0F},
           {face.axis - face.up, 0.0F},
           {face.axis, near}}};
}

Polygon clip(const Polygon& polygon, const Plane& plane) {
  Polygon inside;
  glm::vec3 from = polygon.corner[polygon.count - 1];
  float from_distance = glm::dot(plane.normal, from) - plane.offset;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::vec3 to = polygon.corner[i];
    const float to_distance = glm::dot(plane.normal, to) - plane.offset;
    if ((from_distance < 0.0F) != (to_distance < 0.0F)) {
      inside.corner[inside.count++] = from + (to - from) * (from_distance / (from_distance - to_distance));
    }
    if (!(to_distance < 0.0F)) {
      inside.corner[inside.count++] = to;
    }
    from = to;
    from_distance = to_distance;
  }
  return inside;
}

CellBounds bounds_of(const Polygon& polygon, const Hemicube::Face& face, float near) {
  constexpr float kSlack = 0.1F;                // cells
  constexpr float kTrustworthyPerNear = 64.0F;  // rounding in the clipper moves corners by a few times `near`
  const float scale = 0.5F * static_cast<float>(face.columns);
  glm::vec2 low(static_cast<float>(face.columns));
  glm::vec2 high(-1.0F);
  for (const glm::vec3& corner : std::span(polygon.corner).first(polygon.count)) {
    const float distance = glm::dot(face.axis, corner);
    if (!(distance > kTrustworthyPerNear * near)) {
      return {0, face.columns - 1, 0, face.rows - 1};
    }
    const float to_cells = scale / distance;
    const glm::vec2 cell(glm::dot(face.right, corner) * to_cells + scale - 0.5F,
                         glm::dot(face.up, corner) * to_cells + face.up_start * scale - 0.5F);
    low = glm::min(low, cell);
    high = glm::max(high, cell);
  }
  const auto up = [](float x) { return std::max(0, static_cast<int>(std::ceil(x - kSlack))); };
  const auto down = [](float x, int end) { return std::min(end - 1, static_cast<int>(std::floor(x + kSlack))); };
  return {up(low.x), down(high.x, face.columns), up(low.y), down(high.y, face.rows)};
}

Projected project(const std::array<glm::vec3, 3>& corner, const Hemicube::Face& face) {
  // Into the axes of the face. Double, as the volumes of small triangles far away are small differences.
  std::array<glm::dvec3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = {glm::dot(face.right, corner[i]), glm::dot(face.up, corner[i]), glm::dot(face.axis, corner[i])};
  }

  // Six times the volume between the viewpoint and the triangle tells which side shows.
  const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
  const double volume = glm::dot(normal, p[0]);
  const double sign = volume < 0.0 ? -1.0 : 1.0;
  Projected out{};
  out.back = volume > 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 e = sign * glm::cross(p[(i + 1) % 3], p[(i + 2) % 3]);
    out.edge[i] = {e.x, e.y, e.z};
  }
  const glm::dvec3 n = volume != 0.0 ? normal / volume : glm::dvec3(0.0);
  out.nearness = {n.x, n.y, n.z};
  return out;
}

void scan(const Row& row, std::uint32_t triangle, int first, int end, const RowCells& cells) {
  const auto id = static_cast<std::int32_t>(triangle);
  const Bits ids = {id, id, id, id};
  for (int i = first; i < end; i += kLanes) {
    // Inside, and in front of what is there?
    const auto x = load<Floats>(cells.centre + i);
    const Floats e_0 = row.edge[0].a * x + row.edge[0].b;
    const Floats e_1 = row.edge[1].a * x + row.edge[1].b;
    const Floats e_2 = row.edge[2].a * x + row.edge[2].b;
    const Floats nearness = row.nearness.a * x + row.nearness.b;
    const Floats sum = e_0 + e_1 + e_2;
    const Bits keep =
        (e_0 >= 0.0F) & (e_1 >= 0.0F) & (e_2 >= 0.0F) & (sum > 0.0F) & (nearness > load<Floats>(cells.nearest + i));
    if ((keep[0] | keep[1] | keep[2] | keep[3]) == 0) {
      continue;
    }

    // Then it is what these cells see.
    const Floats scale = 1.0F / sum;
    store_where(keep, nearness, cells.nearest + i);
    store_where(keep, e_1 * scale, cells.weight_1 + i);
    store_where(keep, e_2 * scale, cells.weight_2 + i);
    store_where(keep, ids, cells.triangle + i);
  }
}

}  // namespace radiosity
