#include "plugin/cache_keys.h"

#include <algorithm>
#include <set>

#include "plugin/content_hash.h"

namespace gltf_radiosity {
namespace {

/// The bytes of all buffers and of the images `is_wanted` asks for.
template <typename IsWanted>
void add_data(const Document& document, ContentHash& hash, const IsWanted& is_wanted) {
  for (const Bytes& buffer : document.buffers) hash.add(buffer);
  const std::size_t image_count = document.json.contains("images") ? document.json["images"].size() : 0;
  for (std::size_t i = 0; i < image_count; ++i) {
    if (!is_wanted(i)) continue;
    const Result<Bytes> bytes = image_bytes(document, i);
    hash.add_value(static_cast<bool>(bytes));  // one that cannot be read is no matter unless the import needs it
    if (bytes) hash.add(*bytes);
  }
}

/// The tree without what no light depends on. Data goes by its bytes, not by its place.
std::string tree_that_matters(const Document& document) {
  Json root = document.json;
  for (const char* key : {"animations", "cameras"}) root.erase(key);
  if (root.contains("asset") && root["asset"].is_object()) root["asset"].erase("extras");
  for (const char* array : {"buffers", "images"}) {
    if (!root.contains(array)) continue;
    for (Json& item : root[array]) item.erase("uri");
  }
  return root.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<Done> add_import_options(const Options& options, ContentHash& hash) {
  hash.add_value(options.scene);
  for (const auto& [name, level] : options.subdivide) {
    hash.add(std::string_view(name));
    hash.add_value(level);
  }
  for (const auto* patterns : {&options.select, &options.exclude}) {
    hash.add_value(patterns->size());
    for (const std::string& pattern : *patterns) hash.add(std::string_view(pattern));
  }
  hash.add_value(options.sky.has_value());
  if (options.sky) hash.add(std::span<const double>(*options.sky));
  if (!options.sky_file.empty()) {
    const Result<Bytes> sky = read_file(options.sky_file, "");
    if (!sky) return sky.error();
    hash.add(*sky);
  }
  hash.add_value(options.sky_rotation_degrees);
  hash.add_value(options.sun.has_value());
  if (options.sun) {
    hash.add_value(options.sun->elevation_degrees);
    hash.add_value(options.sun->azimuth_degrees);
    hash.add_value(options.sun->illuminance_lux);
  }
  hash.add_value(options.default_sky);
  hash.add_value(options.metals);
  hash.add_value(options.light_units);
  return Done{};
}

void add_bake_options(const radiosity::BakeOptions& options, ContentHash& hash) {
  hash.add_value(options.refine);
  hash.add_value(options.subdivide.patch_size);
  hash.add(options.subdivide.level_of_triangle);
  hash.add_value(options.adapt.max_error);
  hash.add_value(options.adapt.max_vertices);
  hash.add_value(options.adapt.space);
  hash.add_value(options.adapt.exposure);
  hash.add_value(options.adapt.min_edge);
  hash.add_value(options.hemicube_resolution);
  hash.add_value(options.visibility);
  hash.add_value(options.solver);
  hash.add_value(options.fit);
  hash.add_value(options.show_reached_side);
  hash.add_value(options.parts);
  hash.add_value(options.residual);
  hash.add_value(options.max_patches);
  hash.add_value(options.lamp_rays);
}

/// What the opacity of surfaces depends on, if any lets light through.
void add_opacity(const Document& document, const ImportedScene& scene, ContentHash& hash) {
  const auto& surfaces = scene.scene.surfaces;
  std::set<std::uint32_t> materials;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!surfaces[s].see_through) continue;
    const auto source = scene.materials[scene.detail->material_of_surface[s]].source;
    if (source) materials.insert(*source);
  }
  if (materials.empty()) return;
  for (const std::uint32_t material : materials)
    hash.add(std::string_view(document.json["materials"][material].dump()));
  for (const char* array : {"textures", "samplers", "images"}) {
    if (!document.json.contains(array)) continue;
    for (Json item : document.json[array]) {
      item.erase("uri");
      hash.add(std::string_view(item.dump(-1, ' ', false, Json::error_handler_t::replace)));
    }
  }
  add_data(document, hash, [](std::size_t /*image*/) { return true; });
}

}  // namespace

Result<std::string> bake_key(const Document& document, const Options& options,
                             const radiosity::BakeOptions& bake_options) {
  ContentHash hash;
  hash.add(version());
  hash.add(std::string_view(tree_that_matters(document)));
  add_data(document, hash, [](std::size_t /*image*/) { return true; });
  if (const auto added = add_import_options(options, hash); !added) return added.error();
  add_bake_options(bake_options, hash);
  return hash.digits();
}

std::string rows_key(const Document& document, const ImportedScene& scene, const radiosity::RowInputs& inputs) {
  ContentHash hash;
  hash.add(version());
  hash.add_value(inputs.hemicube_resolution);
  hash.add_value(inputs.raster);

  // Shapes, and how each side of them takes part.
  const radiosity::Scene& shapes = inputs.scene;
  hash.add(shapes.positions);
  hash.add(shapes.triangles);
  std::vector<std::uint8_t> kind_of_triangle;
  kind_of_triangle.reserve(shapes.triangles.size());
  for (const std::uint32_t s : shapes.surface_of_triangle) {
    const radiosity::Surface& surface = shapes.surfaces[s];
    kind_of_triangle.push_back(static_cast<std::uint8_t>((surface.two_sided ? 1 : 0) + (surface.see_through ? 2 : 0)));
  }
  hash.add(kind_of_triangle);
  add_opacity(document, scene, hash);

  // Patches: where they lie and from which points they look around.
  const radiosity::Patches& patches = inputs.patches;
  hash.add(patches.tiling.cuts_of_triangle);
  hash.add(patches.tiling.first_of_triangle);
  hash.add(patches.tiling.first_child);
  hash.add(patches.patch_of_tile);
  hash.add(patches.back_patch_of_tile);
  hash.add(patches.points);
  hash.add_value(patches.points_per_patch);

  // A sky with a map is part of the rows.
  const radiosity::Sky& sky = shapes.sky;
  hash.add(sky.map);
  if (sky.has_map()) {
    hash.add_value(sky.width);
    hash.add_value(sky.height);
    hash.add(std::span<const glm::mat3>(&sky.map_from_world, 1));
  }
  return hash.digits();
}

}  // namespace gltf_radiosity
