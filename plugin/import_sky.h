// --sky, --sky-rotation and EXT_lights_image_based -> core sky.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/sky.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// What surrounds the scene: --sky, or else the image-based light of the scene that is baked; nothing if there is
/// neither. A --sky that replaces the file's own is a warning; images that cannot be used are one too, and the sky is
/// then made from the light's irradiance coefficients.
Result<std::optional<radiosity::Sky>> import_sky(const Document& document, const Options& options,
                                                 std::vector<Warning>& warnings);

/// One face of a cube map: rows of an image from the top.
struct CubeFace {
  int size = 0;                        ///< texels along an edge
  std::vector<radiosity::Rgb> texels;  ///< [size * size]
};

/// An equirectangular map four times as wide as a face. Faces in the order +x, -x, +y, -y, +z, -z, each as it looks
/// from inside: the extension wants those of a cube map in OpenGL flipped left to right. REQUIRES: all of one size.
radiosity::Sky sky_from_cube(std::span<const CubeFace, 6> faces);

/// The luminance whose irradiance has these spherical harmonics, not below 0. Ramamoorthi and Hanrahan. An Efficient
/// Representation for Irradiance Environment Maps. 2001
radiosity::Sky sky_from_coefficients(std::span<const radiosity::Rgb, 9> coefficients);

}  // namespace gltf_radiosity
