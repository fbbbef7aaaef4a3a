#include "plugin/light_sources.h"

#include <fmt/format.h>

#include <algorithm>

#include "plugin/import_scene.h"

namespace gltf_radiosity {

using radiosity::Rgb;

Rgb shining_strength(const Rgb& own) {
  const float brightest = std::max({own.x, own.y, own.z});
  Rgb shining = own;
  for (int band = 0; band < 3; ++band) {
    if (!(own[band] > 0.0F)) shining[band] = brightest > 0.0F ? brightest : 1.0F;
  }
  return shining;
}

Result<Done> check_sources(const ImportedScene& scene) {
  constexpr std::size_t kMaxSources = 1024;
  if (scene.sources.size() <= kMaxSources) return Done{};
  return Error{ErrorCode::kLimit, "--save-transport",
               fmt::format("the scene has {} lights, emissive materials and skies; at most {} can be kept apart",
                           scene.sources.size(), kMaxSources)};
}

void let_every_source_shine(ImportedScene& imported) {
  radiosity::Scene& scene = imported.scene;
  scene.dimmers.clear();
  for (const LightSource& source : imported.sources) {
    Rgb dimmer(1.0F);
    for (int band = 0; band < 3; ++band) dimmer[band] = source.strength[band] > 0.0F ? 1.0F : 0.0F;
    scene.dimmers.push_back(dimmer);
  }
  if (scene.dimmers.empty()) scene.dimmers.emplace_back(1.0F);

  for (radiosity::Light& light : scene.lights) {
    const LightSource& source = imported.sources[light.light_group];
    const Rgb shining = shining_strength(source.strength) * source.core_units;
    for (int band = 0; band < 3; ++band) {
      if (!(light.intensity[band] > 0.0F)) light.intensity[band] = shining[band];
    }
  }
  for (ImportedMaterial& material : imported.materials) {
    if (material.emits()) material.dimmed = shining_strength(material.emissive) - material.emissive;
  }
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (scene.surfaces[s].emission != Rgb(0.0F)) scene.surfaces[s].emission += imported.material_of_surface(s).dimmed;
  }
  const bool has_sky =
      std::ranges::any_of(imported.sources, [](const auto& source) { return source.kind == LightSource::Kind::kSky; });
  if (has_sky && !scene.sky.has_map())
    scene.sky.luminance = shining_strength(imported.sources[scene.sky.light_group].strength);
}

}  // namespace gltf_radiosity
