// Textures as light sees them: sampled at a point, averaged over a triangle.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

struct MipPyramid;  // decoded image with prefiltered levels (import_textures.cpp)

enum class Wrap : std::uint16_t { kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648 };

/// What a texture holds.
enum class TexelKind : std::uint8_t {
  kData,          ///< numbers as they are
  kColor,         ///< sRGB colours; alpha is a number and has no say in averages of the colour
  kCoveredColor,  ///< sRGB colours where alpha says there is something: averages of the colour are weighted by alpha
};

/// One use of a texture by a material. Empty (no image) answers white everywhere. Thread-safe.
struct TextureSlot {
  std::shared_ptr<const MipPyramid> image;  ///< shared between slots
  Wrap wrap_s = Wrap::kRepeat, wrap_t = Wrap::kRepeat;
  int texcoord = 0;                     ///< TEXCOORD_n, KHR_texture_transform's override applied
  glm::vec2 offset{0.0F}, scale{1.0F};  ///< KHR_texture_transform
  float rotation = 0.0F;                ///< rad

  explicit operator bool() const { return image != nullptr; }
  /// Bilinear value at a texture coordinate, linear RGBA.
  glm::vec4 at(glm::vec2 uv) const;
  /// Mean over the triangle uv[0..2], linear RGBA: every texel counts by the area it covers. Large triangles are
  /// averaged through prefiltered levels, whose texels count whole along the edges.
  glm::vec4 mean(const std::array<glm::vec2, 3>& uv) const;

 private:
  glm::vec2 transformed(glm::vec2 uv) const;
};

/// Extensions of a texture that name an image in a format of their own.
inline constexpr std::array kImageExtensions = {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif",
                                                "MSFT_texture_dds"};

/// Decodes each image once. A broken image is an error that names it. Of a format that nothing here decodes (KTX2) the
/// plain image is taken, or none, which is white; a warning names the texture.
class TextureLibrary {
 public:
  /// Both must outlive the library.
  TextureLibrary(const Document& document, std::vector<Warning>& warnings) : document_(document), warnings_(warnings) {}
  /// `info` is a glTF textureInfo object ({"index": ..., "texCoord": ...}).
  Result<TextureSlot> slot(const Json& info, TexelKind kind);

 private:
  Result<std::shared_ptr<const MipPyramid>> image_of(std::size_t texture, TexelKind kind);

  const Document& document_;
  std::vector<Warning>& warnings_;
  std::set<std::size_t> unread_;  ///< textures that were warned of
  std::map<std::pair<std::size_t, TexelKind>, std::shared_ptr<const MipPyramid>> decoded_;
};

}  // namespace gltf_radiosity
