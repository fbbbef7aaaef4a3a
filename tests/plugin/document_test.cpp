#include "plugin/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::span<const std::uint8_t> span_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Result<Document> read(const std::string& text) { return read_document(span_of(text), {}); }

/// "place: message" of the error, or "fine".
std::string verdict(const Result<Document>& result) { return result ? "fine" : result.error().text(); }

GltfBuilder square() {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  return builder;
}

/// What reading says after `change` was made to the tree of a sound file.
std::string verdict_after(const std::function<void(Json&)>& change) {
  GltfBuilder builder = square();
  change(builder.json);
  return verdict(read(builder.embedded()));
}

class DocumentFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::path(testing::TempDir()) / (std::string("document_") + test->name());
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_ / "inside");
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  void write(const std::filesystem::path& name, std::span<const std::uint8_t> bytes) const {
    std::ofstream(root_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  /// Reads inside/scene.gltf, whose buffer is at `uri`.
  Result<Document> read_with_buffer(const std::string& uri) const {
    const GltfBuilder builder = square();
    Json json = builder.document().json;
    json["buffers"][0]["uri"] = uri;
    write("inside/scene.gltf", span_of(json.dump()));
    return read_document(root_ / "inside/scene.gltf");
  }

  std::filesystem::path root_;
};

TEST(Document, ReadsGlbAndEmbeddedAlike) {
  const GltfBuilder builder = square();
  const auto glb = read_document(builder.glb(), {});
  const auto embedded = read(builder.embedded());
  ASSERT_TRUE(glb) << verdict(glb);
  ASSERT_TRUE(embedded) << verdict(embedded);
  EXPECT_EQ(glb->buffers[0], builder.buffer());
  EXPECT_EQ(embedded->buffers[0], builder.buffer());
  EXPECT_EQ(glb->json["meshes"], embedded->json["meshes"]);
}

TEST(Document, EveryTruncationOfAGlbIsRefused) {
  const Bytes glb = square().glb();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    EXPECT_FALSE(read_document(std::span(glb).first(size), {})) << size << " of " << glb.size();
  }
}

TEST(Document, KeepsEverythingItDoesNotUnderstand) {
  GltfBuilder builder = square();
  builder.json["extras"] = {{"big", 9007199254740993}, {"list", {1, nullptr, 2}}, {"empty", Json::object()}};
  const auto document = read_document(builder.glb(), {});
  ASSERT_TRUE(document) << verdict(document);
  EXPECT_EQ(document->json["extras"].dump(), builder.json["extras"].dump());
}

TEST(Document, NumbersMayBeWrittenAsFractions) {
  EXPECT_EQ(verdict_after([](Json& json) { json["accessors"][0]["count"] = 4.0; }), "fine");
  EXPECT_THAT(verdict_after([](Json& json) { json["accessors"][0]["count"] = 3.5; }),
              StartsWith("accessors[0]: \"count\""));
}

