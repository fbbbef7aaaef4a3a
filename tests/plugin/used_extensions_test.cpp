#include "plugin/used_extensions.h"

#include <gtest/gtest.h>

namespace gltf_radiosity {
namespace {

TEST(UsedExtensions, AreDeclaredOnce) {
  Json root = Json::object();
  declare_extension(root, "A");
  declare_extension(root, "B");
  declare_extension(root, "A");
  EXPECT_EQ(root, Json::parse(R"({"extensionsUsed": ["A", "B"]})"));
}

TEST(UsedExtensions, WhatIsRequiredIsUsedToo) {
  Json root = Json::parse(R"({"extensionsUsed": ["A"]})");
  require_extension(root, "B");
  require_extension(root, "B");
  EXPECT_EQ(root, Json::parse(R"({"extensionsUsed": ["A", "B"], "extensionsRequired": ["B"]})"));
}

TEST(UsedExtensions, EmptyListsGoWithTheirLastName) {
  Json root = Json::parse(R"({"extensionsUsed": ["A", "B"], "extensionsRequired": ["A"]})");
  forget_extension(root, "A");
  EXPECT_EQ(root, Json::parse(R"({"extensionsUsed": ["B"]})"));
  forget_extension(root, "A");
  forget_extension(root, "B");
  EXPECT_EQ(root, Json::object());
}

TEST(UsedExtensions, AreRemovedFromAnObject) {
  Json object = Json::parse(R"({"name": "n", "extensions": {"A": {}, "B": {}}})");
  remove_extension(object, "A");
  EXPECT_EQ(object, Json::parse(R"({"name": "n", "extensions": {"B": {}}})"));
  remove_extension(object, "B");
  remove_extension(object, "B");
  EXPECT_EQ(object, Json::parse(R"({"name": "n"})"));
}

TEST(UsedExtensions, OfAPrimitiveMayNameItsVertices) {
  EXPECT_FALSE(extension_that_names_vertices(Json::object()));
  EXPECT_FALSE(extension_that_names_vertices(Json::parse(R"({"extensions": {"KHR_materials_variants": {}}})")));
  EXPECT_EQ(extension_that_names_vertices(Json::parse(R"({"extensions": {"EXT_mesh_features": {}, "A": {}}})")), "A");
}

}  // namespace
}  // namespace gltf_radiosity
