#include "plugin/import_sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "core/photometry.h"
#include "plugin/check_document.h"
#include "plugin/hdr_decode.h"
#include "plugin/image_decode.h"
#include "plugin/import_nodes.h"
#include "plugin/srgb.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;
using radiosity::Sky;

constexpr const char* kImageBasedLight = "EXT_lights_image_based";

/// Four times as wide, a map of such faces is within the bounds of HDR images.
constexpr int kMaxFaceSize = 2048;

struct FileLight {
  const Json* light = nullptr;  ///< null: there is none
  std::string place;
};

/// The image-based light of a scene.
FileLight file_light(const Json& root, std::optional<std::size_t> scene) {
  const Json* all = extension_of(root, kImageBasedLight);
  if (!scene || all == nullptr) return {};
  const Json* reference = extension_of(root["scenes"][*scene], kImageBasedLight);
  if (reference == nullptr) return {};
  const auto index = (*reference)["light"].get<std::size_t>();
  return {&(*all)["lights"][index], place_of(fmt::format("extensions.{}.lights", kImageBasedLight), index)};
}

Sky empty_map(int width) {
  Sky sky;
  sky.width = width;
  sky.height = width / 2;
  sky.map.resize(static_cast<std::size_t>(sky.width) * static_cast<std::size_t>(sky.height));
  return sky;
}

/// A PNG with alpha is RGBD: its colours are divided by alpha. Without alpha that is 1.
CubeFace face_of(const Pixels& pixels) {
  CubeFace face{pixels.width, {}};
  for (std::size_t k = 0; k < pixels.rgba.size(); k += 4) {
    const float divisor = static_cast<float>(std::max<int>(pixels.rgba[k + 3], 1)) / 255.0F;
    face.texels.push_back(
        Rgb(kSrgbToLinear[pixels.rgba[k]], kSrgbToLinear[pixels.rgba[k + 1]], kSrgbToLinear[pixels.rgba[k + 2]]) /
        divisor);
  }
  return face;
}

/// The sharpest level of the light's cube map.
Result<std::array<CubeFace, 6>> read_faces(const Document& document, const FileLight& light) {
  const auto levels = light.light->find("specularImages");
  if (levels == light.light->end() || levels->empty()) return bad_input(light.place, "has no images");
  std::array<CubeFace, 6> faces;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const auto index = (*levels)[0][k].get<std::size_t>();
    const std::string place = place_of("images", index);
    const Result<Bytes> bytes = image_bytes(document, index);
    if (!bytes) return bytes.error();
    const Result<Pixels> pixels = decode_image(*bytes, place, document.memory.get());
    if (!pixels) return pixels.error();
    if (k == 0) {
      // The faces as light, as they grow, and the map that is made of them.
      constexpr std::uint64_t kBytesPerTexel = (6 * 2 + 8) * sizeof(Rgb);
      const auto width = static_cast<std::uint64_t>(pixels->width);
      if (auto room = document.memory->reserve(width * width, kBytesPerTexel, place, "pixels of each face"); !room) {
        return room.error();
      }
    }
    const bool fits = pixels->width == pixels->height && pixels->width <= kMaxFaceSize;
    if (!fits || (k > 0 && pixels->width != faces[0].size)) return bad_input(place, "is no face of a cube map");
    faces[k] = face_of(*pixels);
  }
  return faces;
}

std::array<Rgb, 9> coefficients_of(const Json& light) {
  std::array<Rgb, 9> coefficients{};
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    for (int band = 0; band < 3; ++band) {
      coefficients[k][band] = light["irradianceCoefficients"][k][static_cast<std::size_t>(band)].get<float>();
    }
  }
  return coefficients;
}

/// The inverse of the light's rotation.
glm::mat3 map_from_world(const Json& light) {
  if (!light.contains("rotation")) return glm::mat3(1.0F);
  const Json& r = light["rotation"];
  const glm::dquat rotation(r[3].get<double>(), r[0].get<double>(), r[1].get<double>(), r[2].get<double>());
  const double length = glm::length(rotation);
  if (!(length > 0.0)) return glm::mat3(1.0F);
  return glm::mat3(glm::transpose(glm::mat3_cast(rotation / length)));
}

Result<Sky> sky_of_file_light(const Document& document, const FileLight& light, std::vector<Warning>& warnings) {
  Sky sky;
  if (const auto faces = read_faces(document, light)) {
    sky = sky_from_cube(*faces);
  } else if (light.light->contains("irradianceCoefficients")) {
    warnings.push_back(
        {"image-based-light-images", light.place,
         fmt::format("the images cannot be used ({}); the sky was made from the irradiance coefficients, "
                     "without details",
                     faces.error().text())});
    sky = sky_from_coefficients(coefficients_of(*light.light));
  } else {
    return faces.error();
  }
  const float intensity = std::max(light.light->value("intensity", 1.0F), 0.0F);
  for (Rgb& texel : sky.map) texel *= intensity;
  sky.map_from_world = map_from_world(*light.light);
  if (radiosity::validate(sky)) return bad_input(light.place, "holds light that is not finite");
  return sky;
}

