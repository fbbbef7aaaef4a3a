// Places of a baked file: what they show, and what decides about what they should show.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/verify/places.h"
#include "core/verify/reference.h"
#include "plugin/import_scene.h"
#include "plugin/verify.h"

namespace gltf_radiosity {

/// Shapes: [place_count].
struct VerifiedPlaces {
  std::vector<radiosity::ReferencePlace> places;  ///< on the source's surfaces
  std::vector<radiosity::Rgb> displayed;          ///< by the baked file, linear
  std::vector<std::uint8_t> clipped;              ///< 1 where COLOR_0 is at its upper end
  std::uint64_t unmatched = 0;                    ///< places of the baked file that the source does not have
};

/// Which triangles of a file are baked: unlit, with COLOR_0. [triangle_count].
std::vector<std::uint8_t> baked_triangles(const ImportedScene& output);

/// Whether COLOR_0 is at its upper end: it may have been cut off there.
bool is_clipped(const ImportedScene& output, const radiosity::SurfacePlace& place);

/// What a surface of the source reflects at a place as it is displayed: not limited as in the exchange of light.
radiosity::Rgb displayed_reflectance(const ImportedScene& input, const radiosity::SurfacePlace& place);

/// Finds a place of a baked file in its source. `input`, its `rays` and `output` must outlive it. Thread-safe.
class SourceFinder {
 public:
  SourceFinder(const ImportedScene& input, const radiosity::RayScene& rays, const ImportedScene& output);

  /// What decides about the light at the place, on the front of its triangle; nothing if the source has no surface
  /// there that is baked and faces the same way.
  std::optional<radiosity::ReferencePlace> find(const radiosity::SurfacePlace& place) const;

 private:
  const ImportedScene& input_;
  const ImportedScene& output_;
  radiosity::PlaceFinder finder_;
};

/// Random places all over the baked triangles.
VerifiedPlaces verified_places(const SourceFinder& finder, const ImportedScene& output, const VerifyOptions& options);

}  // namespace gltf_radiosity
