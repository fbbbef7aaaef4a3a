#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "plugin/make_report.h"
#include "plugin/output_style.h"
#include "plugin/report_lists.h"

namespace gltf_radiosity {
namespace {

const char* name_of(radiosity::RefineEnd end) {
  switch (end) {
    case radiosity::RefineEnd::kError:
      return "error";
    case radiosity::RefineEnd::kLimit:
      return "limit";
    case radiosity::RefineEnd::kTime:
      return "time";
    case radiosity::RefineEnd::kFloor:
      return "floor";
    case radiosity::RefineEnd::kNotAdaptive:
      break;
  }
  return "";
}

}  // namespace

void add_figures(const ImportedScene& scene, Report& report) {
  report.input_triangles = scene.scene.triangles.size();
  report.input_vertices = scene.scene.positions.size();
  report.lights = scene.punctual_light_count;
  report.emissive_triangles = scene.emissive_triangle_count;
}

void add_figures(const radiosity::BakeReport& bake, Report& report) {
  report.patches = bake.patch_count;
  report.steps = bake.steps;
  report.buried_elements = bake.buried_element_count;
  report.residual = static_cast<double>(bake.residual);
  report.estimated_error = bake.estimated_error;
  report.refine_rounds = bake.refine_rounds;
  report.refine_end = name_of(bake.refine_end);
  report.time_limit_reached = bake.out_of_time;
  report.emitted_flux = bake.emitted_flux;
  report.absorbed_flux = bake.absorbed_flux;
  report.escaped_flux = bake.escaped_flux;
  report.closure_error = bake.closure_error;
  report.reciprocity_error = bake.reciprocity_error;
  report.lamps = bake.lamp_count;
  report.glow_share = bake.glow_share;
  report.visibility = bake.visibility == radiosity::Visibility::kRaster ? "raster" : "rays";
}

void add_figures(const ExportReport& exported, Report& report) {
  report.output_triangles = exported.triangles;
  report.output_vertices = exported.vertices;
  report.removed_vertices = exported.simplified.removed_vertices;
  report.estimated_error = std::hypot(report.estimated_error, exported.simplified.light_change, exported.texture_error);
  report.exposure = exported.exposure;
  report.clipped_share = exported.clipped_share;
  report.baked_triangles = exported.baked_triangles;
}

void add_figures(const Options& options, Report& report) {
  report.light = name_of(options.bake);
  report.color_type = name_of(output_style(options).color_type);
  report.compression = options.meshopt ? "meshopt" : options.draco_bits != 0 ? "draco" : "";
}

void add_warnings(const radiosity::BakeReport& bake, std::vector<Warning>& warnings) {
  const auto warn = [&](const char* code, std::string message) { warnings.push_back({code, "", std::move(message)}); };
  if (bake.out_of_time) {
    warn("time-limit",
         bake.refine_end == radiosity::RefineEnd::kTime
             ? "time was up before the mesh was as fine as the light needs: what there was then is written"
             : "time was up before the light between surfaces was solved: what there was then is written, which is too "
               "dark");
  }
  if (!bake.lit) warn("no-light", "the scene holds no light: everything is black");
  if (bake.degenerate_triangle_count > 0) {
    warn("degenerate-triangles", fmt::format("triangles without area: {}; they stay in the file and carry no light",
                                             bake.degenerate_triangle_count));
  }
  if (bake.buried_element_count > 0) {
    warn("buried-elements", fmt::format("elements inside other objects: {}; they show the light of their neighbours",
                                        bake.buried_element_count));
  }
  if (bake.glow_share > 0.01) {
    warn("lamps-left-to-hemicubes",
         fmt::format(
             "{:.0f} % of the emitted light comes from more emissive triangles than get shadow rays; its shadows "
             "are only as sharp as hemicubes are",
             100.0 * bake.glow_share));
  }
  if (bake.reflectance_clamped_area > 0.0) {
    warn("reflectance-clamped",
         fmt::format("{:.4g} m2 reflect more than {} of the light: light was computed as if they reflected that",
                     bake.reflectance_clamped_area, radiosity::kMaxReflectance));
  }
  if (bake.reached_tile_limit) {
    warn("tile-limit",
         "patches are coarser than wanted, for there would be too many tiles or too little memory for them; light may "
         "leak where something stands on a patch");
  }
  if (bake.reached_element_limit)
    warn("element-limit", "the mesh grew too large before its edges were as short as the patch size");
}

void add_lists(std::span<const PhaseReport> phases, std::span<const Warning> warnings, Json& report) {
  report["phases"] = Json::array();
  for (const PhaseReport& phase : phases) {
    report["phases"].push_back(
        {{"name", phase.name}, {"seconds", phase.seconds}, {"peakMemoryBytes", phase.peak_memory_bytes}});
  }
  report["warnings"] = Json::array();
  for (const Warning& warning : warnings) {
    report["warnings"].push_back({{"code", warning.code}, {"place", warning.place}, {"message", warning.message}});
  }
}

std::string to_json(const Report& report) {
  Json json = {{"version", version()},
               {"inputTriangles", report.input_triangles},
               {"inputVertices", report.input_vertices},
               {"outputTriangles", report.output_triangles},
               {"outputVertices", report.output_vertices},
               {"removedVertices", report.removed_vertices},
               {"patches", report.patches},
               {"lights", report.lights},
               {"emissiveTriangles", report.emissive_triangles},
               {"steps", report.steps},
               {"buriedElements", report.buried_elements},
               {"patchSize", report.patch_size},
               {"residual", report.residual},
               {"estimatedError", report.estimated_error},
               {"refineRounds", report.refine_rounds},
               {"refineEnd", report.refine_end},
               {"timeLimitReached", report.time_limit_reached},
               {"emittedFlux", report.emitted_flux},
               {"absorbedFlux", report.absorbed_flux},
               {"escapedFlux", report.escaped_flux},
               {"closureError", report.closure_error},
               {"reciprocityError", report.reciprocity_error},
               {"lamps", report.lamps},
               {"glowShare", report.glow_share},
               {"exposure", report.exposure},
               {"clippedShare", report.clipped_share},
               {"bakedTriangles", report.baked_triangles},
               {"light", report.light},
               {"colorType", report.color_type},
               {"compression", report.compression},
               {"visibility", report.visibility},
               {"cache", report.cache},
               {"transportBytes", report.transport_bytes},
               {"transportSources", report.transport_sources},
               {"transportReflectance", report.transport_reflectance},
               {"lightGroups", report.light_groups}};

  add_lists(report.phases, report.warnings, json);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gltf_radiosity
