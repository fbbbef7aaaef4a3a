// Small images that are right, for a fuzzer to start from: PNG, JPEG and WebP, of every kind of pixel.
#pragma once

#include <cstdint>
#include <cstdio>  // jpeglib.h, which comes next in image_seeds.cpp, needs FILE and size_t
#include <vector>

namespace gltf_radiosity::fuzz {

std::vector<std::vector<std::uint8_t>> image_seeds();

}  // namespace gltf_radiosity::fuzz
