#include "plugin/gltf_radiosity.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/bake.h"
#include "core/parallel.h"
#include "plugin/cached_bake.h"
#include "plugin/check_options.h"
#include "plugin/compress_geometry.h"
#include "plugin/document.h"
#include "plugin/export_colors.h"
#include "plugin/export_scene.h"
#include "plugin/firewall.h"
#include "plugin/group_files.h"
#include "plugin/import_scene.h"
#include "plugin/light_groups.h"
#include "plugin/make_report.h"
#include "plugin/memory_budget.h"
#include "plugin/phases.h"
#include "plugin/strip_lights.h"
#include "plugin/transport_file.h"
#include "plugin/write_gltf.h"

namespace gltf_radiosity {
namespace {

radiosity::Refine refine_of(Refine refine) {
  switch (refine) {
    case Refine::kNone:
      return radiosity::Refine::kNone;
    case Refine::kUniform:
      return radiosity::Refine::kUniform;
    case Refine::kAdaptive:
      break;
  }
  return radiosity::Refine::kAdaptive;
}

radiosity::LightParts parts_of(BakedLight light) {
  switch (light) {
    case BakedLight::kDirect:
      return radiosity::LightParts::kDirect;
    case BakedLight::kIndirect:
      return radiosity::LightParts::kIndirect;
    case BakedLight::kBoth:
      break;
  }
  return radiosity::LightParts::kBoth;
}

radiosity::Visibility visibility_of(VisibilityMethod method) {
  switch (method) {
    case VisibilityMethod::kRaster:
      return radiosity::Visibility::kRaster;
    case VisibilityMethod::kRays:
      return radiosity::Visibility::kRays;
    case VisibilityMethod::kAuto:
      break;
  }
  return radiosity::Visibility::kAuto;
}

/// What the program and its libraries take before they have read anything.
constexpr std::uint64_t kProgramBytes = std::uint64_t{16} << 20U;

/// What an element of a mesh that is refined costs at most: its place in the mesh, its samples and its share of the
/// fit.
constexpr std::uint64_t kBytesPerElement = 512;

/// What a tile costs at most: itself, what is seen from its sides, and their patches.
constexpr std::uint64_t kBytesPerTile = 192;

std::uint64_t max_memory_of(const Options& options) {
  return options.max_memory > 0 ? options.max_memory : default_max_memory();
}

bool is_refined(const Options& options, const ImportedScene& scene) {
  // A node's own level counts even where all others keep their triangles: the patch size is 0 then.
  return options.refine != Refine::kNone ||
         std::ranges::any_of(scene.level_of_triangle, [](std::int8_t level) { return level > 0; });
}

/// Sets memory aside for the mesh that refinement starts from.
Result<Done> reserve_elements(const Options& options, const ImportedScene& scene, MemoryBudget& memory) {
  if (!is_refined(options, scene)) return Done{};
  return memory.reserve(scene.scene.triangles.size(), kBytesPerElement, "the scene", "triangles that are refined");
}

radiosity::BakeOptions bake_options(const Options& options, const ImportedScene& scene, double patch_size,
                                    const MemoryBudget& memory) {
  radiosity::BakeOptions result;
  result.subdivide.patch_size = static_cast<float>(patch_size);
  result.subdivide.level_of_triangle = scene.level_of_triangle;
  const bool has_levels = options.refine == Refine::kNone && is_refined(options, scene);
  result.refine = has_levels ? radiosity::Refine::kUniform : refine_of(options.refine);
  result.adapt.max_error = options.max_error;
  result.adapt.max_vertices = options.max_vertices;
  result.adapt.space =
      options.error_space == ErrorSpace::kLinear ? radiosity::ErrorSpace::kLinear : radiosity::ErrorSpace::kDisplay;
  result.adapt.exposure = static_cast<float>(options.exposure.value_or(0.0));
  result.hemicube_resolution = options.hemicube;
  result.visibility = visibility_of(options.visibility);
  result.solver =
      options.solver == SolverMethod::kGathering ? radiosity::Solver::kGathering : radiosity::Solver::kProgressive;
  result.fit = options.fit == FitMethod::kInterpolate ? radiosity::Fit::kInterpolate : radiosity::Fit::kLeastSquares;
  // What is kept for relighting is a copy of the rows.
  result.row_cache_bytes = static_cast<std::size_t>(memory.left() / (options.save_transport.empty() ? 2 : 4));
  result.subdivide.max_elements =
      std::min<std::size_t>(result.subdivide.max_elements, memory.left() / 4 / kBytesPerElement);
  result.max_tiles = std::min<std::size_t>(result.max_tiles, memory.left() / 4 / kBytesPerTile);
  result.keep_transport = !options.save_transport.empty();
  result.light_groups = result.keep_transport || options.light_groups != LightGroupStorage::kNone;
  result.parts = parts_of(options.bake);
  result.show_reached_side = options.two_sided == TwoSided::kLit;
  result.residual = static_cast<float>(options.residual);
  result.max_patches = options.max_patches;
  result.threads = options.threads;
  return result;
}

/// The longest edge that the display mesh may have, metres; 0 if it is the scene's own.
double patch_size_of(const Options& options, const ImportedScene& scene) {
  if (options.refine == Refine::kNone) return 0.0;
  if (options.patch_size > 0.0) return options.patch_size;
  return static_cast<double>(options.refine == Refine::kUniform ? radiosity::default_patch_size(scene.scene)
                                                                : radiosity::coarse_patch_size(scene.scene));
}

/// What is to be written.
struct Baked {
  Document document;
  BufferBuilder added;
  std::vector<GroupFile> groups;  ///< with LightGroupStorage::kFiles
};

/// Names the scene's light groups, if they are to be kept apart.
Result<Done> name_light_groups(const Document& document, const Options& options, ImportedScene& scene,
                               std::vector<Warning>& warnings) {
  if (options.light_groups == LightGroupStorage::kNone) return Done{};
  Result<std::vector<std::string>> names = group_lights(document, options, scene, warnings);
  if (!names) return names.error();
  scene.light_groups = std::move(*names);
  return check_group_attributes_are_free(document, options, scene.light_groups);
}

/// Import, bake, export and compress.
Result<Report> bake_document(Baked& baked, const Options& options, const radiosity::Progress& progress) {
  // Import.
  Document& document = baked.document;
  BufferBuilder& added = baked.added;
  Report report;
  report.warnings = document.warnings;
  progress.update("import", 0.0);
  if (const auto fits = document.memory->reserve(1, kProgramBytes, "", "program"); !fits) return fits.error();
  Result<ImportedScene> scene = import_scene(document, options, report.warnings);
  if (!scene) return scene.error();
  if (!options.save_transport.empty()) {
    if (const auto few = check_sources(*scene); !few) return few.error();
    let_every_source_shine(*scene);
  }
  if (const auto named = name_light_groups(document, options, *scene, report.warnings); !named) return named.error();
  if (const auto wrong = radiosity::validate(scene->scene)) return Error{ErrorCode::kInternal, "", *wrong};
  if (const auto free = check_attribute_is_free(document, *scene, options); !free) return free.error();
  if (const auto fits = reserve_elements(options, *scene, *document.memory); !fits) return fits.error();
  add_figures(*scene, report);
  progress.update("import", 1.0);

  // Bake.
  report.patch_size = patch_size_of(options, *scene);
  const Result<CachedBake> cached =
      bake_through_cache(document, *scene, options, bake_options(options, *scene, report.patch_size, *document.memory),
                         report.warnings, progress);
  if (!cached) return cached.error();
  const radiosity::Bake& bake = cached->bake;
  report.cache = name_of(cached->spared);
  add_figures(bake.report, report);
  add_warnings(bake.report, report.warnings);

  // Export.
  const auto export_and_compress = [&]() -> Result<Done> {
    const std::vector<GroupNames> names = group_names(document.json, scene->light_groups);
    ExportReport exported = export_scene(document, added, *scene, bake, options, report.warnings, progress);
    if (options.strip_lights) strip_lights(document);
    baked.groups = group_files(document, added, exported.group_bytes, names);
    progress.update("export", 1.0);
    add_figures(exported, report);
    if (bake.transport) {
      progress.update("transport", 0.0);
      const SavedBake saved{document, added, *scene, bake, exported, options};
      if (auto done = save_transport(saved, report); !done) return done;
      progress.update("transport", 1.0);
    }
    compress_geometry(document, added, options, report.warnings, progress);
    std::vector<Warning> same_again;  // the output was warned about
    for (GroupFile& group : baked.groups) compress_geometry(group.document, group.added, options, same_again, progress);
    return Done{};
  };
  if (const auto done = radiosity::on_threads(options.threads, export_and_compress); !done) return done.error();
  add_figures(options, report);
  report.light_groups = scene->light_groups;
  return report;
}

/// Read, bake_document, and whatever `write` does with the result.
template <typename Read, typename Write>
Result<Report> bake_between(const Read& read, const Write& write, const Options& options, const Callbacks& callbacks) {
  // Read.
  Phases phases(callbacks, options.time_limit);
  const radiosity::Progress& progress = phases.progress();
  progress.update("read", 0.0);
  Result<Document> document = read();
  if (!document) return document.error();
  progress.update("read", 1.0);

  // Bake.
  Baked baked{std::move(*document), {}, {}};
  Result<Report> report = bake_document(baked, options, progress);
  if (!report) return report.error();

  // Write.
  progress.update("write", 0.0);
  const Result<Done> written = write(std::move(baked));
  if (!written) return written.error();
  progress.report("write", 1.0);  // too late to be cancelled
  report->phases = phases.finish();
  return report;
}

}  // namespace

std::string_view version() { return GLTF_RADIOSITY_VERSION; }

std::uint64_t default_max_memory() { return allowed_memory(); }

Result<Report> bake_file(const std::string& input, const std::string& output, const Options& options,
                         const Callbacks& callbacks) {
  return behind_firewall([&]() -> Result<Report> {
    if (const auto checked = check_options(options); !checked) return checked.error();
    if (const auto checked = check_output(output); !checked) return checked.error();
    std::vector<std::string> outputs = options.also_written;
    if (!options.force) outputs.push_back(output);
    const auto read = [&] { return read_document(input, {options.allow_outside, outputs, max_memory_of(options)}); };
    const auto write = [&](Baked baked) {
      if (baked.groups.empty()) return write_gltf(std::move(baked.document), baked.added, output);
      return write_with_groups(std::move(baked.document), baked.added, std::move(baked.groups), input, output);
    };
    return bake_between(read, write, options, callbacks);
  });
}

Result<BakedGlb> bake_memory(std::span<const std::byte> input, const Options& options, const Callbacks& callbacks) {
  return behind_firewall([&]() -> Result<BakedGlb> {
    if (const auto checked = check_options(options); !checked) return checked.error();
    if (options.light_groups == LightGroupStorage::kFiles) {
      return Error{ErrorCode::kBadOption, "--light-groups", "files cannot be written to memory"};
    }
    BakedGlb result;
    const auto read = [&] {
      ReadOptions reading;
      reading.max_memory = max_memory_of(options);
      return read_document(std::span(reinterpret_cast<const std::uint8_t*>(input.data()), input.size()), {}, reading);
    };
    const auto write = [&](Baked baked) -> Result<Done> {
      const Result<Bytes> glb = to_glb(std::move(baked.document), baked.added);
      if (!glb) return glb.error();
      result.glb.resize(glb->size());
      std::memcpy(result.glb.data(), glb->data(), glb->size());
      return Done{};
    };
    Result<Report> report = bake_between(read, write, options, callbacks);
    if (!report) return report.error();
    result.report = std::move(*report);
    return result;
  });
}

}  // namespace gltf_radiosity
