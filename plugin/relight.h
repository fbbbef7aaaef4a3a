// Other lights for a bake in a moment: from the transport that a bake has saved (Options::save_transport).
//
// Gives the colours that a bake with these lights and reflectances gives on the same mesh. Nothing here throws; nothing
// prints.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gltf_radiosity.h"  // by its short name: installed, the two lie side by side
#include "result.h"

namespace gltf_radiosity {

/// Another strength of a light: what is not given stays.
struct LightChange {
  std::optional<std::array<double, 3>> color;  ///< linear Rec. 709, not negative
  std::optional<double> intensity;             ///< candela or lux as the file has it, not negative
};

/// Another emission of a material, one of both.
struct EmissiveChange {
  std::optional<std::array<double, 3>> luminance;  ///< factor times strength, cd/m2, not negative
  std::optional<double> scale;                     ///< what it is multiplied by, not negative
};

/// Names are those of the file, exactly; what has no name is called `lights[0]` or `materials[3]` by its index. A light
/// is found by the name of a node that it stands at too, and the sun of the bake's options is the light `sun`. All that
/// bear a name are changed.
struct RelightOptions {
  std::vector<std::pair<std::string, LightChange>> lights;
  std::vector<std::pair<std::string, EmissiveChange>> emissive;
  std::vector<std::pair<std::string, std::array<double, 3>>> reflectance;  ///< base colour factor, linear, [0,1]
  std::optional<std::array<double, 3>> sky;  ///< luminance, cd/m2; where the sky is an image, what multiplies it
  std::optional<double> exposure;            ///< k, m2/cd; none: the bake's
  bool auto_exposure = false;                ///< choose it as a bake would
  std::string source;                        ///< a glTF that must still have the geometry of the bake; empty: unchecked
  int threads = 0;                           ///< 0: every core
};

/// What was done.
struct RelightReport {
  std::uint64_t vertices = 0;           ///< that show light
  std::uint64_t changed_sources = 0;    ///< lights, emissive materials and skies
  std::uint64_t changed_materials = 0;  ///< whose reflectance is another
  double exposure = 1.0;                ///< k, m2/cd
  double clipped_share = 0.0;           ///< of the baked area
  std::vector<PhaseReport> phases;      ///< "read", "solve", "gather", "fit", "export", "compress", "write"
  std::vector<Warning> warnings;
};

/// Writes `output`, as bake_file() would, with other light in its colours. Its lights, and its materials where they are
/// not unlit, get the new values too; all else is what the bake wrote. ErrorCode::kBadInput if `transport` is damaged
/// or if options.source has another geometry; kBadOption for names that nothing bears (the message lists those there
/// are) and for reflectances where the transport does not hold what they take.
Result<RelightReport> relight_file(const std::string& transport, const std::string& output,
                                   const RelightOptions& options, const Callbacks& callbacks = {});

/// The report as JSON, indented by two spaces.
std::string to_json(const RelightReport& report);

}  // namespace gltf_radiosity
