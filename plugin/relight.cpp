#include "plugin/relight.h"

#include <algorithm>
#include <filesystem>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "core/parallel.h"
#include "core/photometry.h"
#include "core/relight.h"
#include "plugin/compress_geometry.h"
#include "plugin/firewall.h"
#include "plugin/light_changes.h"
#include "plugin/our_extras.h"
#include "plugin/phases.h"
#include "plugin/report_lists.h"
#include "plugin/transport_file.h"
#include "plugin/write_gltf.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

/// An error if the source has changed since the transport was made of it.
Result<Done> check_source(const std::string& source, const TransportDescription& description) {
  if (source.empty()) return Done{};
  const Result<Document> document = read_document(source);
  if (!document) return document.error();
  std::vector<Warning> ignored;
  const Result<ImportedScene> scene = import_displayed(*document, description.scene, ignored);
  if (!scene) return scene.error();
  if (geometry_hash(*scene) == description.geometry) return Done{};
  return bad_input(source, "its geometry is not that of the transport: bake it anew");
}

/// What patches reflect once materials have other factors.
std::vector<Rgb> reflectances(const LoadedTransport& transport, const ChangedLight& changed) {
  std::vector<Rgb> reflectance(transport.light.reflectance.begin(), transport.light.reflectance.end());
  for (std::size_t i = 0; i < reflectance.size(); ++i) {
    const std::uint32_t material = transport.description.material_of_surface[transport.light.surface[i]];
    if (std::ranges::count(changed.materials, material) == 0) continue;
    reflectance[i] = glm::min(transport.light.undyed[i] * changed.factor[material], Rgb(radiosity::kMaxReflectance));
  }
  return reflectance;
}

std::vector<Rgb> changed_irradiance(const LoadedTransport& transport, const ChangedLight& changed,
                                    const radiosity::Progress& progress) {
  const std::vector<Rgb> dimmers = dimmers_of(transport.description, changed);
  if (changed.materials.empty()) return radiosity::relight(transport.light, dimmers);
  return radiosity::relight(transport.light, dimmers, reflectances(transport, changed), progress);
}

/// What the primitives show, as vertex_colors() has it.
std::vector<VertexColors> changed_colors(const LoadedTransport& transport, const ChangedLight& changed,
                                         std::span<const Rgb> irradiance) {
  const TransportDescription& description = transport.description;
  const std::vector<Rgb> dimmers = dimmers_of(description, changed);
  std::vector<VertexColors> colors;
  for (const TransportPrimitive& primitive : description.primitives) {
    const TransportMaterial& material = description.materials[primitive.material];
    const Rgb factor = description.tinted ? changed.factor[primitive.material] : Rgb(1.0F);
    const Rgb dimmer = material.shines ? dimmers[*material.shines] : Rgb(0.0F);
    VertexColors& own = colors.emplace_back();
    for (std::uint64_t row = primitive.first_row; row < primitive.first_row + primitive.row_count; ++row) {
      const Rgb rho = factor * transport.rows.undyed[row];
      const Rgb emitted = transport.rows.emission[row] * dimmer;
      const Rgb shown = radiosity::reflected_luminance(rho, irradiance[transport.rows.vertex[row]]) + emitted;
      add_reflectance(changed.factor[primitive.material] * transport.rows.undyed[row], own.places.empty(), own);
      own.emits = own.emits || emitted != Rgb(0.0F);
      own.unexposed.emplace_back(shown, transport.rows.alpha[row]);
      own.samples.push_back({shown, transport.rows.areas[row], emitted != Rgb(0.0F)});
      own.places.push_back(transport.rows.places[row]);
    }
  }
  return colors;
}

/// Writes `rows` over the values of an accessor of the document. An error if that is not as a bake made it.
Result<Done> overwrite(Document& document, const Json& accessor_index, const RawAccessor& rows) {
  const Error wrong = bad_input("", "the document of the transport is not as a bake leaves it");
  if (!accessor_index.is_number_unsigned()) return wrong;
  const Json& accessor = document.json["accessors"][accessor_index.get<std::size_t>()];
  if (!accessor.contains("bufferView") || accessor.contains("sparse")) return wrong;
  const Json& view = document.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const bool fits = accessor["count"] == rows.count && accessor["componentType"] == static_cast<int>(rows.component) &&
                    view["byteLength"].get<std::size_t>() == rows.bytes.size() && !view.contains("byteStride");
  if (!fits || accessor.value("byteOffset", std::size_t{0}) != 0) return wrong;
  Bytes& buffer = document.buffers[view["buffer"].get<std::size_t>()];
  const auto first = static_cast<std::ptrdiff_t>(view.value("byteOffset", std::size_t{0}));
  std::ranges::copy(rows.bytes, buffer.begin() + first);
  return Done{};
}

/// Whether what a primitive is made of reflects or emits otherwise.
bool is_changed(const TransportMaterial& material, std::size_t index, const ChangedLight& changed) {
  return std::ranges::count(changed.materials, index) > 0 ||
         (material.shines && std::ranges::count(changed.sources, *material.shines) > 0);
}