TEST(Document, NamesThePlaceOfEveryFault) {
  EXPECT_EQ(verdict_after([](Json& json) { json["asset"]["version"] = "1.0"; }),
            "asset: version \"1.0\" is not supported, glTF 2.0 is");
  EXPECT_EQ(verdict_after([](Json& json) { json["accessors"][0]["count"] = 12; }),
            "accessors[0]: reads 96 bytes beyond bufferViews[0]");
  EXPECT_EQ(verdict_after([](Json& json) { json["accessors"][1]["bufferView"] = 99; }),
            "accessors[1]: \"bufferView\" refers to bufferViews[99], but there are 4");
  EXPECT_EQ(verdict_after([](Json& json) { json["bufferViews"][3]["byteLength"] = 28; }),
            "bufferViews[3]: reaches 4 bytes beyond buffers[0]");
  EXPECT_EQ(verdict_after([](Json& json) { json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 2; }),
            "meshes[0].primitives[0]: POSITION cannot be VEC2 of component type 5126");
  EXPECT_EQ(verdict_after([](Json& json) { json["nodes"][0]["mesh"] = 1; }),
            "nodes[0]: \"mesh\" refers to meshes[1], but there are 1");
  EXPECT_EQ(verdict_after([](Json& json) {
              json["nodes"][0]["matrix"] = {1, 2, 3};
            }),
            "nodes[0]: \"matrix\" is not 16 finite numbers");
  EXPECT_EQ(verdict_after([](Json& json) { json["extensionsRequired"] = {"VENDOR_magic"}; }),
            "extensionsRequired: VENDOR_magic is not supported");
  EXPECT_EQ(verdict_after([](Json& json) { json["meshes"] = 3; }), "\"meshes\" is not an array");
  EXPECT_EQ(verdict_after([](Json& json) {
              json["animations"] = {{{"samplers", {{{"input", 0}, {"output", {0}}}}}}};
            }),
            "animations[0]: \"output\" is not a whole number in range");
  EXPECT_EQ(verdict_after([](Json& json) {
              json["animations"] = {{{"samplers", {{{"input", 99}, {"output", 0}}}}}};
            }),
            "animations[0]: \"input\" refers to accessors[99], but there are 4");
}

TEST(Document, NamesThatAreNoTextAreRefused) {
  for (const char* key : {"nodes", "meshes", "accessors"}) {
    EXPECT_EQ(verdict_after([&](Json& json) { json[key][0]["name"] = 3; }),
              std::string(key) + "[0]: \"name\" is not a string");
  }
  EXPECT_EQ(verdict_after([](Json& json) {
              json["materials"] = {{{"name", Json::object()}}};
            }),
            "materials[0]: \"name\" is not a string");
  EXPECT_EQ(verdict_after([](Json& json) {
              json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", 3}}};
            }),
            "extensions.KHR_lights_punctual.lights[0]: \"name\" is not a string");
}

TEST(Document, SizesAreChecked64BitsWide) {
  for (const Json& huge : {Json(1e300), Json(std::uint64_t{1} << 63), Json(0xffffffffffffffffU), Json(-1)}) {
    EXPECT_NE(verdict_after([&](Json& json) { json["accessors"][0]["count"] = huge; }), "fine") << huge;
    EXPECT_NE(verdict_after([&](Json& json) { json["accessors"][0]["byteOffset"] = huge; }), "fine") << huge;
    EXPECT_NE(verdict_after([&](Json& json) { json["bufferViews"][0]["byteOffset"] = huge; }), "fine") << huge;
    EXPECT_NE(verdict_after([&](Json& json) { json["bufferViews"][0]["byteStride"] = huge; }), "fine") << huge;
    EXPECT_NE(verdict_after([&](Json& json) { json["bufferViews"][0]["byteLength"] = huge; }), "fine") << huge;
  }
}

TEST(Document, ReplacingOrRemovingAnyValueNeverCrashes) {
  // Every value of the tree in turn becomes something else, or nothing: the answer is a document or an error, never a
  // crash.
  GltfBuilder builder = square();
  const std::size_t texture = builder.add_texture(1, 1, {255, 255, 255, 255});
  builder.add_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  builder.add_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}}}});
  builder.json["skins"] = Json::parse(R"([{"joints": [0]}])");
  const Json sound = Json::parse(builder.embedded());
  std::size_t fine = 0, refused = 0;
  const auto try_out = [&](const Json& changed, const std::string& change) {
    const auto document = read(changed.dump());
    ++(document ? fine : refused);
    EXPECT_TRUE(!document || typed_view(*document)) << change;
  };
  const Json flat = sound.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    for (const Json& other :
         {Json(nullptr), Json(-1), Json(1e300), Json("x"), Json::array(), Json::object(), Json(3)}) {
      for (auto at = Json::json_pointer(pointer); !at.empty(); at.pop_back()) {
        Json changed = sound;
        changed[at] = other;
        try_out(changed, at.to_string() + " " + other.dump());
      }
    }
    for (auto at = Json::json_pointer(pointer); !at.empty(); at.pop_back()) {
      Json changed = sound;
      Json& parent = changed[at.parent_pointer()];
      parent.is_array() ? parent.erase(std::stoul(at.back())) : static_cast<void>(parent.erase(at.back()));
      try_out(changed, at.to_string() + " removed");
    }
  }
  EXPECT_GT(fine, 0U);
  EXPECT_GT(refused, fine);
}

