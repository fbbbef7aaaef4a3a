// Which lamps, lights and skies of a scene are dimmed together.
#pragma once

#include <string>
#include <vector>

#include "plugin/document.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// The most groups that are named in the file or by options, and the most that come about by themselves.
inline constexpr std::size_t kMaxNamedGroups = 64, kMaxGroups = 16;

/// Gives every punctual light, every emissive material, the sun and the sky of `scene` its light group (core/scene.h),
/// and returns the groups' names, at least one, each once. A light or material belongs to the group that the last of
/// options.groups names whose pattern fits the name of the light's node, the light or the material; else to the one
/// that extras.radiosity.group names, of the material, or of the light's node or the nearest node above it that has it;
/// else to one of its own name, node before light. The sky and the sun are called "sky" and "sun". Of those that nobody
/// named what does not find room among kMaxGroups is "other", with a warning. ErrorCode::kBadOption if a pattern fits
/// nothing, or for more than kMaxNamedGroups names.
Result<std::vector<std::string>> group_lights(const Document& document, const Options& options, ImportedScene& scene,
                                              std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
