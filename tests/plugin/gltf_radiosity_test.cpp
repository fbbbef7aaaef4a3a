#include "plugin/gltf_radiosity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <stdexcept>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

/// A closed white-furnace room, or with its ceiling gone an open box; one mesh.
GltfBuilder room(double rho, double luminance, bool closed = true) {
  // Corners of the unit cube and its faces, seen from inside.
  const glm::vec3 corners[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const int faces[6][4] = {{0, 1, 2, 3}, {5, 4, 7, 6}, {4, 0, 3, 7}, {1, 5, 6, 2}, {4, 5, 1, 0}, {3, 2, 6, 7}};
  PrimitiveParts parts;
  for (int face = 0; face < (closed ? 6 : 5); ++face) {
    const auto base = static_cast<std::uint32_t>(parts.positions.size());
    for (const int corner : faces[face]) parts.positions.push_back(corners[corner]);
    for (const std::uint32_t index : {0U, 1U, 2U, 0U, 2U, 3U}) parts.indices.push_back(base + index);
  }
  GltfBuilder builder;
  parts.material = builder.add_material({{"pbrMetallicRoughness", {{"baseColorFactor", {rho, rho, rho, 1.0}}}},
                                         {"emissiveFactor", {luminance, luminance, luminance}}});
  builder.add_node(builder.add_mesh(parts), {{"name", "room"}});
  return builder;
}

Options coarse() {
  Options options;
  options.patch_size = 0.5;
  options.hemicube = 16;
  options.max_patches = 300;
  options.exposure = 0.5;
  return options;
}

std::span<const std::byte> as_input(const Bytes& bytes) { return std::as_bytes(std::span(bytes)); }

Document document_of(const BakedGlb& baked) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(baked.glb.data());
  Result<Document> document = read_document(std::span(data, baked.glb.size()), {});
  EXPECT_TRUE(document) << document.error().text();
  return document ? std::move(*document) : Document();
}

std::vector<float> colors_of(const Document& document) {
  const Json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  return as_floats(read_accessor(document, attributes["COLOR_0"].get<std::size_t>()));
}

TEST(GltfRadiosity, AWhiteFurnaceGlowsEvenly) {
  const Bytes input = room(0.5, 0.5).glb();
  const Result<BakedGlb> baked = bake_memory(as_input(input), coarse());
  ASSERT_TRUE(baked) << baked.error().text();
  const std::vector<float> colors = colors_of(document_of(*baked));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    EXPECT_NEAR(colors[i], i % 4 == 3 ? 1.0F : 0.5F, 0.0025F) << i;  // k Le / (1 - rho)
  }
}

TEST(GltfRadiosity, AnEvenlyLitRoomNeedsItsCornersOnly) {
  const Bytes input = room(0.5, 0.5).glb();
  Options options = coarse();
  options.refine = Refine::kUniform;
  const Result<BakedGlb> whole = bake_memory(as_input(input), options);
  options.simplify = true;
  const Result<BakedGlb> simplified = bake_memory(as_input(input), options);
  ASSERT_TRUE(whole && simplified);
  EXPECT_EQ(whole->report.removed_vertices, 0U);
  EXPECT_GT(whole->report.output_vertices, 24U);
  EXPECT_EQ(simplified->report.output_vertices, 24U);
  EXPECT_EQ(simplified->report.output_triangles, 12U);
  EXPECT_EQ(simplified->report.removed_vertices, whole->report.output_vertices - 24U);
  EXPECT_GE(simplified->report.estimated_error, whole->report.estimated_error);
  EXPECT_LT(simplified->report.estimated_error, whole->report.estimated_error + options.max_error);
}

