#include "core/visibility/item_buffer_rays.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/visibility/embree_scene.h"

namespace radiosity {
namespace {

constexpr int kTileWidth = 4;

/// Packets of 16 rays are tiles of 4 x 4 cells; where the processor has no instructions for them, 4 x 2.
struct PacketOf16 {
  static constexpr int kSize = 16;
  using RayHits = RTCRayHit16;
  static constexpr auto kIntersect = rtcIntersect16;
};
struct PacketOf8 {
  static constexpr int kSize = 8;
  using RayHits = RTCRayHit8;
  static constexpr auto kIntersect = rtcIntersect8;
};

float threshold_of_cell(const void* viewpoint, unsigned cell) {
  return opacity_threshold(*static_cast<const Viewpoint*>(viewpoint), static_cast<int>(cell));
}

/// One face of a hemicube in the world, its axes scaled so that steps count cells.
struct WorldFace {
  glm::vec3 first;  ///< through the centre of cell (0, 0)
  glm::vec3 column, row;
};

WorldFace place(const Hemicube::Face& face, const Frame& axes, int resolution) {
  const auto to_world = [&](const glm::vec3& a) { return a.x * axes.u + a.y * axes.v + a.z * axes.w; };
  const float width = 2.0F / static_cast<float>(resolution);
  const glm::vec3 column = width * to_world(face.right);
  const glm::vec3 row = width * to_world(face.up);
  return {to_world(face.axis - face.right - face.up_start * face.up) + 0.5F * (column + row), column, row};
}

/// Traces one hemicube, tile by tile.
template <typename Packet>
class Tracer {
 public:
  Tracer(const RayScene::Impl& rays, int resolution, const Viewpoint& viewpoint, ItemBuffer& items)
      : rays_(rays), items_(items), context_{{}, threshold_of_cell, &viewpoint} {
    // Neighbouring cells look almost the same way: Embree's coherent traversal is up to twice as fast as the other.
    // Where a packet is a whole face it is slower by a third.
    rtcInitIntersectContext(&context_.embree);
    if (resolution > kTileWidth) context_.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;

    // What stays the same from tile to tile.
    std::fill_n(packet_.ray.org_x, Packet::kSize, viewpoint.position.x);
    std::fill_n(packet_.ray.org_y, Packet::kSize, viewpoint.position.y);
    std::fill_n(packet_.ray.org_z, Packet::kSize, viewpoint.position.z);
    std::fill_n(packet_.ray.tnear, Packet::kSize, 0.0F);
    std::fill_n(packet_.ray.time, Packet::kSize, 0.0F);
    std::fill_n(packet_.ray.mask, Packet::kSize, ~0U);
    std::fill_n(packet_.ray.flags, Packet::kSize, 0U);
  }

  void trace_face(const Hemicube::Face& face, const WorldFace& world) {
    for (int row = 0; row < face.rows; row += kTileHeight) {
      for (int column = 0; column < face.columns; column += kTileWidth) {
        trace_tile(face, world, column, row);
      }
    }
  }

 private:
  static constexpr int kTileHeight = Packet::kSize / kTileWidth;

  void trace_tile(const Hemicube::Face& face, const WorldFace& world, int column, int row) {
    const int columns = std::min(kTileWidth, face.columns - column);
    const int rows = std::min(kTileHeight, face.rows - row);
    const int first_cell = face.first_cell + row * face.columns + column;
    const glm::vec3 corner =
        world.first + static_cast<float>(column) * world.column + static_cast<float>(row) * world.row;
    aim(world, corner, first_cell, face.columns);
    if (columns != lanes_columns_ || rows != lanes_rows_) {
      choose_lanes(columns, rows);
    }
    Packet::kIntersect(active_, rays_.embree.get(), &context_.embree, &packet_);
    for (int i = 0; i < rows; ++i) {
      store_row(i * kTileWidth, columns, static_cast<std::size_t>(first_cell + i * face.columns));
    }
  }

  void aim(const WorldFace& world, const glm::vec3& corner, int first_cell, int stride) {
    for (int lane = 0; lane < Packet::kSize; ++lane) {
      const auto column = static_cast<float>(lane % kTileWidth);
      const auto row = static_cast<float>(lane / kTileWidth);
      packet_.ray.dir_x[lane] = corner.x + column * world.column.x + row * world.row.x;
      packet_.ray.dir_y[lane] = corner.y + column * world.column.y + row * world.row.y;
      packet_.ray.dir_z[lane] = corner.z + column * world.column.z + row * world.row.z;
      packet_.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      packet_.ray.id[lane] = static_cast<unsigned>(first_cell + lane / kTileWidth * stride + lane % kTileWidth);
      packet_.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  /// Tiles at the far edges of a face may hang over it.
  void choose_lanes(int columns, int rows) {
    for (int lane = 0; lane < Packet::kSize; ++lane) {
      active_[lane] = lane % kTileWidth < columns && lane / kTileWidth < rows ? -1 : 0;
    }
    lanes_columns_ = columns;
    lanes_rows_ = rows;
  }

  void store_row(int first_lane, int columns, std::size_t first_cell) {
    for (int i = 0; i < columns; ++i) {
      const int lane = first_lane + i;
      const std::size_t cell = first_cell + static_cast<std::size_t>(i);
      const unsigned geometry = packet_.hit.geomID[lane];
      const bool hit = geometry != RTC_INVALID_GEOMETRY_ID;
      const float along_normal = packet_.ray.dir_x[lane] * packet_.hit.Ng_x[lane] +
                                 packet_.ray.dir_y[lane] * packet_.hit.Ng_y[lane] +
                                 packet_.ray.dir_z[lane] * packet_.hit.Ng_z[lane];
      items_.triangle[cell] = hit ? rays_.triangle_of[geometry][packet_.hit.primID[lane]] : kNothing;
      items_.barycentrics[cell] = hit ? Barycentrics(packet_.hit.u[lane], packet_.hit.v[lane]) : Barycentrics(0.0F);
      items_.back[cell] = hit && along_normal > 0.0F ? 1 : 0;
    }
  }

  const RayScene::Impl& rays_;
  ItemBuffer& items_;
  RayContext context_;
  typename Packet::RayHits packet_{};
  alignas(64) int active_[Packet::kSize];
  int lanes_columns_ = 0;
  int lanes_rows_ = 0;
};

class ItemBufferRays final : public ItemBufferMaker {
 public:
  explicit ItemBufferRays(const RayScene& rays) : rays_(rays.impl()) {}

  void fill(const Hemicube& hemicube, const Viewpoint& viewpoint, ItemBuffer& items) const override {
    items.resize(hemicube.cell_count());
    if (rays_.native_packets_of_16) {
      trace<PacketOf16>(hemicube, viewpoint, items);
    } else {
      trace<PacketOf8>(hemicube, viewpoint, items);
    }
  }

 private:
  template <typename Packet>
  void trace(const Hemicube& hemicube, const Viewpoint& viewpoint, ItemBuffer& items) const {
    const Frame axes = frame(viewpoint);
    Tracer<Packet> tracer(rays_, hemicube.resolution(), viewpoint, items);
    for (const Hemicube::Face& face : hemicube.faces()) {
      tracer.trace_face(face, place(face, axes, hemicube.resolution()));
    }
  }

  const RayScene::Impl& rays_;
};

}  // namespace

std::unique_ptr<ItemBufferMaker> make_item_buffer_rays(const RayScene& rays) {
  return std::make_unique<ItemBufferRays>(rays);
}

}  // namespace radiosity
