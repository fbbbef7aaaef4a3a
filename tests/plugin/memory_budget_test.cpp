#include "plugin/memory_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugin/document.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint64_t kMany = std::numeric_limits<std::uint64_t>::max();

TEST(MemoryBudget, WhatIsReservedIsGone) {
  MemoryBudget memory(1000);
  EXPECT_TRUE(memory.reserve(10, 60, "", "things"));
  EXPECT_EQ(memory.left(), 400U);
  EXPECT_TRUE(memory.check(4, 100, "", "things"));
  EXPECT_EQ(memory.left(), 400U);
  EXPECT_FALSE(memory.reserve(5, 100, "", "things"));
  EXPECT_EQ(memory.left(), 400U);
  EXPECT_TRUE(memory.reserve(4, 100, "", "things"));
  EXPECT_EQ(memory.left(), 0U);
  EXPECT_TRUE(memory.reserve(0, 100, "", "things"));
}

TEST(MemoryBudget, TheErrorNamesThePlaceAndTheLimit) {
  const MemoryBudget memory(std::uint64_t{1} << 30U);
  const Result<Done> fits = memory.check(4'000'000'000, 12, "accessors[3]", "elements");
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().code, ErrorCode::kLimit);
  EXPECT_EQ(fits.error().text(),
            "accessors[3]: 4000000000 elements need about 44.7 GiB, and of --max-memory, 1 GiB, 1 GiB are left");
}

TEST(MemoryBudget, ProductsDoNotOverflow) {
  MemoryBudget memory(1000);
  EXPECT_FALSE(memory.reserve(kMany, kMany, "", ""));
  EXPECT_FALSE(memory.reserve(kMany / 8 + 2, 8, "", ""));
  EXPECT_TRUE(MemoryBudget().reserve(kMany, 1, "", ""));
}

TEST(MemoryBudget, TheDefaultIsThreeQuartersOfWhatControlGroupsAllow) {
  const TemporaryFolder root;
  EXPECT_GT(allowed_memory(root.path()), 0U) << "without control groups";
  const std::uint64_t physical = allowed_memory(root.path());

  // Version 2: the lowest of the group and those above.
  write_text(root / "proc/self/cgroup", "0::/batch/job\n");
  write_text(root / "sys/fs/cgroup/batch/job/memory.max", "max\n");
  EXPECT_EQ(allowed_memory(root.path()), physical);
  write_text(root / "sys/fs/cgroup/batch/memory.max", "4000000\n");
  EXPECT_EQ(allowed_memory(root.path()), 3'000'000U);
  write_text(root / "sys/fs/cgroup/batch/job/memory.max", "400000\n");
  EXPECT_EQ(allowed_memory(root.path()), 300'000U);

  // A container sees its own group as the root.
  write_text(root / "sys/fs/cgroup/memory.max", "40000\n");
  EXPECT_EQ(allowed_memory(root.path()), 30'000U);

  // Version 1.
  write_text(root / "proc/self/cgroup", "5:cpu:/other\n4:memory:/job\n");
  write_text(root / "sys/fs/cgroup/memory/job/memory.limit_in_bytes", "8000\n");
  EXPECT_EQ(allowed_memory(root.path()), 6'000U);
}

// What a file claims, before anything is done for it.

std::string budget_refusal(const GltfBuilder& builder, std::uint64_t max_memory = std::uint64_t{1} << 30U) {
  ReadOptions options;
  options.max_memory = max_memory;
  const Result<Document> document = read_document(builder.glb(), {}, options);
  if (!document) return document.error().text();
  std::vector<Warning> warnings;
  const Result<ImportedScene> scene = import_scene(*document, {}, warnings);
  if (scene) return "fine";
  EXPECT_EQ(scene.error().code, ErrorCode::kLimit);
  return scene.error().text();
}

/// A square whose accessors hold `count` zeros.
GltfBuilder empty_square(std::uint64_t count) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  for (Json& accessor : builder.json["accessors"]) {
    if (accessor["type"] == "SCALAR") continue;
    accessor.erase("bufferView");
    accessor["count"] = count;
  }
  return builder;
}

TEST(MemoryBudget, FourBillionVerticesWithoutDataAreRefused) {
  EXPECT_THAT(budget_refusal(empty_square(4'000'000'000)), StartsWith("accessors[0]: 4000000000 elements need about"));
  EXPECT_THAT(budget_refusal(empty_square(5'000'000'000)), HasSubstr("has 5000000000 elements but no bufferView"));
}

TEST(MemoryBudget, AMeshTimesItsNodesIsCountedBeforeItIsRead) {
  GltfBuilder builder = empty_square(1'000'000);
  for (int i = 1; i < 1000; ++i) builder.add_node(0);
  EXPECT_THAT(budget_refusal(builder), StartsWith("meshes[0].primitives[0] of nodes["));
}

TEST(MemoryBudget, InstancesAreCountedBeforeTheyAreMade) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  const std::size_t index = builder.add_buffer_view(std::vector<std::uint8_t>{0});
  const std::size_t value = builder.add_buffer_view(std::vector<std::uint8_t>(12, 0));
  Json copies = {{"componentType", 5126}, {"count", 10'000'000}, {"type", "VEC3"}};
  copies["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", index}, {"componentType", 5121}}}, {"values", {{"bufferView", value}}}};
  builder.json["accessors"].push_back(copies);
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      builder.json["accessors"].size() - 1;
  EXPECT_THAT(budget_refusal(builder), StartsWith("nodes[0]: 10000000 instances need about"));
}

TEST(MemoryBudget, JsonIsCountedBeforeItIsParsed) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  builder.json["asset"]["extras"] = std::vector<int>(1'000'000, 0);
  EXPECT_THAT(budget_refusal(builder, std::uint64_t{64} << 20U), StartsWith("JSON: "));
  EXPECT_EQ(budget_refusal(builder), "fine");
}

}  // namespace
}  // namespace gltf_radiosity