/// --sky as a luminance or as a file.
Result<std::optional<Sky>> sky_of_options(const Options& options, MemoryBudget& memory) {
  Sky sky;
  if (!options.sky_file.empty()) {
    const Result<Bytes> bytes = read_file(options.sky_file, "", memory.left());
    if (!bytes) return bytes.error();
    Result<HdrImage> image = decode_hdr(*bytes, options.sky_file, memory);
    if (!image) return image.error();
    constexpr std::uint64_t kBytesPerTexel = 3 * sizeof(Rgb);  // the map, and what picks directions by it
    auto room = memory.reserve(image->texels.size(), kBytesPerTexel, options.sky_file, "pixels");
    if (!room) return room.error();
    sky.width = image->width;
    sky.height = image->height;
    sky.map = std::move(image->texels);
    return std::optional(std::move(sky));
  }
  if (!options.sky) return std::optional<Sky>();
  for (int band = 0; band < 3; ++band) {
    const double value = (*options.sky)[static_cast<std::size_t>(band)];
    if (!(value >= 0.0 && value < 1e30)) return Error{ErrorCode::kBadOption, "sky", "is negative or not finite"};
    sky.luminance[band] = static_cast<float>(value);
  }
  return std::optional(std::move(sky));
}

}  // namespace

Result<std::optional<Sky>> import_sky(const Document& document, const Options& options,
                                      std::vector<Warning>& warnings) {
  auto sky = sky_of_options(options, *document.memory);
  if (!sky) return sky.error();
  const auto scene = chosen_scene(document.json, options.scene);
  if (!scene) return scene.error();
  const FileLight light = file_light(document.json, *scene);
  if (*sky && light.light != nullptr) {
    warnings.push_back({"image-based-light-replaced", light.place, "--sky replaces the image-based light of the file"});
  } else if (light.light != nullptr && light.light->value("intensity", 1.0F) > 0.0F) {
    auto own = sky_of_file_light(document, light, warnings);
    if (!own) return own.error();
    *sky = std::move(*own);
  }
  if (*sky) (*sky)->map_from_world *= radiosity::map_turned_by(options.sky_rotation_degrees);
  return sky;
}

Sky sky_from_cube(std::span<const CubeFace, 6> faces) {
  Sky sky = empty_map(4 * faces[0].size);
  const auto size = static_cast<float>(faces[0].size);
  const auto look_up = [&](const glm::vec3& d) {
    // Right and down on the face that a direction meets, with the face at distance 1.
    const glm::vec3 far = glm::abs(d);
    const int axis = far.x >= far.y && far.x >= far.z ? 0 : far.y >= far.z ? 1 : 2;
    const float sign = d[axis] < 0.0F ? -1.0F : 1.0F;
    const glm::vec2 at = axis == 0   ? glm::vec2(sign * d.z, -d.y)
                         : axis == 1 ? glm::vec2(-d.x, sign * d.z)
                                     : glm::vec2(-sign * d.x, -d.y);
    const CubeFace& face = faces[static_cast<std::size_t>(2 * axis + (sign < 0.0F ? 1 : 0))];
    const glm::ivec2 texel(glm::clamp((at / far[axis] + 1.0F) * 0.5F * size, 0.0F, size - 1.0F));
    return face.texels[static_cast<std::size_t>(texel.y * face.size + texel.x)];
  };

  // Each texel is the mean over a few places; of large faces one is enough.
  constexpr int kLarge = 512;
  const int across = faces[0].size > kLarge ? 1 : 3;
  const auto share = 1.0F / static_cast<float>(across * across);
  for (std::size_t t = 0; t < sky.map.size(); ++t) {
    for (int k = 0; k < across * across; ++k) {
      const glm::vec2 place = (glm::vec2(k % across, k / across) + 0.5F) / static_cast<float>(across);
      sky.map[t] += share * look_up(direction_in_texel(sky, t, place));
    }
  }
  return sky;
}

Sky sky_from_coefficients(std::span<const Rgb, 9> coefficients) {
  // What turned luminance into irradiance, band by band, is undone.
  constexpr double kPi{radiosity::kPi};
  const double cosine_lobe[3] = {kPi, 2.0 * kPi / 3.0, kPi / 4.0};
  constexpr int kMapWidth = 128;
  Sky sky = empty_map(kMapWidth);
  for (std::size_t t = 0; t < sky.map.size(); ++t) {
    const glm::dvec3 d = direction_in_texel(sky, t, {0.5F, 0.5F});
    const double harmonic[9] = {0.282095,
                                0.488603 * d.y,
                                0.488603 * d.z,
                                0.488603 * d.x,
                                1.092548 * d.x * d.y,
                                1.092548 * d.y * d.z,
                                0.315392 * (3.0 * d.z * d.z - 1.0),
                                1.092548 * d.x * d.z,
                                0.546274 * (d.x * d.x - d.y * d.y)};
    glm::dvec3 luminance(0.0);
    for (std::size_t k = 0; k < 9; ++k) {
      const std::size_t band = k == 0 ? 0 : k < 4 ? 1 : 2;
      luminance += glm::dvec3(coefficients[k]) * (harmonic[k] / cosine_lobe[band]);
    }
    sky.map[t] = Rgb(glm::max(luminance, 0.0));
  }
  return sky;
}

}  // namespace gltf_radiosity
