// radiosity::bake(), unless the cache knows the result already.
#pragma once

#include <vector>

#include "core/bake.h"
#include "plugin/document.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// What the cache spared.
enum class Spared { kNoCache, kNothing, kFormFactors, kBake };

/// As Report::cache has it.
const char* name_of(Spared spared);

struct CachedBake {
  radiosity::Bake bake;
  Spared spared = Spared::kNoCache;
};

/// The same bake as without Options::cache. Its folder is looked up for the finished bake of the same content and
/// options, then for form factors of the same shapes; what was not there is put there as it is finished. ErrorCode::
/// kCannotWrite if the folder cannot be used.
Result<CachedBake> bake_through_cache(const Document& document, const ImportedScene& scene, const Options& options,
                                      radiosity::BakeOptions bake_options, std::vector<Warning>& warnings,
                                      const radiosity::Progress& progress);

}  // namespace gltf_radiosity
