// What shines in a scene, one by one: every light of KHR_lights_punctual, the sun, every emissive material, the sky.
//
// Each is a light group of the core scene, with the index that it has in ImportedScene::sources.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/rgb.h"
#include "plugin/result.h"

namespace gltf_radiosity {

struct ImportedScene;

struct LightSource {
  enum class Kind : std::uint8_t { kLight, kSun, kMaterial, kSky };
  Kind kind = Kind::kLight;
  std::string name;                     ///< in the file, or `lights[0]`, `materials[3]`, `sun`, `sky`
  std::vector<std::string> nodes;       ///< names of the nodes that a light stands at
  std::optional<std::uint32_t> source;  ///< index of a light or material in the document
  /// Colour times intensity, emissive factor times strength, luminance of a sky: in units of the file. Ones for a sky
  /// that is an image.
  radiosity::Rgb strength{1.0F};
  radiosity::Rgb color{1.0F};  ///< of a light, as the file has it
  float core_units = 1.0F;     ///< what a light's strength is multiplied by for the core
};

/// What a source's strength is once let_every_source_shine(): its own, and in bands where that is none as much as in
/// its brightest, or 1.
radiosity::Rgb shining_strength(const radiosity::Rgb& own);

/// An error if there are more sources than each can be kept a light of its own.
Result<Done> check_sources(const ImportedScene& scene);

/// Gives every source a light in every band, and makes the scene's dimmers take it away again: then the light of each
/// light group can be scaled to any colour.
void let_every_source_shine(ImportedScene& imported);

}  // namespace gltf_radiosity
