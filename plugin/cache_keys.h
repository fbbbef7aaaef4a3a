// What results in the cache follow from, as hashes: all that matters, and nothing else. No names of files, no number of
// threads, no style of the output.
#pragma once

#include <string>

#include "core/bake.h"
#include "core/transport/row_keeper.h"
#include "plugin/document.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// Of a finished bake: the document, the options that it is imported and baked with, and this program's version. Not
/// the limit on elements, which follows from memory: cached_bake.cpp looks whether it mattered.
Result<std::string> bake_key(const Document& document, const Options& options,
                             const radiosity::BakeOptions& bake_options);

/// Of rows of form factors: shapes, patches and hemicubes, and what lets light through; not the light itself, nor what
/// reflects it. `scene` is that of `inputs`.
std::string rows_key(const Document& document, const ImportedScene& scene, const radiosity::RowInputs& inputs);

}  // namespace gltf_radiosity
