#include "plugin/hdr_decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

// All of stb_image is local to this file, and only its HDR reader: libdraco exports an older stb_image of its own.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#include <stb_image.h>

namespace gltf_radiosity {
namespace {

/// Beyond it sums over the sphere might overflow.
constexpr float kMaxLuminance = 1e30F;

/// What is left of a file, handed out as stb_image asks for it; stb_image itself takes what is missing for zeros.
struct Source {
  std::span<const std::uint8_t> left;
  bool truncated = false;

  static int read(void* user, char* to, int wanted) {
    auto& source = *static_cast<Source*>(user);
    const std::size_t count = std::min(static_cast<std::size_t>(wanted), source.left.size());
    source.truncated = source.truncated || count == 0;
    std::copy_n(source.left.begin(), count, to);
    source.left = source.left.subspan(count);
    return static_cast<int>(count);
  }
  static void skip(void* user, int wanted) {
    auto& source = *static_cast<Source*>(user);
    source.left = source.left.subspan(std::min(static_cast<std::size_t>(std::max(wanted, 0)), source.left.size()));
  }
  static int at_end(void* user) { return static_cast<Source*>(user)->left.empty() ? 1 : 0; }
};

constexpr stbi_io_callbacks kCallbacks{Source::read, Source::skip, Source::at_end};

bool is_light(const radiosity::Rgb& v) {
  const auto fine = [](float band) { return band >= 0.0F && band < kMaxLuminance; };
  return fine(v.x) && fine(v.y) && fine(v.z);
}

}  // namespace

Result<HdrImage> decode_hdr(std::span<const std::uint8_t> bytes, const std::string& place, const MemoryBudget& memory) {
  // What the header says.
  HdrImage image;
  int bands = 0;
  Source header{bytes};
  if (stbi_info_from_callbacks(&kCallbacks, &header, &image.width, &image.height, &bands) == 0) {
    return bad_input(place, "is not a Radiance HDR image");
  }
  if (image.width < 1 || image.height < 1) return bad_input(place, "the HDR image is empty");
  if (image.width > kMaxHdrWidth || image.height > kMaxHdrHeight) {
    return bad_input(place, fmt::format("the HDR image is larger than {} x {}", kMaxHdrWidth, kMaxHdrHeight));
  }

  // Its pixels, for a moment twice.
  constexpr std::uint64_t kBytesPerTexel = 2 * sizeof(radiosity::Rgb) + 4;
  const auto texel_count = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  if (const auto fits = memory.check(texel_count, kBytesPerTexel, place, "pixels"); !fits) return fits.error();
  // Run lengths go up to 127, for each of four bytes.
  if (texel_count > std::uint64_t{16} * bytes.size()) {
    return bad_input(place,
                     fmt::format("{} bytes cannot hold {} x {} pixels", bytes.size(), image.width, image.height));
  }
  Source source{bytes};
  const std::unique_ptr<float, void (*)(void*)> pixels(
      stbi_loadf_from_callbacks(&kCallbacks, &source, &image.width, &image.height, &bands, 3), stbi_image_free);
  if (!pixels || source.truncated) return bad_input(place, "the HDR image is broken");
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.texels.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const float* pixel = pixels.get() + 3 * k;
    image.texels[k] = {pixel[0], pixel[1], pixel[2]};
    if (!is_light(image.texels[k])) return bad_input(place, "holds light that is negative, not finite or above 1e30");
  }
  return image;
}

}  // namespace gltf_radiosity
