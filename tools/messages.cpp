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

}  // namespace gltf_radiosity::tools
