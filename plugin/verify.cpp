#include "plugin/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/mesh/t_vertices.h"
#include "core/parallel.h"
#include "core/verify/compare.h"
#include "core/verify/path_tracer.h"
#include "plugin/check_document.h"
#include "plugin/check_options.h"
#include "plugin/document.h"
#include "plugin/error_picture.h"
#include "plugin/firewall.h"
#include "plugin/image_encode.h"
#include "plugin/import_scene.h"
#include "plugin/pending_files.h"
#include "plugin/phases.h"
#include "plugin/verified_places.h"

namespace gltf_radiosity {
namespace {

/// Both files in memory. The scenes stay where they are: rays and details refer to them.
struct BothScenes {
  ImportedScene input;
  ImportedScene output;
  std::optional<double> written_exposure;
};

/// Two files take part: says which one is meant.
Error in_file(const std::string& file, Error error) {
  if (error.code == ErrorCode::kBadOption) return error;  // about neither
  if (!error.place.starts_with(file)) error.place = error.place.empty() ? file : file + ": " + error.place;
  return error;
}

/// asset.extras.radiosity.exposure, where the baker puts it.
std::optional<double> written_exposure(const Json& root) {
  const Json* member = member_at(root, {"asset", "extras", "radiosity", "exposure"});
  const double exposure = member != nullptr && member->is_number() ? member->get<double>() : 0.0;
  return exposure > 0.0 && std::isfinite(exposure) ? std::optional(exposure) : std::nullopt;
}

/// Only what shows all the light by itself can be compared with the truth.
Result<Done> check_that_all_light_is_shown(const Json& root) {
  const Json* light = member_at(root, {"asset", "extras", "radiosity", "light"});
  if (light != nullptr && light->is_string() && *light != "both") {
    return bad_input("asset.extras.radiosity.light",
                     fmt::format("only {} light was baked: bakes of both are compared", light->get<std::string>()));
  }
  const Json* target = member_at(root, {"asset", "extras", "radiosity", "target"});
  if (target != nullptr && *target == "keep") {
    return bad_input("asset.extras.radiosity.target", "its materials are lit by the engine: unlit ones are compared");
  }
  return Done{};
}

Result<BothScenes> read_both(const std::string& input, const std::string& output, const Options& options,
                             std::vector<Warning>& warnings) {
  BothScenes both;
  const ReadOptions reading{options.allow_outside, options.also_written, default_max_memory()};
  const Result<Document> source = read_document(input, reading);
  if (!source) return in_file(input, source.error());
  Result<ImportedScene> source_scene = import_scene(*source, options, warnings);
  if (!source_scene) {
    const bool about_file = source_scene.error().code != ErrorCode::kBadOption;
    return about_file ? in_file(input, source_scene.error()) : source_scene.error();
  }
  both.input = std::move(*source_scene);

  const Result<Document> baked = read_document(output, reading);
  if (!baked) return in_file(output, baked.error());
  if (const auto checked = check_that_all_light_is_shown(baked->json); !checked)
    return in_file(output, checked.error());
  std::vector<Warning> same_again;  // the source was warned about
  Result<ImportedScene> baked_scene = import_displayed(*baked, options.scene, same_again);
  if (!baked_scene) return in_file(output, baked_scene.error());
  both.output = std::move(*baked_scene);
  both.written_exposure = written_exposure(baked->json);
  return both;
}

/// What the places show and should show, those that are buried left out.
std::vector<radiosity::ComparedPlace> compared_places(const VerifiedPlaces& verified,
                                                      const radiosity::Reference& reference) {
  std::vector<radiosity::ComparedPlace> compared;
  for (std::size_t i = 0; i < verified.places.size(); ++i) {
    if (reference.buried[i] != 0) continue;
    compared.push_back({reference.luminance[i], verified.displayed[i], verified.clipped[i] != 0, reference.variance[i],
                        reference.band_variance[i]});
  }
  return compared;
}

void add_figures(const radiosity::Comparison& comparison, VerifyReport& report) {
  report.exposure = comparison.exposure;
  report.relative_rmse = comparison.relative_rmse;
  report.reference_noise = comparison.reference_noise;
  report.median = comparison.median;
  report.p95 = comparison.p95;
  report.p99 = comparison.p99;
  report.mean_luminance = comparison.mean;
  report.clipped_share = comparison.clipped_share;
}

void count_output(const ImportedScene& output, VerifyReport& report) {
  report.output_triangles = output.scene.triangles.size();
  for (const PrimitiveInstance& instance : output.instances) {
    const auto& source = instance.source_vertex;
    report.output_vertices += source.empty() ? instance.vertex_count : *std::ranges::max_element(source) + 1U;
  }
  const radiosity::Scene& scene = output.scene;
  report.t_vertices =
      radiosity::find_t_vertices(scene.positions, scene.triangles, radiosity::rounding_tolerance(scene.positions))
          .size();
}

void add_warnings(VerifyReport& report) {
  constexpr double kSameExposure = 0.05;
  const auto all = static_cast<double>(report.points + report.unmatched_points + report.buried_points);
  if (static_cast<double>(report.unmatched_points) > 0.01 * all) {
    report.warnings.push_back({"unmatched-points", "",
                               fmt::format("{} of {} points of the baked file do not lie on a surface of the source",
                                           report.unmatched_points, all)});
  }
  constexpr double kFarAboveError = 3.0;
  if (report.reference_noise > kFarAboveError * report.relative_rmse) {
    report.warnings.push_back({"noisy-truth", "",
                               fmt::format("the noise of the truth, {:.2g} %, is far above the error; more samples "
                                           "(--max-samples) tell more",
                                           100.0 * report.reference_noise)});
  }
  if (report.written_exposure && std::abs(report.exposure / *report.written_exposure - 1.0) > kSameExposure) {
    report.warnings.push_back({"exposure-differs", "",
                               fmt::format("the baked file says that its exposure is {:.4g}, but {:.4g} fits best",
                                           *report.written_exposure, report.exposure)});
  }
}

/// A picture must be a PNG.
Result<Done> check_image(const std::string& image) {
  if (image.empty() || std::filesystem::path(image).extension() == ".png") return Done{};
  return Error{ErrorCode::kBadOption, "--image", "must end in .png"};
}

Result<Done> write_picture(const BothScenes& both, const radiosity::RayScene& input_rays, const VerifyReport& report,
                           const VerifyOptions& options, const radiosity::Progress& progress) {
  const radiosity::RayScene output_rays(both.output.scene);
  const PicturedScenes scenes{both.input, input_rays, both.output, output_rays};
  const Pixels pixels = draw_error(scenes, {report.exposure, report.mean_luminance}, options, progress);
  PendingFiles files(options.image);
  if (const auto added = files.add(options.image, encode_png(pixels)); !added) return added.error();
  return files.commit();
}

/// Places, truth, comparison, picture.
Result<VerifyReport> verify_scenes(const BothScenes& both, const std::string& output, const VerifyOptions& options,
                                   VerifyReport report, const radiosity::Progress& progress) {
  // Where.
  const radiosity::RayScene rays(both.input.scene);
  const SourceFinder finder(both.input, rays, both.output);
  const VerifiedPlaces verified = verified_places(finder, both.output, options);
  report.unmatched_points = verified.unmatched;
  if (verified.places.empty() && verified.unmatched == 0) {
    return bad_input(output, "nothing is baked in it: no unlit material with COLOR_0");
  }

  // Truth.
  const radiosity::PathTracer tracer(rays);
  const radiosity::ReferenceOptions reference_options{options.noise, options.max_samples, options.seed};
  const radiosity::Reference reference =
      radiosity::trace_reference(tracer, verified.places, reference_options, progress);
  const std::vector<radiosity::ComparedPlace> compared = compared_places(verified, reference);
  report.points = compared.size();
  report.buried_points = verified.places.size() - compared.size();
  report.paths = reference.sample_count;
  if (compared.empty()) return bad_input(output, "none of its points lies on a visible surface of the source");

  // Comparison.
  add_figures(radiosity::compare(compared, radiosity::fitted_exposure(compared)), report);
  report.written_exposure = both.written_exposure;
  if (both.written_exposure) {
    report.relative_rmse_written_exposure = radiosity::compare(compared, *both.written_exposure).relative_rmse;
  }
  add_warnings(report);

  // Picture.
  if (options.image.empty()) return report;
  if (const auto written = write_picture(both, rays, report, options, progress); !written) return written.error();
  return report;
}

}  // namespace

Result<VerifyReport> verify_files(const std::string& input, const std::string& output, const VerifyOptions& wanted,
                                  const Callbacks& callbacks) {
  return behind_firewall([&]() -> Result<VerifyReport> {
    if (const auto checked = check_options(wanted); !checked) return checked.error();
    if (const auto checked = check_image(wanted.image); !checked) return checked.error();
    VerifyOptions options = wanted;
    options.bake.also_written.push_back(options.image);
    Phases phases(callbacks);
    const radiosity::Progress& progress = phases.progress();
    return radiosity::on_threads(options.bake.threads, [&]() -> Result<VerifyReport> {
      VerifyReport report;
      progress.update("read", 0.0);
      const Result<BothScenes> both = read_both(input, output, options.bake, report.warnings);
      if (!both) return both.error();
      count_output(both->output, report);
      progress.update("read", 1.0);
      Result<VerifyReport> verified = verify_scenes(*both, output, options, std::move(report), progress);
      if (!verified) return verified.error();
      verified->phases = phases.finish();
      return verified;
    });
  });
}

}  // namespace gltf_radiosity
