#include "core/visibility/item_buffer_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <span>

namespace radiosity {
namespace {

constexpr std::size_t kFaceCount = 5;
constexpr std::size_t kPlanesPerFace = 5;  // left, right, bottom, top, near
constexpr int kLanes = 4;                  // cells in a row are visited in groups of this many

/// Share of the scene's diagonal within which a surface is too close to be projected.
constexpr float kNearPerDiagonal = 1e-7F;

/// One plane of a face's frustum: what is inside has dot(normal, p) >= offset.
struct Plane {
  glm::vec3 normal;
  float offset;
};
using Planes = std::array<Plane, kFaceCount * kPlanesPerFace>;

Planes make_planes(const Hemicube& hemicube, float near) {
  Planes planes{};
  std::size_t i = 0;
  for (const Hemicube::Face& face : hemicube.faces()) {
    planes[i++] = {face.axis + face.right, 0.0F};
    planes[i++] = {face.axis - face.right, 0.0F};
    planes[i++] = {face.up_start * face.axis + face.up, 0.0F};
    planes[i++] = {face.axis - face.up, 0.0F};
    planes[i++] = {face.axis, near};
  }
  return planes;
}

/// What a fill needs room for; kept by each thread so that only its first hemicube allocates.
struct Scratch {
  // Vertices as the hemicube sees them, [vertex_count]: (u, v, w), and the planes each is outside of (bit i:
  // planes[i]).
  std::vector<float> u, v, w;
  std::vector<std::uint32_t> outside;
  // Cells, face by face and row by row; each row padded to a multiple of kLanes.
  std::vector<float> nearest;  ///< 1 / distance along the face's axis; 0 where nothing was seen yet
  std::vector<float> weight_1, weight_2;
  std::vector<std::uint32_t> triangle;
  std::vector<float> column_centre;  ///< along `right`, [padded columns]
  std::vector<std::uint8_t> back;    ///< of each triangle that was drawn, [triangle_count]
};

void place_vertices(const Scene& scene, const Viewpoint& viewpoint, Scratch& scratch) {
  const Frame axes = frame(viewpoint);
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    const glm::vec3 p = scene.positions[i] - viewpoint.position;
    scratch.u[i] = glm::dot(p, axes.u);
    scratch.v[i] = glm::dot(p, axes.v);
    scratch.w[i] = glm::dot(p, axes.w);
  }
}

void find_outside(std::size_t count, const Plane& plane, std::uint32_t bit, const float* __restrict u,
                  const float* __restrict v, const float* __restrict w, std::uint32_t* __restrict outside) {
  for (std::size_t i = 0; i < count; ++i) {
    const float distance = plane.normal.x * u[i] + plane.normal.y * v[i] + plane.normal.z * w[i];
    outside[i] |= distance < plane.offset ? bit : 0U;
  }
}

/// A convex polygon; a triangle cut by the five planes of a frustum has at most eight corners.
struct Polygon {
  std::array<glm::vec3, 3 + kPlanesPerFace> corner;
  std::size_t count = 0;
};

/// Cuts off what is outside of `plane` (Sutherland and Hodgman).
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

/// Columns and rows [first, last] of a face.
struct CellBounds {
  int first_column, last_column, first_row, last_row;
  bool empty() const { return first_column > last_column || first_row > last_row; }
};

/// The cells whose centres the polygon may cover: a little more than it does, scan conversion decides exactly.
CellBounds bounds_of(const Polygon& polygon, const Hemicube::Face& face) {
  constexpr float kSlack = 0.1F;
  const float scale = 0.5F * static_cast<float>(face.columns);
  glm::vec2 low(static_cast<float>(face.columns));
  glm::vec2 high(-1.0F);
  for (const glm::vec3& corner : std::span(polygon.corner).first(polygon.count)) {
    const float to_cells = scale / glm::dot(face.axis, corner);
    const glm::vec2 cell(glm::dot(face.right, corner) * to_cells + scale - 0.5F,
                         glm::dot(face.up, corner) * to_cells + face.up_start * scale - 0.5F);
    low = glm::min(low, cell);
    high = glm::max(high, cell);
  }
  const auto up = [](float x) { return std::max(0, static_cast<int>(std::ceil(x - kSlack))); };
  const auto down = [](float x, int end) { return std::min(end - 1, static_cast<int>(std::floor(x + kSlack))); };
  return {up(low.x), down(high.x, face.columns), up(low.y), down(high.y, face.rows)};
}

/// A function a x + b y + c over a face.
struct Linear {
  double a, b, c;
};

/// A triangle ready for scan conversion on one face.
///
/// Seen through the cell along D = (x, y, 1) in the face's axes, corner i weighs in proportion to
/// e_i = D . (p_j x p_k), the signed volume over the edge opposite to it. These are linear in x and y, so there is no
/// perspective to correct and nothing to clip at the eye. Two triangles at one edge get values that differ in nothing
/// but their sign, to the last bit: no cell falls between them.
/// Olano and Greer. Triangle Scan Conversion Using 2D Homogeneous Coordinates. 1997
struct Projected {
  std::array<Linear, 3> edge;  ///< e_i, not negative inside
  Linear nearness;             ///< 1 / distance along the face's axis
  bool back;
};

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

/// A projected triangle along one row: a x + b for each function.
struct RowFunction {
  float a, b;
};
struct Row {
  RowFunction edge[3];
  RowFunction nearness;
};

Row at_row(const Projected& triangle, double y) {
  const auto along = [y](const Linear& f) {
    return RowFunction{static_cast<float>(f.a), static_cast<float>(f.b * y + f.c)};
  };
  return {{along(triangle.edge[0]), along(triangle.edge[1]), along(triangle.edge[2])}, along(triangle.nearness)};
}

/// The cells of one row of one face. Pointers are to column 0.
struct RowCells {
  const float* centre;
  float *nearest, *weight_1, *weight_2;
  std::uint32_t* triangle;
};

/// Keeps an opaque triangle in the cells [first, end) that it covers and where it is nearer than what is there.
void scan(const Row& row, std::uint32_t triangle, int first, int end, const float* __restrict centre,
          float* __restrict nearest, float* __restrict weight_1, float* __restrict weight_2,
          std::uint32_t* __restrict kept) {
  for (int i = first; i < end; ++i) {
    const float x = centre[i];
    const float e_0 = row.edge[0].a * x + row.edge[0].b;
    const float e_1 = row.edge[1].a * x + row.edge[1].b;
    const float e_2 = row.edge[2].a * x + row.edge[2].b;
    const float nearness = row.nearness.a * x + row.nearness.b;
    const float sum = e_0 + e_1 + e_2;
    const bool keep = (e_0 >= 0.0F) & (e_1 >= 0.0F) & (e_2 >= 0.0F) & (sum > 0.0F) & (nearness > nearest[i]);
    const float scale = 1.0F / sum;
    nearest[i] = keep ? nearness : nearest[i];
    weight_1[i] = keep ? e_1 * scale : weight_1[i];
    weight_2[i] = keep ? e_2 * scale : weight_2[i];
    kept[i] = keep ? triangle : kept[i];
  }
}

/// Draws the triangles of one scene into the faces of one hemicube.
class Rasterizer {
 public:
  Rasterizer(const Scene& scene, float near, const Hemicube& hemicube, const Viewpoint& viewpoint, Scratch& scratch)
      : scene_(scene),
        hemicube_(hemicube),
        viewpoint_(viewpoint),
        scratch_(scratch),
        planes_(make_planes(hemicube, near)),
        stride_((hemicube.resolution() + kLanes - 1) / kLanes * kLanes) {
    // Room for everything.
    const std::size_t vertices = scene.positions.size();
    const auto padded = static_cast<std::size_t>(3 * hemicube.resolution() * stride_);
    for (std::vector<float>* coordinate : {&scratch.u, &scratch.v, &scratch.w}) {
      coordinate->resize(vertices);
    }
    scratch.outside.assign(vertices, 0);
    scratch.nearest.assign(padded, 0.0F);
    scratch.weight_1.assign(padded, 0.0F);
    scratch.weight_2.assign(padded, 0.0F);
    scratch.triangle.assign(padded, kNothing);
    scratch.back.resize(scene.triangles.size());
    scratch.column_centre.resize(static_cast<std::size_t>(stride_));
    for (int i = 0; i < stride_; ++i) {
      scratch.column_centre[static_cast<std::size_t>(i)] = static_cast<float>(centre(i) - 1.0);
    }

    // Where the vertices are.
    place_vertices(scene, viewpoint, scratch);
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      find_outside(vertices, planes_[i], 1U << i, scratch.u.data(), scratch.v.data(), scratch.w.data(),
                   scratch.outside.data());
    }
  }

