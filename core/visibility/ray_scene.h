// The scene as Embree sees it: the only door to Embree.
#pragma once

#include <memory>

#include "core/scene.h"

namespace radiosity {

/// An acceleration structure over the scene's triangles. Immutable once built; any number of threads may trace.
///
/// `scene` must outlive it. Opaque and see-through triangles are kept apart, so that only the latter pay for asking
/// their opacity at each hit.
class RayScene {
 public:
  /// Throws std::bad_alloc if memory runs out. Built by the threads TBB lends; the result does not depend on how many.
  explicit RayScene(const Scene& scene);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  const Scene& scene() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radiosity
