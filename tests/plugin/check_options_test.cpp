#include "plugin/check_options.h"

#include <gtest/gtest.h>

#include <limits>

namespace gltf_radiosity {
namespace {

/// The option that is refused, or "".
template <typename Change>
std::string refused(const Change& change) {
  Options options;
  change(options);
  const Result<Done> checked = check_options(options);
  if (checked) return "";
  EXPECT_EQ(checked.error().code, ErrorCode::kBadOption);
  return checked.error().place;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(CheckOptions, DefaultsAreFine) {
  EXPECT_EQ(refused([](Options&) {}), "");
}

TEST(CheckOptions, HemicubesAreEven) {
  for (const int cells : {0, 1, 3, -2, 514}) {
    EXPECT_EQ(refused([&](Options& o) { o.hemicube = cells; }), "--hemicube") << cells;
  }
  for (const int cells : {2, 512}) EXPECT_EQ(refused([&](Options& o) { o.hemicube = cells; }), "") << cells;
}

TEST(CheckOptions, TheMeshHasASize) {
  EXPECT_EQ(refused([](Options& o) { o.patch_size = -1.0; }), "--patch-size");
  EXPECT_EQ(refused([](Options& o) { o.patch_size = kInfinity; }), "--patch-size");
  EXPECT_EQ(refused([](Options& o) { o.subdivide = {{"floor", 9}}; }), "--subdivide");
  EXPECT_EQ(refused([](Options& o) { o.subdivide = {{"floor", 8}, {"wall", 0}}; }), "");
}

TEST(CheckOptions, CompressionIsOneOfTwo) {
  for (const int bits : {7, 25, -1}) EXPECT_EQ(refused([&](Options& o) { o.draco_bits = bits; }), "--draco") << bits;
  for (const int bits : {0, 8, 24}) EXPECT_EQ(refused([&](Options& o) { o.draco_bits = bits; }), "") << bits;
  EXPECT_EQ(refused([](Options& o) { o.draco_bits = 16, o.meshopt = true; }), "--meshopt");
}

TEST(CheckOptions, CustomAttributesHavePlainNames) {
  EXPECT_EQ(refused([](Options& o) { o.radiance_attribute = "_LIGHT_2"; }), "");
  for (const char* name : {"a b", "COLOR-0", "\"", "ä"}) {
    EXPECT_EQ(refused([&](Options& o) { o.radiance_attribute = name; }), "--radiance-attribute") << name;
  }
}

TEST(CheckOptions, LightIsNotNegative) {
  EXPECT_EQ(refused([](Options& o) { o.sky = {1.0, -0.5, 1.0}; }), "--sky");
  EXPECT_EQ(refused([](Options& o) { o.sky_file = "sky.hdr"; }), "");
  EXPECT_EQ(refused([](Options& o) { o.sky = {1.0, 1.0, 1.0}, o.sky_file = "sky.hdr"; }), "--sky");
  EXPECT_EQ(refused([](Options& o) { o.sky_rotation_degrees = kInfinity; }), "--sky-rotation");
  EXPECT_EQ(refused([](Options& o) { o.sun = Sun{91.0, 0.0, 1.0}; }), "--sun");
  EXPECT_EQ(refused([](Options& o) { o.sun = Sun{45.0, 0.0, -1.0}; }), "--sun");
  EXPECT_EQ(refused([](Options& o) { o.sun = Sun{45.0, 720.0, 1.0}; }), "");
}

TEST(CheckOptions, TheSolverComesToAnEnd) {
  for (const double residual : {0.0, 1.0, -0.1, kInfinity}) {
    EXPECT_EQ(refused([&](Options& o) { o.residual = residual; }), "--residual") << residual;
  }
  EXPECT_EQ(refused([](Options& o) { o.max_patches = -1; }), "--max-patches");
  EXPECT_EQ(refused([](Options& o) { o.threads = -1; }), "--threads");
}

TEST(CheckOptions, MemoryIsEnoughToStart) {
  Options options;
  options.max_memory = (std::uint64_t{64} << 20U) - 1;
  EXPECT_FALSE(check_options(options));
  options.max_memory = std::uint64_t{64} << 20U;
  EXPECT_TRUE(check_options(options));
}

TEST(CheckOptions, ExposureIsPositive) {
  for (const double k : {0.0, -1.0, kInfinity}) {
    EXPECT_EQ(refused([&](Options& o) { o.exposure = k; }), "--exposure") << k;
  }
}

}  // namespace
}  // namespace gltf_radiosity