  void draw(std::uint32_t triangle) {
    const glm::uvec3& index = scene_.triangles[triangle];
    const std::uint32_t a = scratch_.outside[index.x];
    const std::uint32_t b = scratch_.outside[index.y];
    const std::uint32_t c = scratch_.outside[index.z];
    for (std::size_t face = 0; face < kFaceCount; ++face) {
      const std::size_t shift = face * kPlanesPerFace;
      constexpr std::uint32_t kMask = (1U << kPlanesPerFace) - 1U;
      if ((((a & b & c) >> shift) & kMask) == 0) {
        draw_on_face(triangle, face, ((a | b | c) >> shift) & kMask);
      }
    }
  }

  void store(ItemBuffer& items) const {
    for (std::size_t face = 0; face < kFaceCount; ++face) {
      const Hemicube::Face& layout = hemicube_.faces()[face];
      for (int row = 0; row < layout.rows; ++row) {
        const std::size_t from = row_start(layout, row);
        const auto to = static_cast<std::size_t>(layout.first_cell + row * layout.columns);
        for (std::size_t i = 0; i < static_cast<std::size_t>(layout.columns); ++i) {
          const std::uint32_t triangle = scratch_.triangle[from + i];
          items.triangle[to + i] = triangle;
          items.barycentrics[to + i] = {scratch_.weight_1[from + i], scratch_.weight_2[from + i]};
          items.back[to + i] = triangle == kNothing ? std::uint8_t{0} : scratch_.back[triangle];
        }
      }
    }
  }

