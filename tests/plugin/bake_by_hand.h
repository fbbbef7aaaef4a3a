// An imported scene under light that is the same everywhere, for tests of what comes after the bake.
#pragma once

#include <filesystem>
#include <vector>

#include "core/bake.h"
#include "plugin/append_accessor.h"
#include "plugin/import_scene.h"
#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {

struct HandBake {
  Document document;
  ImportedScene scene;
  radiosity::Bake bake;
  BufferBuilder added;
  std::vector<Warning> warnings;
};

/// Imports what `builder` holds, cuts every triangle in four `levels` times, and says that `irradiance` arrives
/// everywhere.
HandBake bake_by_hand(const GltfBuilder& builder, int levels, const radiosity::Rgb& irradiance,
                      const Options& options = {});

/// The document written as a GLB and read again.
Document read_back(const Document& document, const BufferBuilder& added);

/// A folder of its own for each test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

void write_text(const std::filesystem::path& file, const std::string& text);
std::string read_text(const std::filesystem::path& file);

/// The names of everything in a folder, sorted.
std::vector<std::string> names_in(const std::filesystem::path& folder);

}  // namespace gltf_radiosity
