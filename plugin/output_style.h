// How the light is written: what is asked for, and where nothing is, what the engine needs.
#pragma once

#include <optional>

#include "plugin/gltf_radiosity.h"

namespace gltf_radiosity {

/// What the presets of --engine choose among.
struct OutputStyle {
  ColorType color_type = ColorType::kFloat;
  bool scale_to_factor = false;
};

/// "float", "u16" or "u8".
const char* name_of(ColorType type);
/// "both", "direct" or "indirect".
const char* name_of(BakedLight light);
/// "none", "morph", "attributes" or "files".
const char* name_of(LightGroupStorage storage);

/// Options given explicitly win over the engine's.
OutputStyle output_style(const Options& options);

/// A warning if the engine cannot read the compression that is asked for.
std::optional<Warning> unreadable_compression(const Options& options);

}  // namespace gltf_radiosity
