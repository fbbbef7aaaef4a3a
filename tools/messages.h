// The lines that people read on stderr. Each is one line, whatever the names in the file hold.
#pragma once

#include <string>
#include <string_view>

#include "plugin/relight.h"
#include "plugin/verify.h"
#include "plugin/view.h"
#include "tools/command_line.h"

namespace gltf_radiosity::tools {

/// `text` on one line: control characters (line breaks, terminal commands) become spaces.
std::string one_line(std::string_view text);

/// gltf-radiosity: error: meshes[3].primitives[0]: ...
std::string error_line(std::string_view text);

/// gltf-radiosity: warning: nodes[3]: ... [code]
std::string warning_line(const Warning& warning);

/// gltf-radiosity: baked.glb: 12345 triangles, 6789 vertices, 1.23 s, exposure 1 m2/cd
std::string summary_line(const std::string& output, const Report& report, double seconds);

/// gltf-radiosity: page.html: 1.9 MB, with a scene of 0.8 MB
std::string viewed_line(const std::string& html, const ViewReport& report);

/// gltf-radiosity: relit.glb: 6789 vertices, 12 ms, exposure 1 m2/cd
std::string relit_line(const std::string& output, const RelightReport& report, double seconds);

/// relative RMSE 1.93 % (noise 0.40 % taken out), median ...
/// exposure 0.998 m2/cd ...
/// 1987 of 2000 points ...
///
/// Lines for stdout: they are the result.
std::string verified_lines(const VerifyReport& report);

/// gltf-radiosity: error: the relative RMSE of 5.10 % is above --max-error 2 %
std::string too_inexact_line(const VerifyReport& report, double max_error);

}  // namespace gltf_radiosity::tools
