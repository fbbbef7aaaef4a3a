#include "plugin/cache_keys.h"

#include <gtest/gtest.h>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

/// A square, and what its bake is called in the cache.
class BakeKey : public testing::Test {
 protected:
  void SetUp() override { builder_.add_node(builder_.add_mesh(unit_square())); }
  std::string key(const Options& options = {}, const radiosity::BakeOptions& bake_options = {}) {
    const HandBake hand = bake_by_hand(builder_, 0, radiosity::Rgb(1.0F));
    return bake_key(hand.document, options, bake_options).value();
  }
  template <typename Change>
  std::string key_with(const Change& change) {
    Options options;
    radiosity::BakeOptions bake_options;
    change(options, bake_options);
    return key(options, bake_options);
  }

  GltfBuilder builder_;
};

TEST_F(BakeKey, IsTheSameForTheSameContent) { EXPECT_EQ(key(), key()); }

TEST_F(BakeKey, DoesNotDependOnWhatDoesNotMatter) {
  const std::string plain = key();
  EXPECT_EQ(plain, key_with([](Options& o, auto& b) { o.threads = b.threads = 3; }));
  EXPECT_EQ(plain, key_with([](Options& o, auto& b) { o.max_memory = b.row_cache_bytes = 1U << 30U; }));
  EXPECT_EQ(plain, key_with([](Options& o, auto&) { o.color_type = ColorType::kU8; }));
  EXPECT_EQ(plain, key_with([](Options& o, auto&) { o.cache = "elsewhere"; }));
}

TEST_F(BakeKey, DependsOnOptionsThatMatter) {
  const std::string plain = key();
  EXPECT_NE(plain, key_with([](Options& o, auto&) { o.scene = 0; }));
  EXPECT_NE(plain, key_with([](Options& o, auto&) { o.sky = {1.0, 1.0, 1.0}; }));
  EXPECT_NE(plain, key_with([](Options& o, auto&) { o.sun = Sun{}; }));
  EXPECT_NE(plain, key_with([](Options& o, auto&) { o.exclude = {"x"}; }));
  EXPECT_NE(key_with([](Options& o, auto&) { o.select = {"x"}; }),
            key_with([](Options& o, auto&) { o.exclude = {"x"}; }));
  EXPECT_NE(plain, key_with([](Options& o, auto&) { o.subdivide = {{"x", 1}}; }));
  EXPECT_NE(plain, key_with([](Options& o, auto&) { o.metals = Metals::kBlack; }));
  EXPECT_NE(plain, key_with([](Options&, auto& b) { b.adapt.max_error = 0.5; }));
  EXPECT_NE(plain, key_with([](Options&, auto& b) { b.adapt.exposure = 2.0F; }));
  EXPECT_NE(plain, key_with([](Options&, auto& b) { b.hemicube_resolution = 8; }));
  EXPECT_NE(plain, key_with([](Options&, auto& b) { b.parts = radiosity::LightParts::kDirect; }));
}

TEST_F(BakeKey, DependsOnTheFile) {
  const std::string before = key();
  builder_.add_node(builder_.add_mesh(unit_square()));
  EXPECT_NE(key(), before);
}

// A new option may change what is imported or baked, and then it belongs into the key; a new figure makes another
// archive. Decide, then correct the number here.
TEST(CacheKeys, KnowEveryOption) {
  if (sizeof(void*) != 8) GTEST_SKIP() << "sizes are those of 64 bits";
  EXPECT_EQ(sizeof(Options), 520U);
  EXPECT_EQ(sizeof(radiosity::BakeOptions), 136U);
  EXPECT_EQ(sizeof(radiosity::BakeReport), 120U);
}

}  // namespace
}  // namespace gltf_radiosity
