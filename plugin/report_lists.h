// What every report for programs ends with.
#pragma once

#include <span>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Adds `phases` and `warnings` to a report.
void add_lists(std::span<const PhaseReport> phases, std::span<const Warning> warnings, Json& report);

}  // namespace gltf_radiosity
