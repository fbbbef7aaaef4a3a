// A page to look at a bake with: one HTML file that needs neither a network nor anything beside it.
//
// It holds the baked file as it is, three.js and the decoders that the file needs, and shows it as engines do; lights
// can be dimmed and dyed, exposure changed, illuminance read in lux. Nothing here throws; nothing prints.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gltf_radiosity.h"  // by its short name: installed, the two lie side by side
#include "result.h"

namespace gltf_radiosity {

struct ViewOptions {
  std::string title;  ///< of the page; empty: the baked file's name
};

struct ViewReport {
  std::uint64_t scene_bytes = 0;  ///< of the baked file, with all it refers to, in the page
  std::uint64_t page_bytes = 0;
  std::vector<Warning> warnings;
};

/// The largest scene that goes into a page, bytes: browsers do not open larger pages.
inline constexpr std::uint64_t kMaxViewedBytes = std::uint64_t{1} << 30U;

/// Writes the page `html` with the baked file `baked` (.glb or .gltf, images and all) in it. The page appears whole or
/// not at all. ErrorCode::kBadInput if nothing in `baked` has a COLOR_0, or if it needs textures that the page cannot
/// decode; kLimit if it is too large; kBadOption if `html` is the baked file itself, or if the library was built
/// without the page.
Result<ViewReport> view_file(const std::string& baked, const std::string& html, const ViewOptions& options = {},
                             const Callbacks& callbacks = {});

}  // namespace gltf_radiosity
