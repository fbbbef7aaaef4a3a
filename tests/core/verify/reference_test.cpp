#include "core/verify/reference.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/parallel.h"
#include "core/photometry.h"
#include "core/verify/places.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

std::vector<ReferencePlace> places_on(const Scene& scene, int count) {
  std::vector<ReferencePlace> places;
  for (const SurfacePlace& place :
       random_places(scene, std::vector<std::uint8_t>(scene.triangles.size(), 1), count, 9)) {
    places.push_back({point_at(scene, place.triangle, place.at), shading_normal(scene, place),
                      mean_reflectance(scene, place.triangle, {}), mean_emission(scene, place.triangle, {})});
  }
  return places;
}

TEST(Reference, AWhiteFurnaceShowsTheSameEverywhere) {
  const Scene scene = test::white_furnace(0.5F, 0.25F);
  const RayScene rays(scene);
  const Reference reference =
      trace_reference(PathTracer(rays), places_on(scene, 40), {.noise = 0.01, .max_samples = 1024}, {});
  double mean = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(reference.buried[i], 0);
    EXPECT_NEAR(reference.luminance[i].y, 0.5F, 0.06F);
    mean += static_cast<double>(luminance_of(reference.luminance[i])) / 40.0;
  }
  EXPECT_NEAR(mean, 0.5, 0.01);
}

TEST(Reference, StopsAtTheNoiseThatIsWanted) {
  const Scene scene = test::cornell_box();
  const RayScene rays(scene);
  const PathTracer tracer(rays);
  const std::vector<ReferencePlace> places = places_on(scene, 40);
  const Reference coarse = trace_reference(tracer, places, {.noise = 0.06, .max_samples = 1 << 20}, {});
  EXPECT_LE(coarse.noise, 0.06);
  EXPECT_LT(coarse.sample_count, 40U * 4096U);
  const Reference limited = trace_reference(tracer, places, {.noise = 1e-6, .max_samples = 100}, {});
  EXPECT_EQ(limited.sample_count, 40U * 100U);
}

TEST(Reference, WhatLiesInsideSomethingIsBuried) {
  // Under the floor of a room, looking up: nothing but its backs.
  const Scene scene = test::white_furnace(0.5F, 1.0F);
  const RayScene rays(scene);
  const std::vector<ReferencePlace> places = {{{0.5F, -0.5F, 0.5F}, {0.0F, 1.0F, 0.0F}, Rgb(0.5F), Rgb(0.0F)},
                                              {{0.5F, 0.0F, 0.5F}, {0.0F, 1.0F, 0.0F}, Rgb(0.5F), Rgb(0.0F)}};
  const Reference reference = trace_reference(PathTracer(rays), places, {.noise = 0.1, .max_samples = 64}, {});
  EXPECT_EQ(reference.buried[0], 1);
  EXPECT_EQ(reference.buried[1], 0);
}

TEST(Reference, OneThreadGivesTheSameBytesAsMany) {
  const Scene scene = test::cornell_box();
  const RayScene rays(scene);
  const PathTracer tracer(rays);
  const std::vector<ReferencePlace> places = places_on(scene, 100);
  const auto trace = [&] { return trace_reference(tracer, places, {.noise = 0.05, .max_samples = 200}, {}); };
  const Reference one = on_threads(1, trace), many = on_threads(4, trace);
  EXPECT_EQ(one.luminance, many.luminance);
  EXPECT_EQ(one.variance, many.variance);
  EXPECT_EQ(one.noise, many.noise);
}

TEST(Reference, CanBeCancelled) {
  const Scene scene = test::cornell_box();
  const RayScene rays(scene);
  Progress progress;
  progress.cancelled = [] { return true; };
  EXPECT_THROW(trace_reference(PathTracer(rays), places_on(scene, 10), {}, progress), Cancelled);
}

}  // namespace
}  // namespace radiosity
