#include "plugin/view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "plugin/base64.h"
#include "plugin/page/page_parts.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What stands in the page between `before` and `after`.
std::string between(const std::string& page, const std::string& before, const std::string& after) {
  const std::size_t start = page.find(before);
  if (start == std::string::npos) return "not there";
  return page.substr(start + before.size(), page.find(after, start + before.size()) - start - before.size());
}

GltfBuilder coloured_square() {
  GltfBuilder builder;
  PrimitiveParts square = unit_square();
  square.colors.assign(square.positions.size(), glm::vec4(1.0F));
  builder.add_node(builder.add_mesh(square));
  return builder;
}

class View : public testing::Test {
 protected:
  void SetUp() override {
    if (!page_parts()) GTEST_SKIP() << "built without the page";
  }

  std::string file(const std::string& name, const Bytes& bytes) const {
    write_text(folder / name, std::string(bytes.begin(), bytes.end()));
    return (folder / name).string();
  }
  std::string html() const { return (folder / "page.html").string(); }

  /// The page of a file.
  std::string page_of(const std::string& baked, const ViewOptions& options = {}) const {
    const Result<ViewReport> report = view_file(baked, html(), options);
    EXPECT_TRUE(report) << report.error().text();
    return report ? read_text(html()) : "";
  }

  TemporaryFolder folder;
};

TEST_F(View, TheFileIsInThePageByteForByte) {
  const Bytes glb = coloured_square().glb();
  const std::string page = page_of(file("baked.glb", glb));
  EXPECT_EQ(decode_base64(between(page, "data-part=\"model\">", "</script>")), glb);
}

TEST_F(View, LargeFilesComeInPieces) {
  GltfBuilder builder = coloured_square();
  builder.add_buffer_view(Bytes(std::size_t{13} << 20U, 7));
  const Bytes glb = builder.glb();
  const std::string page = page_of(file("baked.glb", glb));
  Bytes found;
  for (std::size_t at = page.find("data-part"); at != std::string::npos; at = page.find("data-part", at + 1)) {
    if (page.compare(at, 18, "data-part=\"model\">") != 0) continue;
    const auto piece = decode_base64(between(page.substr(at), "\">", "</script>"));
    ASSERT_TRUE(piece);
    found.insert(found.end(), piece->begin(), piece->end());
  }
  EXPECT_EQ(found, glb);
}

TEST_F(View, ItsImagesComeAlong) {
  GltfBuilder builder = coloured_square();
  file("grey.png", encode_png(1, 1, {128, 128, 128, 255}));
  builder.json["images"] = {{{"uri", "grey.png"}}};
  const std::string page = page_of(file("baked.glb", builder.glb()));
  const auto glb = decode_base64(between(page, "data-part=\"model\">", "</script>"));
  ASSERT_TRUE(glb);
  const Result<Document> document = read_document(*glb, {});
  ASSERT_TRUE(document) << document.error().text();
  EXPECT_FALSE(document->json["images"][0].contains("uri"));
  EXPECT_EQ(*image_bytes(*document, 0), encode_png(1, 1, {128, 128, 128, 255}));
}

TEST_F(View, NothingIsLeftToFillIn) {
  const std::string page = page_of(file("baked.glb", coloured_square().glb()));
  for (const char* name : {"@TITLE@", "@VERSION@", "@STYLE@", "@SCRIPT@", "@MODEL@", "@DECODERS@", "@NOTICES@"}) {
    EXPECT_THAT(page, Not(HasSubstr(name)));
  }
  EXPECT_THAT(page, HasSubstr("Permission is hereby granted, free of charge"));
  EXPECT_THAT(page, HasSubstr("three.js authors"));
  EXPECT_THAT(page, Not(HasSubstr("data-part=\"draco")));
}

TEST_F(View, TitlesAreTextAndNothingElse) {
  const std::string page =
      page_of(file("baked.glb", coloured_square().glb()), {.title = "</title><script>\"&'@SCRIPT@"});
  EXPECT_EQ(between(page, "<title>", "</title>"), "&lt;/title&gt;&lt;script&gt;&quot;&amp;'@SCRIPT@");
}

TEST_F(View, TheFileNameIsTheTitleUnlessThereIsAnother) {
  const std::string baked = file("baked.glb", coloured_square().glb());
  EXPECT_EQ(between(page_of(baked), "<title>", "</title>"), "baked.glb");
  EXPECT_EQ(between(page_of(baked, {.title = "Hall"}), "<title>", "</title>"), "Hall");
}

TEST_F(View, TheScriptDoesNotEndEarly) {
  for (const char* end : {"</script", "<!--"}) EXPECT_EQ(page_parts()->script.find(end), std::string_view::npos);
}

TEST_F(View, WhatIsNotBakedIsRefused) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  const std::string baked = file("source.glb", builder.glb());
  const Result<ViewReport> report = view_file(baked, html());
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(report.error().place, baked);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"source.glb"});
}

TEST_F(View, TexturesThatThePageCannotDecodeAreRefused) {
  GltfBuilder builder = coloured_square();
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_texture_basisu"};
  const Result<ViewReport> report = view_file(file("baked.glb", builder.glb()), html());
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().text(), HasSubstr("KHR_texture_basisu"));
}

TEST_F(View, ThePageDoesNotReplaceTheFile) {
  const std::string baked = file("baked.glb", coloured_square().glb());
  const Result<ViewReport> report = view_file(baked, (folder / "." / "baked.glb").string());
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadOption);
}

}  // namespace
}  // namespace gltf_radiosity
