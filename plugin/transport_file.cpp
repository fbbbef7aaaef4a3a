#include "plugin/transport_file.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <system_error>

#include "plugin/archive_writer.h"
#include "plugin/output_style.h"
#include "plugin/transport_description.h"
#include "plugin/write_gltf.h"

namespace gltf_radiosity {
namespace {

using radiosity::KeptTransport;
using radiosity::LightTransport;
using radiosity::Rgb;

constexpr ArchiveKind kTransportKind{"light transport", 1};

std::string name_of_material(const Document& document, const std::optional<std::uint32_t>& source) {
  if (!source) return "default material";
  const std::string name = document.json["materials"][*source].value("name", std::string());
  return name.empty() ? place_of("materials", *source) : name;
}

TransportDescription describe(const SavedBake& saved) {
  const ImportedScene& scene = saved.scene;
  TransportDescription description;
  description.sources = scene.sources;
  for (const ImportedMaterial& material : scene.materials) {
    description.materials.push_back({name_of_material(saved.document, material.source), material.source,
                                     Rgb(material.base_color_factor), std::nullopt,
                                     static_cast<bool>(material.transmission)});
    for (std::uint32_t s = 0; s < scene.sources.size(); ++s) {
      const bool is_it =
          scene.sources[s].kind == LightSource::Kind::kMaterial && scene.sources[s].source == material.source;
      if (is_it) description.materials.back().shines = s;
    }
  }
  description.material_of_surface = scene.detail->material_of_surface;
  for (const ExportedColors& colors : saved.exported.colors) {
    const PrimitiveInstance& instance = scene.instances[colors.instance];
    const std::uint64_t first = description.primitives.empty()
                                    ? 0
                                    : description.primitives.back().first_row + description.primitives.back().row_count;
    description.primitives.push_back({colors.mesh, colors.primitive, instance.material, colors.factor, first,
                                      saved.exported.refined[colors.instance].written_vertex_count()});
  }
  description.exposure = saved.exported.exposure;
  description.geometry = geometry_hash(scene);
  description.scene = saved.options.scene;
  description.tinted = color_parts(saved.options).base_color;
  if (!saved.options.radiance_attribute.empty()) description.radiance_semantic = radiance_semantic(saved.options);
  description.parts = saved.bake.transport->parts;
  description.color_type = output_style(saved.options).color_type;
  description.draco_bits = saved.options.draco_bits;
  description.meshopt = saved.options.meshopt;
  return description;
}

/// TransportRows, owned.
struct OwnedRows {
  std::vector<std::uint32_t> vertex;
  std::vector<Rgb> undyed, emission;
  std::vector<float> alpha, areas;
  std::vector<std::uint32_t> places;
};

OwnedRows rows_of(const SavedBake& saved) {
  OwnedRows rows;
  const ColorParts parts = color_parts(saved.options);
  for (const ExportedColors& colors : saved.exported.colors) {
    const RefinedPrimitive& refined = saved.exported.refined[colors.instance];
    const std::uint32_t material = saved.scene.instances[colors.instance].material;
    const ColorTerms terms =
        color_terms(saved.scene, saved.bake, refined, colors.instance, parts, saved.exported.textures[material]);
    for (std::size_t row = 0; row < refined.written_vertex_count(); ++row) {
      const std::size_t v = refined.kept.empty() ? row : refined.kept[row];
      rows.vertex.push_back(refined.vertices[v]);
      rows.undyed.push_back(terms.undyed[v]);
      rows.emission.push_back(terms.emission[v]);
      rows.alpha.push_back(terms.alpha[v]);
      rows.areas.push_back(terms.areas[v]);
      rows.places.push_back(terms.places[v]);
    }
  }
  return rows;
}

/// Calls visit(name, member, packing) for every chunk of what other lights take. `Transport` is the owned kind or the
/// views.
template <typename Transport, typename Visit>
void for_light(Transport& transport, const Visit& visit) {
  visit("light.value_of_vertex", transport.value_of_vertex, Packing::kPlain);
  visit("light.fits", transport.fits, Packing::kPlain);
  visit("light.fit_values", transport.fit_values, Packing::kZstd);
  visit("light.fit_shares", transport.fit_shares, Packing::kZstd);
}

/// The same for other reflectances.
template <typename Transport, typename Visit>
void for_exchange(Transport& transport, const Visit& visit) {
  visit("exchange.row_begin", transport.row_begin, Packing::kPlain);
  visit("exchange.row_patch", transport.row_patch, Packing::kZstd);
  visit("exchange.row_factor", transport.row_factor, Packing::kZstd);
  visit("exchange.surface", transport.surface, Packing::kZstd);
  visit("exchange.reflectance", transport.reflectance, Packing::kPlain);
  visit("exchange.undyed", transport.undyed, Packing::kPlain);
  visit("exchange.glow", transport.glow, Packing::kZstd);
  visit("exchange.glow_group", transport.glow_group, Packing::kZstd);
  visit("exchange.patch_direct", transport.patch_direct, Packing::kZstd);
  visit("exchange.sample_element", transport.sample_element, Packing::kZstd);
  visit("exchange.sample_weight", transport.sample_weight, Packing::kZstd);
  visit("exchange.sample_direct", transport.sample_direct, Packing::kZstd);
  visit("exchange.cell_factor", transport.cell_factor, Packing::kPlain);
  visit("exchange.cell_patch", transport.cell_patch, Packing::kZstd);
}

template <typename Rows, typename Visit>
void for_rows(Rows& rows, const Visit& visit) {
  visit("rows.vertex", rows.vertex, Packing::kPlain);
  visit("rows.undyed", rows.undyed, Packing::kZstd);
  visit("rows.emission", rows.emission, Packing::kZstd);
  visit("rows.alpha", rows.alpha, Packing::kZstd);
  visit("rows.areas", rows.areas, Packing::kPlain);
  visit("rows.places", rows.places, Packing::kPlain);
}

/// Reads chunks into spans and keeps who owns them, until the first that is wrong.
struct ChunkReader {
  const Archive& archive;
  std::vector<std::shared_ptr<const void>>& owners;
  std::optional<Error>& error;

