#include "plugin/write_gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::ElementsAre;
using testing::MatchesRegex;
using testing::StartsWith;

constexpr const char* kBinName = "out-[0-9a-f]+\\.bin";
const std::string kPng = "\x89PNG\r\n\x1a\n and so on";

/// A square, one more accessor in `added`, and images of every kind.
struct Sample {
  TemporaryFolder input;
  Document document;
  BufferBuilder added;
  std::size_t accessor = 0;

  explicit Sample(const Json& images = Json::array()) {
    GltfBuilder builder;
    builder.add_node(builder.add_mesh(unit_square()));
    document = builder.document();
    document.folder = input.path();
    accessor = append_accessor(document, added, {ComponentType::kU8, 1, false, 3, {7, 8, 9}}, BufferTarget::kIndices);
    if (!images.empty()) document.json["images"] = images;
  }

  void expect_same_data(const Document& again) const {
    EXPECT_EQ(again.json["accessors"], document.json["accessors"]);
    EXPECT_EQ(read_accessor(again, accessor).bytes, (Bytes{7, 8, 9}));
    for (std::size_t i = 0; i + 1 < document.json["accessors"].size(); ++i) {
      EXPECT_EQ(read_accessor(again, i).bytes, read_accessor(document, i).bytes) << "accessor " << i;
    }
  }
};

Json image_file(const std::string& uri) { return Json::array({Json{{"uri", uri}, {"name", "wood"}}}); }

Document read(const std::filesystem::path& file) {
  Result<Document> document = read_document(file);
  EXPECT_TRUE(document) << document.error().text();
  return document ? std::move(*document) : Document();
}

TEST(WriteGltf, TheNameSaysWhatIsWritten) {
  EXPECT_EQ(file_kind("a/b.glb"), FileKind::kGlb);
  EXPECT_EQ(file_kind("B.GLB"), FileKind::kGlb);
  EXPECT_EQ(file_kind("b.gltf"), FileKind::kGltf);
  EXPECT_EQ(file_kind("b.embedded.gltf"), FileKind::kEmbedded);
  EXPECT_EQ(file_kind("b.obj"), std::nullopt);
  EXPECT_EQ(file_kind("glb"), std::nullopt);
}

TEST(WriteGltf, EveryKindIsReadAgain) {
  const Sample sample;
  for (const char* name : {"out.glb", "out.gltf", "out.embedded.gltf"}) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / name));
    sample.expect_same_data(read(folder / name));
    if (std::string(name) == "out.gltf") {
      EXPECT_THAT(names_in(folder.path()), ElementsAre(MatchesRegex(kBinName), "out.gltf"));
    } else {
      EXPECT_THAT(names_in(folder.path()), ElementsAre(name));
    }
  }
}

