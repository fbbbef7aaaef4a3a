#include "plugin/compress_geometry.h"

#include "plugin/compress_draco.h"
#include "plugin/compress_meshopt.h"
#include "plugin/drop_unused.h"
#include "plugin/output_style.h"

namespace gltf_radiosity {

void compress_geometry(Document& document, BufferBuilder& added, const Options& options, std::vector<Warning>& warnings,
                       const radiosity::Progress& progress) {
  if (options.draco_bits == 0 && !options.meshopt) return;
  if (const auto warning = unreadable_compression(options)) warnings.push_back(*warning);
  move_into(document, added);
  if (options.meshopt) {
    compress_meshopt(document, added, warnings, progress);
  } else {
    compress_draco(document, added, options.draco_bits, warnings, progress);
  }
  drop_unused_data(document);
}

}  // namespace gltf_radiosity