 private:
  /// Of column or row `i` from where the columns or rows begin, in half-widths of the cube.
  double centre(int i) const { return (i + 0.5) * 2.0 / hemicube_.resolution(); }

  /// Where a row begins in the padded arrays.
  std::size_t row_start(const Hemicube::Face& face, int row) const {
    return static_cast<std::size_t>((face.first_cell / face.columns + row) * stride_);
  }

  void draw_on_face(std::uint32_t triangle, std::size_t face_index, std::uint32_t crossed) {
    const Hemicube::Face& face = hemicube_.faces()[face_index];
    const glm::uvec3& index = scene_.triangles[triangle];
    const auto vertex = [this](std::uint32_t i) { return glm::vec3(scratch_.u[i], scratch_.v[i], scratch_.w[i]); };
    const std::array<glm::vec3, 3> corners = {vertex(index.x), vertex(index.y), vertex(index.z)};

    // Clip to the face, to learn which cells may see the triangle.
    Polygon polygon;
    polygon.count = 3;
    std::copy(corners.begin(), corners.end(), polygon.corner.begin());
    for (std::size_t i = 0; i < kPlanesPerFace; ++i) {
      if (((crossed >> i) & 1U) != 0) {
        polygon = clip(polygon, planes_[face_index * kPlanesPerFace + i]);
        if (polygon.count == 0) {
          return;
        }
      }
    }
    const CellBounds bounds = bounds_of(polygon, face);
    if (bounds.empty()) {
      return;
    }

    // Scan convert.
    const Projected projected = project(corners, face);
    const bool see_through = scene_.surfaces[scene_.surface_of_triangle[triangle]].see_through;
    scratch_.back[triangle] = projected.back ? 1 : 0;
    for (int y = bounds.first_row; y <= bounds.last_row; ++y) {
      const Row row = at_row(projected, centre(y) - static_cast<double>(face.up_start));
      const auto [first, end] = span(row, bounds);
      if (see_through) {
        scan_see_through(row, triangle, face, y, first, end);
      } else if (first < end) {
        const std::size_t start = row_start(face, y);
        const int aligned_first = first / kLanes * kLanes;
        const int aligned_end = (end + kLanes - 1) / kLanes * kLanes;
        scan(row, triangle, aligned_first, aligned_end, scratch_.column_centre.data(), &scratch_.nearest[start],
             &scratch_.weight_1[start], &scratch_.weight_2[start], &scratch_.triangle[start]);
      }
    }
  }

