#include "plugin/report_lists.h"
#include "plugin/verify.h"

namespace gltf_radiosity {

std::string to_json(const VerifyReport& report) {
  const auto number_or_null = [](const std::optional<double>& number) { return number ? Json(*number) : Json(); };
  Json json = {{"version", version()},
               {"points", report.points},
               {"unmatchedPoints", report.unmatched_points},
               {"buriedPoints", report.buried_points},
               {"exposure", report.exposure},
               {"writtenExposure", number_or_null(report.written_exposure)},
               {"relativeRmse", report.relative_rmse},
               {"relativeRmseWrittenExposure", number_or_null(report.relative_rmse_written_exposure)},
               {"referenceNoise", report.reference_noise},
               {"median", report.median},
               {"p95", report.p95},
               {"p99", report.p99},
               {"meanLuminance", report.mean_luminance},
               {"clippedShare", report.clipped_share},
               {"paths", report.paths},
               {"outputTriangles", report.output_triangles},
               {"outputVertices", report.output_vertices},
               {"tVertices", report.t_vertices}};
  add_lists(report.phases, report.warnings, json);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gltf_radiosity