TEST(Document, ANodeMayNotBeItsOwnAncestor) {
  EXPECT_EQ(verdict_after([](Json& json) { json["nodes"][0]["children"] = {0}; }), "nodes[0]: is its own ancestor");
  EXPECT_THAT(verdict_after([](Json& json) {
                json["nodes"].push_back({{"children", {2}}});
                json["nodes"].push_back({{"children", {1}}});
              }),
              HasSubstr("is its own ancestor"));
  EXPECT_EQ(verdict_after([](Json& json) {
              json["nodes"].push_back({{"children", {0}}});
              json["nodes"].push_back({{"children", {0}}});
            }),
            "nodes[0]: is a child of nodes[1] and of nodes[2]");
}

TEST(Document, JsonIsRefusedBeyond64Levels) {
  const std::string start = R"({"asset":{"version":"2.0"},"extras":)";
  EXPECT_EQ(verdict(read(start + std::string(50, '[') + std::string(50, ']') + "}")), "fine");
  EXPECT_EQ(verdict(read(start + std::string(100000, '['))), "JSON: is nested deeper than 64 levels");
}

TEST(Document, BrokenJsonSaysWhere) {
  EXPECT_EQ(verdict(read("{{{{invalid json]]]]")), "JSON: is broken at byte 2");
  EXPECT_EQ(verdict(read("[]")), "the JSON is not an object");
  EXPECT_EQ(verdict(read("")), "JSON: is broken at byte 1");
}

TEST(Document, SparseIndicesMustBeInRange) {
  GltfBuilder builder = square();
  const std::size_t indices = builder.add_buffer_view(std::vector<std::uint8_t>{4});
  const std::size_t values = builder.add_buffer_view(std::vector<std::uint8_t>(12, 0));
  builder.json["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                            {"values", {{"bufferView", values}}}};
  EXPECT_EQ(verdict(read(builder.embedded())), "accessors[0]: sparse index 4 is beyond 4 elements");
}

TEST_F(DocumentFiles, BuffersMayLieInTheFolderAndBelow) {
  write("inside/my buffer.bin", square().buffer());
  EXPECT_EQ(verdict(read_with_buffer("my%20buffer.bin")), "fine");
  std::filesystem::create_directories(root_ / "inside/below");
  write("inside/below/x.bin", square().buffer());
  EXPECT_EQ(verdict(read_with_buffer("./below/../below/x.bin")), "fine");
}

TEST_F(DocumentFiles, AFileLongerThanItsByteLengthIsFine) {
  Bytes longer = square().buffer();
  longer.push_back(0);
  write("inside/x.bin", longer);
  EXPECT_EQ(verdict(read_with_buffer("x.bin")), "fine");
  longer.resize(20);
  write("inside/x.bin", longer);
  EXPECT_THAT(verdict(read_with_buffer("x.bin")), StartsWith("buffers[0]: says "));
}

TEST_F(DocumentFiles, BuffersMayNotLieOutside) {
  write("outside.bin", square().buffer());
  for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
                                 std::string("a/../../outside.bin"), (root_ / "outside.bin").string()}) {
    EXPECT_THAT(verdict(read_with_buffer(uri)), HasSubstr("lies outside the glTF's folder")) << uri;
  }
  std::filesystem::create_symlink(root_ / "outside.bin", root_ / "inside/link.bin");
  EXPECT_EQ(verdict(read_with_buffer("link.bin")),
            "buffers[0]: \"link.bin\" lies outside the glTF's folder (--allow-outside)");
  EXPECT_THAT(verdict(read_with_buffer("file:///etc/passwd")), HasSubstr("is not a file beside the glTF"));
}