  /// The columns [first, end) of a row between the edges, one more on either side against rounding.
  std::pair<int, int> span(const Row& row, const CellBounds& bounds) const {
    auto low = static_cast<float>(bounds.first_column);
    auto high = static_cast<float>(bounds.last_column);
    const float scale = 0.5F * static_cast<float>(hemicube_.resolution());
    for (const RowFunction& edge : row.edge) {
      const float crossing = (1.0F - edge.b / edge.a) * scale - 0.5F;  // not a number where the row runs along the edge
      if (edge.a > 0.0F) {
        low = std::max(low, crossing - 1.0F);
      } else if (edge.a < 0.0F) {
        high = std::min(high, crossing + 1.0F);
      }
    }
    return low <= high ? std::pair(static_cast<int>(low), static_cast<int>(high) + 1) : std::pair(0, 0);
  }

  void scan_see_through(const Row& row, std::uint32_t triangle, const Hemicube::Face& face, int y, int first, int end) {
    for (int i = first; i < end; ++i) {
      // What scan() does for one cell.
      const std::size_t at = row_start(face, y) + static_cast<std::size_t>(i);
      const float x = scratch_.column_centre[static_cast<std::size_t>(i)];
      const auto value = [x](const RowFunction& f) { return f.a * x + f.b; };
      const glm::vec3 e(value(row.edge[0]), value(row.edge[1]), value(row.edge[2]));
      const float nearness = value(row.nearness);
      const float sum = e.x + e.y + e.z;
      if (!(e.x >= 0.0F && e.y >= 0.0F && e.z >= 0.0F && sum > 0.0F && nearness > scratch_.nearest[at])) {
        continue;
      }

      // And the question whether the surface is there at all.
      const Barycentrics barycentrics(e.y / sum, e.z / sum);
      const int cell = face.first_cell + y * face.columns + i;
      if (!lets_through(scene_, triangle, barycentrics, opacity_threshold(viewpoint_, cell))) {
        scratch_.nearest[at] = nearness;
        scratch_.weight_1[at] = barycentrics.x;
        scratch_.weight_2[at] = barycentrics.y;
        scratch_.triangle[at] = triangle;
      }
    }
  }

  const Scene& scene_;
  const Hemicube& hemicube_;
  const Viewpoint& viewpoint_;
  Scratch& scratch_;
  Planes planes_;
  int stride_;
};

class ItemBufferRaster final : public ItemBufferMaker {
 public:
  explicit ItemBufferRaster(const Scene& scene) : scene_(scene), near_(kNearPerDiagonal * diagonal(scene)) {}

  void fill(const Hemicube& hemicube, const Viewpoint& viewpoint, ItemBuffer& items) const override {
    thread_local Scratch scratch;
    Rasterizer rasterizer(scene_, near_, hemicube, viewpoint, scratch);
    for (std::uint32_t triangle = 0; triangle < scene_.triangles.size(); ++triangle) {
      rasterizer.draw(triangle);
    }
    items.resize(hemicube.cell_count());
    rasterizer.store(items);
  }

 private:
  const Scene& scene_;
  float near_;
};

}  // namespace

std::unique_ptr<ItemBufferMaker> make_item_buffer_raster(const Scene& scene) {
  return std::make_unique<ItemBufferRaster>(scene);
}

bool raster_is_faster(std::size_t triangle_count) {
  constexpr std::size_t kMeasured = 100;
  return triangle_count <= kMeasured;
}

}  // namespace radiosity
