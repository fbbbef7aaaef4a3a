// KHR_lights_punctual and --sun -> core lights.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "core/scene.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// The factor that turns the file's point, spot and directional intensities into candela and lux: 1, or 1/683 for files
/// of Blender's exporter (it multiplies watts by 683 but leaves emission as it is). kAuto looks at asset.generator and
/// adds a warning that says what was assumed, if the file has such lights.
float light_unit_factor(const Document& document, LightUnits units, std::vector<Warning>& warnings);

/// A light of KHR_lights_punctual, placed by its node's world transform: it stands at the origin and shines along -z.
/// Scale changes neither intensity nor range. Intensities times `unit_factor`.
radiosity::Light import_light(const Json& light, const glm::dmat4& world_from_node, float unit_factor);

/// The colour of a light, white unless it says otherwise; not negative.
radiosity::Rgb color_of_light(const Json& light);
/// Colour times intensity, in units of the file.
radiosity::Rgb strength_of_light(const Json& light);

/// REQUIRES: finite numbers.
radiosity::Light import_sun(const Sun& sun);

}  // namespace gltf_radiosity
