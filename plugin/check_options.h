// Whether the options make sense, before any work is done.
#pragma once

#include "plugin/gltf_radiosity.h"
#include "plugin/verify.h"

namespace gltf_radiosity {

/// The first option whose value is out of range, by the name it has on the command line: `--hemicube`.
Result<Done> check_options(const Options& options);
Result<Done> check_options(const VerifyOptions& options);

}  // namespace gltf_radiosity
