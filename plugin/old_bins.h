// What an output no longer needs once a new one has taken its place.
#pragma once

#include <filesystem>

namespace gltf_radiosity {

/// Removes the .bin files that earlier runs wrote for `output`, a .gltf. Only those that are surely ours and surely of
/// no use: beside it, named after it and after what they hold, holding just that, and mentioned by nothing in the
/// folder that has ".gltf" in its name. If that cannot be found out, or somebody writes there just now, they stay.
void remove_old_bins(const std::filesystem::path& output);

}  // namespace gltf_radiosity