TEST(WriteGltf, SeveralBuffersBecomeOne) {
  Sample sample;
  Document& document = sample.document;
  document.json["buffers"][0]["name"] = "first";
  document.json["buffers"].push_back({{"byteLength", 5}});
  document.buffers.push_back({1, 2, 3, 4, 5, 99, 99});  // longer than it says
  document.json["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 1}, {"byteLength", 4}});
  document.json["accessors"].push_back({{"bufferView", document.json["bufferViews"].size() - 1},
                                        {"componentType", 5121},
                                        {"count", 4},
                                        {"type", "SCALAR"}});
  document.json["bufferViews"][sample.document.json["accessors"][sample.accessor]["bufferView"].get<std::size_t>()]
               ["buffer"] = 2;
  const Document again = read_back(document, sample.added);
  ASSERT_EQ(again.buffers.size(), 1U);
  EXPECT_EQ(again.json["buffers"][0]["name"], "first");
  EXPECT_EQ(read_accessor(again, sample.accessor + 1).bytes, (Bytes{2, 3, 4, 5}));
  EXPECT_EQ(read_accessor(again, sample.accessor).bytes, (Bytes{7, 8, 9}));
}

TEST(WriteGltf, NamesAndExtrasOfAllBuffersAreKept) {
  Sample sample;
  Document& document = sample.document;
  document.json["buffers"][0]["extras"] = {{"theirs", 1}};
  const std::size_t ours = document.json["buffers"].size();
  document.json["buffers"].push_back({{"byteLength", 1}, {"name", "second"}, {"extras", {2, nullptr}}});
  document.buffers.push_back({1});
  document.json["buffers"].push_back(Json::object());
  document.json["buffers"][ours + 1]["byteLength"] = 1;
  document.buffers.push_back({1});
  document.json["bufferViews"][document.json["accessors"][sample.accessor]["bufferView"].get<std::size_t>()]["buffer"] =
      ours + 2;
  const Document again = read_back(document, sample.added);
  EXPECT_EQ(again.json["buffers"][0]["extras"],
            Json::parse(R"({"theirs": 1, "radiosity": {"merged": [{"name": "second", "extras": [2, null]}]}})"));
}

TEST(WriteGltf, ADocumentWithoutDataHasNoBuffer) {
  Document document;
  document.json = {{"asset", {{"version", "2.0"}}}};
  const Document again = read_back(document, BufferBuilder());
  EXPECT_EQ(again.json, document.json);
}

TEST(WriteGltf, OnlyNewDataIsABufferToo) {
  Document document;
  document.json = {{"asset", {{"version", "2.0"}}}};
  BufferBuilder added;
  append_accessor(document, added, {ComponentType::kU8, 1, false, 1, {42}}, BufferTarget::kVertices);
  const Document again = read_back(document, added);
  EXPECT_EQ(read_accessor(again, 0).bytes, Bytes{42});
}

TEST(WriteGltf, AGlbIsPaddedAndKnowsItsLength) {
  const Sample sample;
  const Result<Bytes> glb = to_glb(sample.document, sample.added);
  ASSERT_TRUE(glb);
  EXPECT_EQ(glb->size() % 4, 0U);
  const auto u32 = [&](std::size_t at) {
    return static_cast<std::uint32_t>((*glb)[at] | (*glb)[at + 1] << 8 | (*glb)[at + 2] << 16 | (*glb)[at + 3] << 24);
  };
  EXPECT_EQ(u32(0), 0x46546C67U);
  EXPECT_EQ(u32(8), glb->size());
  EXPECT_EQ(u32(12) % 4, 0U);
  EXPECT_EQ(u32(20 + u32(12) + 4), 0x004E4942U);
}

TEST(WriteGltf, AGlbThatIsTooLongIsAnError) {
  const Sample sample;
  const std::uint64_t size = to_glb(sample.document, sample.added)->size();
  EXPECT_TRUE(to_glb(sample.document, sample.added, size));
  const Result<Bytes> glb = to_glb(sample.document, sample.added, size - 1);
  ASSERT_FALSE(glb);
  EXPECT_EQ(glb.error().code, ErrorCode::kCannotWrite);
}

// Images.

TEST(WriteGltf, AGlbHoldsImagesThatWereFiles) {
  const Sample sample(image_file("textures/a%20b.png"));
  write_text(sample.input / "textures/a b.png", kPng);
  const Document again = read_back(sample.document, sample.added);
  const Json& image = again.json["images"][0];
  EXPECT_FALSE(image.contains("uri"));
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_EQ(image["name"], "wood");
  const Result<Bytes> bytes = image_bytes(again, 0);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), kPng);
  sample.expect_same_data(again);
}

TEST(WriteGltf, ImagesInsideStayAsTheyAre) {
  const Json images =
      Json::parse(R"([{"uri": "data:image/png;base64,iVBORw=="}, {"bufferView": 0, "mimeType": "image/png"}])");
  const Sample sample(images);
  EXPECT_EQ(read_back(sample.document, sample.added).json["images"], images);
}

TEST(WriteGltf, AnEmbeddedFileHoldsImagesAsDataUris) {
  const Sample sample(image_file("a.png"));
  write_text(sample.input / "a.png", kPng);
  const TemporaryFolder folder;
  ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / "out.embedded.gltf"));
  const Document again = read(folder / "out.embedded.gltf");
  EXPECT_THAT(again.json["images"][0]["uri"].get<std::string>(), StartsWith("data:image/png;base64,"));
  const Result<Bytes> bytes = image_bytes(again, 0);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), kPng);
}

TEST(WriteGltf, ImagesFollowAGltfIntoItsFolder) {
  const Sample sample(image_file("textures/a.png"));
  write_text(sample.input / "textures/a.png", kPng);
  const TemporaryFolder folder;
  ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / "out.gltf"));
  EXPECT_EQ(read_text(folder / "textures/a.png"), kPng);
  EXPECT_EQ(read(folder / "out.gltf").json["images"], sample.document.json["images"]);
}

TEST(WriteGltf, ImagesInTheOutputsFolderStay) {
  const Sample sample(image_file("textures/a.png"));
  write_text(sample.input / "textures/a.png", kPng);
  ASSERT_TRUE(write_gltf(sample.document, sample.added, sample.input / "out.gltf"));
  EXPECT_THAT(names_in(sample.input / "textures"), ElementsAre("a.png"));
}

