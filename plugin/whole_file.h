// Files beside the output that appear whole or not at all, as reports: what pending_files.h does, for callers.
#pragma once

#include <string>
#include <string_view>

#include "result.h"  // by its short name: installed, the two lie side by side

namespace gltf_radiosity {

/// Writes `text` into `file`, which replaces one that is there; written beside, flushed, renamed. Its folder must
/// exist.
Result<Done> write_whole_file(const std::string& file, std::string_view text);

/// Removes the temporary files of this process beside `output`: for one that ends without destructors.
void remove_temporaries_of(const std::string& output);

}  // namespace gltf_radiosity
