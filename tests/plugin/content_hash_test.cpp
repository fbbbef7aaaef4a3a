#include "plugin/content_hash.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace gltf_radiosity {
namespace {

template <typename... Values>
std::string hash_of(const Values&... values) {
  ContentHash hash;
  (hash.add(values), ...);
  return hash.digits();
}

using Numbers = std::vector<std::uint32_t>;

TEST(ContentHash, IsTheSameForTheSameContent) {
  EXPECT_EQ(hash_of(Numbers{1, 2, 3}), hash_of(Numbers{1, 2, 3}));
  EXPECT_EQ(hash_of(Numbers{1, 2, 3}).size(), 32U);
}

TEST(ContentHash, IsAnotherForOtherContent) {
  EXPECT_NE(hash_of(Numbers{1, 2, 3}), hash_of(Numbers{1, 2, 4}));
  EXPECT_NE(hash_of(Numbers{}), hash_of(Numbers{0}));
}

TEST(ContentHash, KnowsWhereArraysEnd) {
  EXPECT_NE(hash_of(Numbers{1, 2}, Numbers{3}), hash_of(Numbers{1}, Numbers{2, 3}));
  EXPECT_NE(hash_of(std::string_view("ab"), std::string_view("c")),
            hash_of(std::string_view("a"), std::string_view("bc")));
}

TEST(ContentHash, TellsNothingFromZero) {
  ContentHash none, zero;
  none.add_value(std::optional<int>());
  zero.add_value(std::optional<int>(0));
  EXPECT_NE(none.digits(), zero.digits());
}

}  // namespace
}  // namespace gltf_radiosity