TEST(GltfRadiosity, TheReportAddsUp) {
  const Bytes input = room(0.5, 0.5).glb();
  const Result<BakedGlb> baked = bake_memory(as_input(input), coarse());
  ASSERT_TRUE(baked) << baked.error().text();
  const Report& report = baked->report;
  EXPECT_EQ(report.input_triangles, 12U);
  EXPECT_EQ(report.emissive_triangles, 12U);
  EXPECT_EQ(report.lights, 0U);
  EXPECT_EQ(report.patch_size, 0.5);
  EXPECT_EQ(report.exposure, 0.5);
  EXPECT_GT(report.patches, 0U);
  const Document document = document_of(*baked);
  const Json& primitive = document.json["meshes"][0]["primitives"][0];
  EXPECT_EQ(report.output_vertices * 4, colors_of(document).size());
  EXPECT_EQ(report.output_triangles * 3, document.json["accessors"][primitive["indices"].get<std::size_t>()]["count"]);
  std::set<std::string> names;
  for (const PhaseReport& phase : report.phases) {
    EXPECT_TRUE(names.insert(phase.name).second) << phase.name << " twice";
    EXPECT_GE(phase.seconds, 0.0);
    EXPECT_GT(phase.peak_memory_bytes, 1000000U);
  }
  for (const char* phase : {"read", "import", "subdivide", "solve", "gather", "fit", "export", "write"}) {
    EXPECT_TRUE(names.contains(phase)) << phase;
  }
}

TEST(GltfRadiosity, TheReportIsJson) {
  Report report;
  report.input_triangles = 7;
  report.visibility = "rays";
  report.phases = {{"read", 0.25, 1024}};
  report.warnings = {{"default-sky", "nodes[3]", "a \"quoted\" sentence"}};
  const Json json = Json::parse(to_json(report));
  EXPECT_EQ(json["inputTriangles"], 7);
  EXPECT_EQ(json["phases"][0]["peakMemoryBytes"], 1024);
  EXPECT_EQ(json["warnings"][0]["message"], "a \"quoted\" sentence");
}

TEST(GltfRadiosity, FileAndMemoryGiveTheSameBytes) {
  const TemporaryFolder folder;
  const Bytes input = room(0.5, 0.5, false).glb();
  write_text(folder / "in.glb", std::string(input.begin(), input.end()));
  const Result<Report> report = bake_file(folder / "in.glb", folder / "out.glb", coarse());
  ASSERT_TRUE(report) << report.error().text();
  const Result<BakedGlb> baked = bake_memory(as_input(input), coarse());
  ASSERT_TRUE(baked);
  const std::string file = read_text(folder / "out.glb");
  ASSERT_EQ(file.size(), baked->glb.size());
  EXPECT_EQ(std::memcmp(file.data(), baked->glb.data(), file.size()), 0);
}

TEST(GltfRadiosity, ThreadsDoNotChangeTheBytes) {
  const Bytes input = room(0.5, 0.5, false).glb();
  Options options = coarse();
  options.threads = 1;
  const Result<BakedGlb> one = bake_memory(as_input(input), options);
  options.threads = 4;
  const Result<BakedGlb> four = bake_memory(as_input(input), options);
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->glb, four->glb);
}

TEST(GltfRadiosity, EveryKindOfOutputHoldsTheSameColours) {
  const TemporaryFolder folder;
  const Bytes input = room(0.5, 0.5, false).glb();
  write_text(folder / "in.glb", std::string(input.begin(), input.end()));
  std::vector<float> expected;
  for (const char* name : {"a.glb", "b.gltf", "c.embedded.gltf"}) {
    const Result<Report> report = bake_file(folder / "in.glb", folder / name, coarse());
    ASSERT_TRUE(report) << report.error().text();
    const Result<Document> document = read_document(folder / name);
    ASSERT_TRUE(document) << document.error().text();
    const std::vector<float> colors = colors_of(*document);
    if (expected.empty()) expected = colors;
    EXPECT_EQ(colors, expected) << name;
  }
}