TEST(WriteGltf, AnImageThatIsThereAlreadyIsNotWrittenAgain) {
  const Sample sample(image_file("a.png"));
  write_text(sample.input / "a.png", kPng);
  const TemporaryFolder folder;
  write_text(folder / "a.png", kPng);
  ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / "out.gltf"));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a.png", MatchesRegex(kBinName), "out.gltf"));
}

TEST(WriteGltf, NobodyElsesImageIsOverwritten) {
  const Sample sample(image_file("a.png"));
  write_text(sample.input / "a.png", kPng);
  const TemporaryFolder folder;
  write_text(folder / "a.png", "another image");
  ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / "out.gltf"));
  EXPECT_EQ(read_text(folder / "a.png"), "another image");
  const Document again = read(folder / "out.gltf");
  EXPECT_THAT(again.json["images"][0]["uri"].get<std::string>(), testing::MatchesRegex("a-[0-9a-f]+\\.png"));
  const Result<Bytes> bytes = image_bytes(again, 0);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), kPng);

  // Once more: the name depends on the content, so nothing new appears.
  ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / "out.gltf"));
  EXPECT_EQ(names_in(folder.path()).size(), 4U);
}

// Names and failures.

TEST(WriteGltf, NamesAreEscapedInUris) {
  const Sample sample;
  const TemporaryFolder folder;
  ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / "größe 100%.gltf"));
  const Document again = read(folder / "größe 100%.gltf");
  EXPECT_THAT(again.json["buffers"][0]["uri"].get<std::string>(), StartsWith("gr%C3%B6%C3%9Fe%20100%25-"));
  sample.expect_same_data(again);
}

TEST(WriteGltf, AnotherBinOfThatNameIsNotOverwritten) {
  const Sample sample;
  write_text(sample.input / "out.bin", "the input's");
  ASSERT_TRUE(write_gltf(sample.document, sample.added, sample.input / "out.gltf"));
  EXPECT_EQ(read_text(sample.input / "out.bin"), "the input's");
  sample.expect_same_data(read(sample.input / "out.gltf"));
}

TEST(WriteGltf, TheOldOutputIsWholeUntilTheNewOneIs) {
  // A folder of the new .bin's name makes writing fail once everything else is done.
  Sample sample;
  const TemporaryFolder folder, elsewhere;
  ASSERT_TRUE(write_gltf(sample.document, sample.added, folder / "out.gltf"));
  const std::string old = read_text(folder / "out.gltf");
  Sample changed;
  append_accessor(changed.document, changed.added, {ComponentType::kU8, 1, false, 1, {42}}, BufferTarget::kVertices);
  ASSERT_TRUE(write_gltf(changed.document, changed.added, elsewhere / "out.gltf"));
  const std::string new_bin = names_in(elsewhere.path())[0];
  std::filesystem::create_directory(folder / new_bin);

  const Result<Done> written = write_gltf(changed.document, changed.added, folder / "out.gltf");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kCannotWrite);
  EXPECT_EQ(written.error().place, (folder / new_bin).string());
  EXPECT_EQ(read_text(folder / "out.gltf"), old);
  sample.expect_same_data(read(folder / "out.gltf"));
  EXPECT_EQ(names_in(folder.path()).size(), 3U);
}

TEST(WriteGltf, AMissingImageIsAnErrorAndWritesNothing) {
  const Sample sample(image_file("missing.png"));
  const TemporaryFolder folder;
  for (const char* name : {"out.glb", "out.gltf", "out.embedded.gltf"}) {
    EXPECT_FALSE(write_gltf(sample.document, sample.added, folder / name)) << name;
  }
  EXPECT_THAT(names_in(folder.path()), testing::IsEmpty());
}

TEST(WriteGltf, WhatCannotBeWrittenIsKnownBeforehand) {
  const TemporaryFolder folder;
  write_text(folder / "in.glb", "");
  std::filesystem::create_directory(folder / "dir.glb");
  const auto code = [&](const std::string& name) {
    const Result<Done> checked = check_output(folder / name);
    return checked ? std::optional<ErrorCode>() : checked.error().code;
  };
  EXPECT_EQ(code("out.glb"), std::nullopt);
  EXPECT_EQ(code("out.obj"), ErrorCode::kBadOption);
  EXPECT_EQ(code("./in.glb"), std::nullopt);
  EXPECT_EQ(code("missing/out.glb"), ErrorCode::kCannotWrite);
  EXPECT_EQ(code("dir.glb"), ErrorCode::kCannotWrite);
}

}  // namespace
}  // namespace gltf_radiosity