  template <typename T>
  void operator()(const char* name, std::span<const T>& values, Packing /*packing*/) const {
    if (error) return;
    Result<Chunk<T>> chunk = archive.read<T>(name);
    if (!chunk) {
      error = chunk.error();
      return;
    }
    values = chunk->values;
    owners.push_back(std::move(chunk->owner));
  }
};

bool all_below(std::span<const std::uint32_t> indices, std::size_t count) {
  return std::ranges::all_of(indices, [count](std::uint32_t index) { return index < count; });
}

/// What is wrong with the shapes and indices of what other lights take, or nothing.
const char* wrong_light(const TransportDescription& description, const TransportRows& rows,
                        const LightTransport& light) {
  const std::size_t row_count = rows.vertex.size();
  const bool rows_agree = rows.undyed.size() == row_count && rows.emission.size() == row_count &&
                          rows.alpha.size() == row_count && rows.areas.size() == row_count &&
                          rows.places.size() == row_count && all_below(rows.vertex, light.value_of_vertex.size());
  if (!rows_agree) return "rows do not fit each other";
  std::uint64_t next_row = 0;
  for (const TransportPrimitive& primitive : description.primitives) {
    if (primitive.first_row != next_row || primitive.row_count > row_count - next_row) return "rows are missing";
    next_row += primitive.row_count;
  }
  if (light.fits.size() % light.group_count != 0) return "fits do not fit the light groups";
  if (!all_below(light.value_of_vertex, light.value_count())) return "a vertex has no value";
  if (light.fit_shares.size() != light.fit_values.size() * 6) return "the fit's matrix is incomplete";
  const bool values_exist = std::ranges::all_of(light.fit_values, [&](const glm::uvec3& at) {
    return std::max({at.x, at.y, at.z}) < light.value_count();
  });
  return values_exist ? nullptr : "the fit's matrix names values that do not exist";
}

/// The same for other reflectances.
const char* wrong_exchange(const TransportDescription& description, const LightTransport& light) {
  const std::size_t patch_count = light.reflectance.size(), sample_count = light.sample_element.size();
  const bool patches_agree = light.row_begin.size() == patch_count + 1 && light.surface.size() == patch_count &&
                             light.undyed.size() == patch_count && light.glow.size() == patch_count &&
                             light.glow_group.size() == patch_count &&
                             light.patch_direct.size() == patch_count * light.group_count;
  if (!patches_agree) return "patches do not fit each other";
  const bool rows_agree = std::ranges::is_sorted(light.row_begin) && light.row_begin.front() == 0 &&
                          light.row_begin.back() == light.row_patch.size() &&
                          light.row_factor.size() == light.row_patch.size() && all_below(light.row_patch, patch_count);
  if (!rows_agree) return "rows of form factors do not fit the patches";
  const bool indices_exist = all_below(light.surface, description.material_of_surface.size()) &&
                             all_below(light.glow_group, light.group_count) &&
                             all_below(light.sample_element, light.fit_values.size());
  if (!indices_exist) return "indices lead nowhere";
  const bool samples_agree = light.sample_weight.size() == sample_count &&
                             light.sample_direct.size() == sample_count * light.group_count &&
                             light.cell_patch.size() == sample_count * light.cell_factor.size();
  if (!samples_agree) return "samples do not fit each other";
  const bool cells_exist = std::ranges::all_of(light.cell_patch, [patch_count](std::uint32_t patch) {
    return patch == radiosity::kNothing || patch < patch_count;
  });
  return cells_exist ? nullptr : "cells see patches that do not exist";
}

Result<Done> read_light(const Archive& archive, bool with_exchange, LoadedTransport& loaded) {
  std::optional<Error> error;
  const ChunkReader read{archive, loaded.owners, error};
  for_rows(loaded.rows, read);
  for_light(loaded.light, read);
  if (error) return *error;
  loaded.light.group_count = static_cast<std::uint32_t>(std::max<std::size_t>(1, loaded.description.sources.size()));
  loaded.light.parts = loaded.description.parts;
  if (const char* wrong = wrong_light(loaded.description, loaded.rows, loaded.light)) {
    return archive.damaged("light", wrong);
  }
  loaded.can_reflect = archive.holds("exchange.row_begin");
  if (!with_exchange || !loaded.can_reflect) return Done{};
  for_exchange(loaded.light, read);
  if (error) return *error;
  const char* wrong = wrong_exchange(loaded.description, loaded.light);
  return wrong == nullptr ? Result<Done>(Done{}) : archive.damaged("exchange", wrong);
}

}  // namespace

std::uint64_t geometry_hash(const ImportedScene& imported) {
  const radiosity::Scene& scene = imported.scene;
  std::uint64_t hash = 0;
  const auto add = [&hash](const auto& values) {
    hash = ::XXH3_64bits_withSeed(values.data(), values.size() * sizeof(values[0]), hash);
  };
  add(scene.positions);
  add(scene.normals);
  add(scene.triangles);
  add(scene.surface_of_triangle);
  std::vector<std::uint32_t> surfaces;
  for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
    surfaces.push_back(imported.detail->material_of_surface[s] * 2 + (scene.surfaces[s].two_sided ? 1 : 0));
  }
  add(surfaces);
  return hash;
}

