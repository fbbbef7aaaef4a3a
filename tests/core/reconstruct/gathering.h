// A scene that is ready to be gathered in: light that its patches send is given.
#pragma once

#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/gather.h"
#include "core/reconstruct/samples.h"
#include "tests/core/prepared_scene.h"

namespace radiosity::test {

/// A scene, what its patches send, and the gatherer over them. Members refer to each other: stays where it was made.
struct Gathering {
  explicit Gathering(const Scene& scene, const Rgb& patch_radiosity = Rgb(0.0F), int resolution = 16)
      : prepared(scene, 200, resolution),
        radiosity(prepared.patches.patch_count(), patch_radiosity),
        gatherer{prepared.scene,  prepared.patches, prepared.hemicube, *prepared.items,
                 prepared.direct, prepared.sky,     radiosity,         surface_offset(prepared.scene)} {}

  Samples samples(const SampleOptions& options) const {
    return gather_samples(unrefined(prepared.scene), gatherer, options, {});
  }
  ElementLight elements() const { return mean_of_samples(samples({})); }

  PreparedScene prepared;
  std::vector<Rgb> radiosity;
  Gatherer gatherer;
};

}  // namespace radiosity::test
