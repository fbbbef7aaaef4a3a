#include "tools/messages.h"

#include <fmt/format.h>

namespace gltf_radiosity::tools {

std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20U || byte == 0x7fU) c = ' ';
  }
  return line;
}

std::string error_line(std::string_view text) { return fmt::format("gltf-radiosity: error: {}\n", one_line(text)); }

std::string warning_line(const Warning& warning) {
  const std::string place = warning.place.empty() ? "" : warning.place + ": ";
  return fmt::format("gltf-radiosity: warning: {} [{}]\n", one_line(place + warning.message), one_line(warning.code));
}

std::string summary_line(const std::string& output, const Report& report, double seconds) {
  return fmt::format("gltf-radiosity: {}: {} triangles, {} vertices, {:.2f} s, exposure {:.4g} m2/cd\n",
                     one_line(output), report.output_triangles, report.output_vertices, seconds, report.exposure);
}

std::string viewed_line(const std::string& html, const ViewReport& report) {
  constexpr double kMega = 1e6;
  return fmt::format("gltf-radiosity: {}: {:.1f} MB, with a scene of {:.1f} MB\n", one_line(html),
                     static_cast<double>(report.page_bytes) / kMega, static_cast<double>(report.scene_bytes) / kMega);
}

std::string relit_line(const std::string& output, const RelightReport& report, double seconds) {
  return fmt::format("gltf-radiosity: {}: {} vertices, {:.0f} ms, exposure {:.4g} m2/cd\n", one_line(output),
                     report.vertices, 1000.0 * seconds, report.exposure);
}

std::string verified_lines(const VerifyReport& report) {
  std::string written = "the file names none";
  if (report.written_exposure) {
    written = fmt::format("the file says {:.4g}, with which it is {:.2f} %", *report.written_exposure,
                          100.0 * report.relative_rmse_written_exposure.value_or(0.0));
  }
  const std::uint64_t all = report.points + report.unmatched_points + report.buried_points;
  return fmt::format(
             "relative RMSE {:.2f} % (reference noise {:.2f} %, taken out), median {:.2f} %, 95 % {:.2f} %, 99 % "
             "{:.2f} %\n",
             100.0 * report.relative_rmse, 100.0 * report.reference_noise, 100.0 * report.median, 100.0 * report.p95,
             100.0 * report.p99) +
         fmt::format("exposure {:.4g} m2/cd ({}), mean luminance {:.4g} cd/m2, {:.2f} % clipped\n", report.exposure,
                     written, report.mean_luminance, 100.0 * report.clipped_share) +
         fmt::format("{} of {} points ({} not on IN, {} buried), {} paths; OUT has {} triangles, {} vertices\n",
                     report.points, all, report.unmatched_points, report.buried_points, report.paths,
                     report.output_triangles, report.output_vertices);
}

std::string too_inexact_line(const VerifyReport& report, double max_error) {
  return error_line(fmt::format("the relative RMSE of {:.3g} % is above --max-error, {:.3g} %",
                                100.0 * report.relative_rmse, 100.0 * max_error));
}

}  // namespace gltf_radiosity::tools
