// What the user wants to be otherwise -> strengths of light sources and factors of materials.
#pragma once

#include <cstddef>
#include <vector>

#include "plugin/relight.h"
#include "plugin/transport_file.h"

namespace gltf_radiosity {

/// The new values of all sources and materials, changed or not.
struct ChangedLight {
  std::vector<radiosity::Rgb> strength;  ///< of each source, in units of the file
  std::vector<radiosity::Rgb> factor;    ///< base colour, of each material
  std::vector<std::size_t> sources;      ///< those that were named
  std::vector<std::size_t> materials;    ///< likewise, those with another reflectance
};

/// kBadOption for names that nothing bears, for values that are negative or not finite, and for materials whose
/// reflectance cannot be changed.
Result<ChangedLight> changed_light(const TransportDescription& description, const RelightOptions& options);

/// By what the light of each light group is multiplied.
std::vector<radiosity::Rgb> dimmers_of(const TransportDescription& description, const ChangedLight& changed);

/// Tells the document's lights and lit materials.
void change_document(const TransportDescription& description, const ChangedLight& changed, Json& root);

}  // namespace gltf_radiosity
