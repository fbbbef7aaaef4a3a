// A scene with everything that light transport asks for: rays, patches, item buffers, hemicube, rows.
#pragma once

#include <memory>
#include <utility>

#include "core/mesh/patches.h"
#include "core/transport/direct_light.h"
#include "core/transport/form_factors.h"
#include "core/visibility/hemicube.h"
#include "core/visibility/item_buffer_rays.h"
#include "core/visibility/ray_scene.h"

namespace radiosity::test {

/// Members refer to each other: stays where it was made.
struct PreparedScene {
  explicit PreparedScene(Scene scene_to_prepare, int max_patches = 300, int hemicube_resolution = 16)
      : scene(std::move(scene_to_prepare)),
        rays(scene),
        patches(make_patches(rays, {.max_patches = max_patches}, {})),
        items(make_item_buffer_rays(rays)),
        hemicube(hemicube_resolution),
        sky(scene.sky, hemicube_resolution),
        rows(make_hemicube_rows(patches, hemicube, *items, sky, surface_offset(scene))),
        direct(rays, patches, {}) {}

  Scene scene;
  RayScene rays;
  Patches patches;
  std::unique_ptr<ItemBufferMaker> items;
  Hemicube hemicube;
  SmoothSky sky;
  std::unique_ptr<RowSource> rows;
  DirectLight direct;
};

}  // namespace radiosity::test
