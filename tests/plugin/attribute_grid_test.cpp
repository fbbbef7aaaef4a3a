#include "plugin/attribute_grid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gltf_radiosity {
namespace {

TEST(AttributeGrid, TheLargestMeshHas2To18Steps) {
  EXPECT_EQ(position_grid(16.0F, 16.0F), 4 - 18);
  EXPECT_EQ(position_grid(20.0F, 20.0F), 5 - 18);
  EXPECT_EQ(position_grid(0.25F, 0.25F), -2 - 18);
}

TEST(AttributeGrid, MeshesOfAlikeSizeShareAGrid) {
  EXPECT_EQ(position_grid(2.0F, 16.0F), position_grid(16.0F, 16.0F));
  EXPECT_EQ(position_grid(1.0F, 16.0F), position_grid(16.0F, 16.0F));
}

TEST(AttributeGrid, SmallMeshesHaveAtLeast2To14Steps) {
  EXPECT_EQ(position_grid(0.01F, 1000.0F), static_cast<int>(std::ceil(std::log2(0.01F))) - 14);
}

TEST(AttributeGrid, MeshesWithoutExtentTakeTheSharedGrid) {
  EXPECT_EQ(position_grid(0.0F, 16.0F), position_grid(16.0F, 16.0F));
  EXPECT_EQ(position_grid(0.0F, 0.0F), -18);
}

TEST(AttributeGrid, CustomAttributesStayBitByBit) {
  EXPECT_FALSE(attribute_grid("_TEMPERATURE", -10));
  EXPECT_FALSE(attribute_grid("JOINTS_0", -10));
  EXPECT_EQ(attribute_grid("POSITION", -10), -10);
  EXPECT_EQ(attribute_grid("TEXCOORD_3", -10), -16);
}

TEST(AttributeGrid, WholeNumbersOf24BitsFit) {
  EXPECT_TRUE(fits_grid(8388607.0F, 0));
  EXPECT_FALSE(fits_grid(8388608.0F, 0));
  EXPECT_TRUE(fits_grid(-127.0F, -16));
  EXPECT_FALSE(fits_grid(128.0F, -16));
}

}  // namespace
}  // namespace gltf_radiosity
