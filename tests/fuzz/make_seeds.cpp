// make_seeds SCENES_DIR OUT_DIR: what fuzzers start from, a folder for each kind of input: gltf, baked, draco, meshopt,
// image. Of the scenes those that are small.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "plugin/gltf_radiosity.h"
#include "tests/fuzz/geometry_seeds.h"
#include "tests/fuzz/image_seeds.h"

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

/// Larger ones are slow, and have nothing that the small ones have not.
constexpr std::uintmax_t kMaxSceneBytes = 24 * 1024;

Bytes read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const void* bytes, std::size_t size) {
  std::ofstream(file, std::ios::binary).write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
}

void write_all(const fs::path& folder, const gltf_radiosity::fuzz::Seeds& seeds) {
  fs::create_directories(folder);
  for (std::size_t k = 0; k < seeds.size(); ++k) write(folder / std::to_string(k), seeds[k].data(), seeds[k].size());
}

/// The scene baked without new vertices, if it can be; compressed by Draco as well.
void write_baked(const fs::path& folder, const std::string& name, const Bytes& scene) {
  for (const int draco_bits : {0, 12}) {
    gltf_radiosity::Options options;
    options.refine = gltf_radiosity::Refine::kNone;
    options.hemicube = 2;
    options.max_patches = 100;
    options.draco_bits = draco_bits;
    const auto baked = gltf_radiosity::bake_memory(std::as_bytes(std::span(scene)), options);
    if (baked) write(folder / (name + (draco_bits > 0 ? ".draco" : "")), baked->glb.data(), baked->glb.size());
  }
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::cerr << "usage: make_seeds SCENES_DIR OUT_DIR\n";
    return 2;
  }
  const fs::path scenes = arguments[1], folder = arguments[2];
  for (const char* kind : {"gltf", "baked", "image"}) fs::create_directories(folder / kind);
  for (const auto& entry : fs::directory_iterator(scenes)) {
    const std::string extension = entry.path().extension();
    if (!entry.is_regular_file() || fs::file_size(entry) > kMaxSceneBytes) continue;
    const Bytes bytes = read(entry);
    const std::string name = entry.path().filename();
    if (extension == ".hdr") write(folder / "image" / name, bytes.data(), bytes.size());
    if (extension != ".glb" && extension != ".gltf") continue;
    write(folder / "gltf" / name, bytes.data(), bytes.size());
    write_baked(folder / "baked", name, bytes);
  }
  write_all(folder / "draco", gltf_radiosity::fuzz::draco_seeds());
  write_all(folder / "meshopt", gltf_radiosity::fuzz::meshopt_seeds());
  write_all(folder / "image", gltf_radiosity::fuzz::image_seeds());
  return 0;
}