Result<Done> save_transport(const SavedBake& saved, Report& report) {
  const Result<Bytes> glb = to_glb(saved.document, saved.added);
  if (!glb) return glb.error();
  const OwnedRows rows = rows_of(saved);
  const KeptTransport& transport = *saved.bake.transport;
  ArchiveWriter writer(kTransportKind);
  const auto add = [&writer](const char* name, const auto& values, Packing packing) {
    writer.add(name, values, packing);
  };
  writer.add_text("description", to_text(describe(saved)));
  writer.add("document", *glb, Packing::kPlain);
  for_rows(rows, add);
  for_light(transport, add);
  if (!transport.row_begin.empty()) for_exchange(transport, add);
  const std::filesystem::path target = saved.options.save_transport;
  if (const auto written = writer.write(target); !written) return written.error();
  std::error_code error;
  report.transport_bytes = std::filesystem::file_size(target, error);
  report.transport_sources = saved.scene.sources.size();
  report.transport_reflectance = !transport.row_begin.empty();
  if (!report.transport_reflectance) {
    report.warnings.push_back({"transport-without-exchange", saved.options.save_transport,
                               "the form factors would have taken more than --max-memory leaves for them: relight can "
                               "change lights, but not what surfaces reflect"});
  }
  return Done{};
}

Result<LoadedTransport> load_transport(const std::filesystem::path& path, bool with_exchange) {
  const Result<Archive> archive = Archive::open(path, kTransportKind);
  if (!archive) return archive.error();
  const Result<std::string> text = archive->read_text("description");
  if (!text) return text.error();
  Result<TransportDescription> description = read_description(*text);
  if (!description) return archive->damaged("description", description.error().message);
  LoadedTransport loaded;
  loaded.description = std::move(*description);

  const Result<Chunk<std::uint8_t>> glb = archive->read<std::uint8_t>("document");
  if (!glb) return glb.error();
  Result<Document> document = read_document(glb->values, {});
  if (!document) return archive->damaged("document", document.error().message);
  loaded.document = std::move(*document);
  if (const auto read = read_light(*archive, with_exchange, loaded); !read) return read.error();
  return loaded;
}

}  // namespace gltf_radiosity