TEST(GltfRadiosity, UnrefinedMeshesKeepTheirTriangles) {
  const Bytes input = room(0.5, 0.5).glb();
  Options options = coarse();
  options.refine = Refine::kNone;
  const Result<BakedGlb> baked = bake_memory(as_input(input), options);
  ASSERT_TRUE(baked) << baked.error().text();
  EXPECT_EQ(baked->report.output_triangles, 12U);
  EXPECT_EQ(baked->report.patch_size, 0.0);
}

TEST(GltfRadiosity, ASceneWithoutLightSaysSo) {
  const Bytes input = room(0.5, 0.0, false).glb();
  const auto codes = [&](const Options& options) {
    const Result<BakedGlb> baked = bake_memory(as_input(input), options);
    std::vector<std::string> result;
    if (!baked) return result;
    for (const Warning& warning : baked->report.warnings) result.push_back(warning.code);
    return result;
  };
  EXPECT_THAT(codes(coarse()), testing::Contains("default-sky"));
  Options dark = coarse();
  dark.default_sky = false;
  EXPECT_THAT(codes(dark), testing::Contains("no-light"));
}

// Failures.

TEST(GltfRadiosity, TheCallerCanStop) {
  const TemporaryFolder folder;
  const Bytes input = room(0.5, 0.5).glb();
  write_text(folder / "in.glb", std::string(input.begin(), input.end()));
  for (const char* when : {"read", "import", "solve", "gather", "export", "write"}) {
    bool stop = false;
    Callbacks callbacks;
    callbacks.progress = [&](std::string_view phase, double) { stop = stop || phase == when; };
    callbacks.cancelled = [&] { return stop; };
    const Result<Report> report = bake_file(folder / "in.glb", folder / "out.glb", coarse(), callbacks);
    ASSERT_FALSE(report) << when;
    EXPECT_EQ(report.error().code, ErrorCode::kCancelled) << when;
    EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("in.glb")) << when;
  }
}

TEST(GltfRadiosity, NothingIsThrownAtTheCaller) {
  const Bytes input = room(0.5, 0.5).glb();
  const auto code_after = [&](const std::function<void()>& thrower) {
    Callbacks callbacks;
    callbacks.progress = [&](std::string_view phase, double) {
      if (phase == "export") thrower();
    };
    const Result<BakedGlb> baked = bake_memory(as_input(input), coarse(), callbacks);
    return baked ? std::optional<ErrorCode>() : baked.error().code;
  };
  EXPECT_EQ(code_after([] { throw std::bad_alloc(); }), ErrorCode::kLimit);
  EXPECT_EQ(code_after([] { throw std::runtime_error("broken"); }), ErrorCode::kInternal);
  EXPECT_EQ(code_after([] { throw 5; }), ErrorCode::kInternal);
}

TEST(GltfRadiosity, OptionsAreCheckedFirst) {
  Options options;
  options.hemicube = 3;
  const Result<Report> report = bake_file("missing.glb", "missing/out.glb", options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadOption);
  EXPECT_EQ(report.error().place, "--hemicube");
}

TEST(GltfRadiosity, TheOutputIsCheckedBeforeTheWork) {
  const TemporaryFolder folder;
  const Result<Report> report = bake_file("missing.glb", folder / "missing/out.glb", {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kCannotWrite);
}

TEST(GltfRadiosity, BrokenInputWritesNothing) {
  const TemporaryFolder folder;
  write_text(folder / "in.glb", "not a glTF");
  const Result<Report> report = bake_file(folder / "in.glb", folder / "out.glb", {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("in.glb"));
}

TEST(GltfRadiosity, AMissingInputIsNamed) {
  const TemporaryFolder folder;
  const Result<Report> report = bake_file(folder / "in.glb", folder / "out.glb", {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(report.error().place, testing::HasSubstr("in.glb"));
}

TEST(GltfRadiosity, EmptyMemoryIsBadInput) {
  const Result<BakedGlb> baked = bake_memory({}, {});
  ASSERT_FALSE(baked);
  EXPECT_EQ(baked.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace gltf_radiosity
