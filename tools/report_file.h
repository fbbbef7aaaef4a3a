// The report for programs (--json), on success and on failure.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "plugin/result.h"

namespace gltf_radiosity::tools {

/// {"error": {"code": "bad-input", "place": "meshes[3]", "message": "..."}}, indented by two spaces.
std::string to_json(const Error& error);

/// `text` in quotation marks. File names may hold any byte, JSON only UTF-8: what is not becomes U+FFFD.
std::string json_string(std::string_view text);

/// Writes `json` and a line break to the file `path`, or to stdout if it is "-". A regular file appears whole or not at
/// all: written beside, then renamed. Answers why it could not be written, or nothing.
std::optional<std::string> write_report(const std::string& path, std::string_view json);

}  // namespace gltf_radiosity::tools