/// Writes down anew what the bake noted of changed materials.
void renew_notes(LoadedTransport& transport, const ChangedLight& changed, const std::vector<VertexColors>& colors) {
  const TransportDescription& description = transport.description;
  for (std::size_t p = 0; p < colors.size(); ++p) {
    const TransportPrimitive& primitive = description.primitives[p];
    if (!is_changed(description.materials[primitive.material], primitive.material, changed)) continue;
    Json& json = transport.document.json["meshes"][primitive.mesh]["primitives"][primitive.primitive];
    if (json.contains("extras") && json["extras"].is_object() && json["extras"].contains("radiosity")) {
      json["extras"]["radiosity"].erase("reflectance");
      json["extras"]["radiosity"].erase("emits");
    }
    note_reflectance(colors[p], json);
  }
}

Result<Done> write_colors(LoadedTransport& transport, const std::vector<VertexColors>& colors, float k) {
  const TransportDescription& description = transport.description;
  for (std::size_t p = 0; p < colors.size(); ++p) {
    const TransportPrimitive& primitive = description.primitives[p];
    const Json& meshes = transport.document.json["meshes"];
    if (primitive.mesh >= meshes.size() || primitive.primitive >= meshes[primitive.mesh]["primitives"].size()) {
      return bad_input("", "the transport names a primitive that its document does not have");
    }
    const Json attributes = meshes[primitive.mesh]["primitives"][primitive.primitive]["attributes"];
    const RawAccessor rows = color_rows(colors[p], k / primitive.factor, description.color_type);
    if (auto done = overwrite(transport.document, attributes.value("COLOR_0", Json()), rows); !done) return done;
    if (description.radiance_semantic.empty()) continue;
    const Json radiance = attributes.value(description.radiance_semantic, Json());
    if (auto done = overwrite(transport.document, radiance, radiance_rows(colors[p], k)); !done) return done;
  }
  return Done{};
}

void choose_exposure(const TransportDescription& description, const std::vector<VertexColors>& colors,
                     const RelightOptions& options, RelightReport& report) {
  const std::vector<radiosity::ExposureSample> samples = samples_of(colors);
  report.exposure = options.exposure.value_or(description.exposure);
  if (options.auto_exposure) report.exposure = static_cast<double>(radiosity::automatic_exposure(samples));
  report.clipped_share = static_cast<double>(radiosity::clipped_share(samples, static_cast<float>(report.exposure)));
  report.vertices = samples.size();
}

Result<RelightReport> relight_here(const std::string& transport_file, const std::string& output,
                                   const RelightOptions& options, const radiosity::Progress& progress) {
  // Read.
  progress.update("read", 0.0);
  RelightReport report;
  Result<LoadedTransport> transport = load_transport(transport_file, !options.reflectance.empty());
  if (!transport) return transport.error();
  const TransportDescription& description = transport->description;
  if (const auto checked = check_source(options.source, description); !checked) return checked.error();
  const Result<ChangedLight> changed = changed_light(description, options);
  if (!changed) return changed.error();
  if (!changed->materials.empty() && !transport->can_reflect) {
    return Error{ErrorCode::kBadOption, "--reflectance",
                 "the bake kept no form factors, they would have taken more memory than --max-memory leaves for them"};
  }
  report.changed_sources = changed->sources.size();
  report.changed_materials = changed->materials.size();
  progress.update("read", 1.0);

  // Light, colours.
  const std::vector<Rgb> irradiance = changed_irradiance(*transport, *changed, progress);
  progress.update("export", 0.0);
  const std::vector<VertexColors> colors = changed_colors(*transport, *changed, irradiance);
  choose_exposure(description, colors, options, report);
  if (auto done = write_colors(*transport, colors, static_cast<float>(report.exposure)); !done) return done.error();
  renew_notes(*transport, *changed, colors);
  Document& document = transport->document;
  change_document(description, *changed, document.json);
  Json& signature = our_extras(document.json["asset"]);
  signature["exposure"] = report.exposure;
  signature["clipped"] = report.clipped_share;
  progress.update("export", 1.0);

  // Compress, write.
  BufferBuilder added;
  Options compression;
  compression.draco_bits = description.draco_bits;
  compression.meshopt = description.meshopt;
  compression.color_type = description.color_type;
  compress_geometry(document, added, compression, report.warnings, progress);
  progress.update("write", 0.0);
  if (const auto written = write_gltf(std::move(document), added, output); !written) return written.error();
  progress.report("write", 1.0);  // too late to be cancelled
  return report;
}

}  // namespace

Result<RelightReport> relight_file(const std::string& transport, const std::string& output,
                                   const RelightOptions& options, const Callbacks& callbacks) {
  return behind_firewall([&]() -> Result<RelightReport> {
    if (const auto checked = check_output(output); !checked) return checked.error();
    std::error_code ignored;
    if (std::filesystem::equivalent(transport, output, ignored)) {
      return Error{ErrorCode::kBadOption, output, "the output is the transport itself"};
    }
    Phases phases(callbacks);
    Result<RelightReport> report = radiosity::on_threads(
        options.threads, [&] { return relight_here(transport, output, options, phases.progress()); });
    if (report) report->phases = phases.finish();
    return report;
  });
}

std::string to_json(const RelightReport& report) {
  Json json = {{"version", version()},
               {"vertices", report.vertices},
               {"changedSources", report.changed_sources},
               {"changedMaterials", report.changed_materials},
               {"exposure", report.exposure},
               {"clippedShare", report.clipped_share}};
  add_lists(report.phases, report.warnings, json);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gltf_radiosity