TEST_F(DocumentFiles, BuffersMayLieOutsideIfTheUserSaysSo) {
  write("outside.bin", square().buffer());
  std::filesystem::create_symlink(root_ / "outside.bin", root_ / "inside/link.bin");
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("link.bin"), (root_ / "outside.bin").string()}) {
    EXPECT_FALSE(read_with_buffer(uri)) << uri;
    EXPECT_EQ(verdict(read_document(root_ / "inside/scene.gltf", {.allow_outside = true})), "fine") << uri;
  }
  EXPECT_FALSE(read_with_buffer("http://localhost/outside.bin"));
  EXPECT_THAT(verdict(read_document(root_ / "inside/scene.gltf", {.allow_outside = true})),
              HasSubstr("is not a file beside the glTF"));
}

TEST_F(DocumentFiles, WhatTheUserWillWriteIsNotRead) {
  write("inside/x.bin", square().buffer());
  ASSERT_TRUE(read_with_buffer("x.bin"));
  std::filesystem::create_hard_link(root_ / "inside/x.bin", root_ / "same.bin");
  for (const char* name : {"inside/x.bin", "inside/scene.gltf", "same.bin"}) {
    const std::string written = root_ / name;
    EXPECT_EQ(verdict(read_document(root_ / "inside/scene.gltf", {.spared_by = {written}})),
              written + ": would replace the input or a file that it refers to");
  }
  EXPECT_EQ(verdict(read_document(root_ / "inside/scene.gltf", {.spared_by = {"", root_ / "inside/out.gltf"}})),
            "fine");
}

TEST_F(DocumentFiles, MissingFilesAreNamed) {
  EXPECT_EQ(verdict(read_with_buffer("gone.bin")), "buffers[0]: the file \"gone.bin\" is missing");
  EXPECT_EQ(verdict(read_with_buffer("")), "buffers[0]: the uri names no file");
  GltfBuilder builder = square();
  builder.json["images"] = Json::array({Json{{"uri", "gone.png"}}});
  EXPECT_EQ(verdict(read_document(span_of(builder.embedded()), root_)), "images[0]: the file \"gone.png\" is missing");
  EXPECT_THAT(verdict(read_document(root_ / "nothing.glb")), HasSubstr("the file does not exist"));
}

TEST(TypedView, AgreesWithTheTree) {
  GltfBuilder builder;
  builder.add_mesh(Json::array({Json{{"attributes", Json::object()}}, builder.primitive(unit_square())}));
  builder.add_node(std::nullopt);
  builder.add_node(0, {{"translation", {1.0, 2.5, 3.0}}, {"extras", {{"deep", nullptr}}}});
  builder.add_material({{"pbrMetallicRoughness", {{"metallicFactor", 0.25}}}});
  const auto document = read_document(builder.glb(), {});
  ASSERT_TRUE(document) << verdict(document);
  const auto model = typed_view(*document);
  ASSERT_TRUE(model) << model.error().text();
  const tinygltf::Model& view = **model;
  ASSERT_EQ(view.nodes.size(), 2U);
  EXPECT_EQ(view.nodes[1].translation, (std::vector<double>{1.0, 2.5, 3.0}));
  ASSERT_EQ(view.meshes[0].primitives.size(), 2U) << "a primitive without attributes keeps its place";
  EXPECT_EQ(view.meshes[0].primitives[1].attributes.at("POSITION"), 0);
  EXPECT_EQ(view.materials[0].pbrMetallicRoughness.metallicFactor, 0.25);
}

}  // namespace
}  // namespace gltf_radiosity
