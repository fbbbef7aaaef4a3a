#include "tests/plugin/bake_by_hand.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/mesh/subdivide_uniform.h"
#include "plugin/write_gltf.h"

namespace gltf_radiosity {

HandBake bake_by_hand(const GltfBuilder& builder, int levels, const radiosity::Rgb& irradiance,
                      const Options& options) {
  // Import.
  HandBake result;
  Result<Document> document = read_document(builder.glb(), {});
  EXPECT_TRUE(document) << document.error().text();
  result.document = std::move(*document);
  Result<ImportedScene> scene = import_scene(result.document, options, result.warnings);
  EXPECT_TRUE(scene) << scene.error().text();
  result.scene = std::move(*scene);

  // Light.
  const std::vector<std::int8_t> level_of_triangle(result.scene.scene.triangles.size(),
                                                   static_cast<std::int8_t>(levels));
  radiosity::SubdivideOptions subdivide;
  subdivide.level_of_triangle = level_of_triangle;
  result.bake.mesh = radiosity::subdivide_uniform(result.scene.scene, subdivide, {}).mesh;
  result.bake.irradiance.assign(result.bake.mesh.positions.size(), irradiance);
  return result;
}

Document read_back(const Document& document, const BufferBuilder& added) {
  const Result<Bytes> glb = to_glb(document, added);
  EXPECT_TRUE(glb) << glb.error().text();
  Result<Document> again = read_document(*glb, {});
  EXPECT_TRUE(again) << again.error().text();
  return again ? std::move(*again) : Document();
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "gltf_radiosity_XXXXXX").string();
  EXPECT_NE(::mkdtemp(pattern.data()), nullptr);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace gltf_radiosity
