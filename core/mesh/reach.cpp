#include "core/mesh/reach.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/emitters.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/visibility/single_ray.h"

namespace radiosity {
namespace {

/// Walks from each patch, unless one of them leads out before, and bounces of a walk: a patch in a room of a hundred
/// lies on thousands of walks, a patch in a slab by itself on these.
constexpr std::uint32_t kWalks = 8;
constexpr int kBounces = 64;

/// A number that follows from the place and not from the order of the triangles.
std::uint64_t hash_of(const SurfacePoint& point) {
  std::uint64_t hash = 0;
  for (int k = 0; k < 3; ++k) {
    for (const float value : {point.position[k], point.normal[k]}) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(value + 0.0F)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29U;
    }
  }
  return hash;
}

/// Walk `k` starts in the middle of a tile, a little inside a corner, or at the middle of an edge: what stands on a
/// tile hides a part of it.
Barycentrics place_of_walk(const SubTriangle& part, std::uint32_t k) {
  const Barycentrics middle = middle_of(part);
  const auto& c = part.corner;
  const std::array<Barycentrics, kWalks> places{middle,
                                                c[0],
                                                c[1],
                                                c[2],
                                                0.5F * (c[0] + c[1]),
                                                0.5F * (c[1] + c[2]),
                                                0.5F * (c[2] + c[0]),
                                                0.5F * (c[0] + middle)};
  return glm::mix(places[k], middle, 0.05F);
}

SurfacePoint surface_point(const Scene& scene, std::uint32_t triangle, Barycentrics at, bool back) {
  const glm::vec3 normal = glm::normalize(scaled_normal(scene, triangle));
  return {point_at(scene, triangle, at), back ? -normal : normal};
}

/// One side of a tile.
struct WalkTile {
  std::uint32_t triangle = kNothing;
  SubTriangle part;
  bool back = false;
  std::uint64_t hash = 0;
};

/// The tiles where the walks of a patch start: as many as there are walks, chosen by their hash.
struct WalkTiles {
  std::array<WalkTile, kWalks> tiles;
  std::uint32_t count = 0;

  void offer(const WalkTile& tile) {
    std::uint32_t at = std::min(count, kWalks - 1);
    if (count == kWalks && !(tile.hash < tiles[at].hash)) return;
    for (; at > 0 && tile.hash < tiles[at - 1].hash; --at) tiles[at] = tiles[at - 1];
    tiles[at] = tile;
    count = std::min(count + 1, kWalks);
  }
};

std::vector<WalkTiles> choose_tiles(const Scene& scene, const Patches& patches, std::uint32_t patch_count) {
  std::vector<WalkTiles> chosen(patch_count);
  patches.tiling.for_each_leaf([&](const Tile& tile) {
    for (const bool back : {false, true}) {
      const std::uint32_t patch = (back ? patches.back_patch_of_tile : patches.patch_of_tile)[tile.tile];
      if (patch >= patch_count) continue;
      const std::uint64_t hash = hash_of(surface_point(scene, tile.triangle, middle_of(tile.part), back));
      chosen[patch].offer({tile.triangle, tile.part, back, hash});
    }
  });
  return chosen;
}

/// Follows light backwards, or forwards: the way is the same.
class Walker {
 public:
  Walker(const RayScene& rays, const Patches& patches)
      : rays_(rays),
        scene_(rays.scene()),
        patches_(patches),
        emitters_(rays.scene(), Emitters::By::kEqualFlux),
        offset_(surface_offset(rays.scene())) {}

  /// Whether a walk from `here` leads to the open or to something that emits. `passed` takes the patches on the way.
  bool leads_out(SurfacePoint here, Random& random, std::vector<std::uint32_t>& passed) const {
    for (int bounce = 0; bounce < kBounces; ++bounce) {
      if (sees_emitter(here, random) || sees_light(here, random)) return true;
      const Ray ray{here.position + offset_ * here.normal, cosine_direction(here.normal, random)};
      const auto hit = nearest_hit(rays_, ray, [&random] { return random.share(); });
      if (!hit) return true;
      const std::uint32_t patch = patches_.patch_at(hit->triangle, hit->at, hit->back);
      if (patch == kNothing) return false;
      if (emitters_.density(hit->triangle) > 0.0F) return true;
      passed.push_back(patch);
      here = surface_point(scene_, hit->triangle, hit->at, hit->back);
    }
    return false;
  }

 private:
  bool is_free(const SurfacePoint& from, const glm::vec3& to, Random& random) const {
    const glm::vec3 start = from.position + offset_ * from.normal;
    const float distance = glm::distance(start, to);
    if (!(distance > 2.0F * offset_) || glm::dot(to - start, from.normal) <= 0.0F) return false;
    const Ray ray{start, (to - start) / distance, distance - 2.0F * offset_};
    return !is_blocked(rays_, ray, [&random] { return random.share(); });
  }

  /// Of many, one: a walk has many bounces.
  bool sees_emitter(const SurfacePoint& here, Random& random) const {
    if (emitters_.empty()) return false;
    const EmitterPlace place = emitters_.choose(random);
    const glm::vec3 there = point_at(scene_, place.triangle, place.at);
    const bool faces = glm::dot(here.position - there, scaled_normal(scene_, place.triangle)) > 0.0F;
    if (!faces && !scene_.surfaces[scene_.surface_of_triangle[place.triangle]].two_sided) return false;
    return is_free(here, there, random);
  }

  bool sees_light(const SurfacePoint& here, Random& random) const {
    if (scene_.lights.empty()) return false;
    const auto chosen = random.bits() % static_cast<std::uint32_t>(scene_.lights.size());
    const Light& light = scene_.lights[chosen];
    return light.kind != Light::Kind::kDirectional && is_free(here, light.position, random);
  }

  const RayScene& rays_;
  const Scene& scene_;
  const Patches& patches_;
  Emitters emitters_;
  float offset_;
};

}  // namespace

std::vector<std::uint8_t> find_reached(const RayScene& rays, const Patches& patches, std::uint32_t patch_count,
                                       const Progress& progress) {
  const Scene& scene = rays.scene();
  const std::vector<WalkTiles> chosen = choose_tiles(scene, patches, patch_count);
  const Walker walker(rays, patches);
  std::vector<std::uint8_t> reached(patch_count, 0);
  parallel_in_chunks(patch_count, 256, progress, "patches", [&](std::size_t patch) {
    thread_local std::vector<std::uint32_t> passed;
    bool out = false;
    for (std::uint32_t walk = 0; walk < kWalks && !out; ++walk) {
      passed.assign(1, static_cast<std::uint32_t>(patch));
      const WalkTile& tile = chosen[patch].tiles[walk % chosen[patch].count];
      Random random(walk, tile.hash);
      out = walker.leads_out(surface_point(scene, tile.triangle, place_of_walk(tile.part, walk), tile.back), random,
                             passed);
    }
    // Whoever is first, the flag that is set is the same.
    for (std::size_t k = 0; out && k < passed.size(); ++k) {
      if (passed[k] < patch_count) std::atomic_ref(reached[passed[k]]).store(1, std::memory_order_relaxed);
    }
  });
  const bool nothing = std::find(reached.begin(), reached.end(), 1) == reached.end();
  if (nothing) std::fill(reached.begin(), reached.end(), std::uint8_t{1});
  return reached;
}

}  // namespace radiosity
