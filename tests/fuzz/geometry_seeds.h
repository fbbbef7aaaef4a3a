// Small compressed meshes that are right, for fuzzers to start from.
#pragma once

#include <cstdint>
#include <vector>

namespace gltf_radiosity::fuzz {

using Seeds = std::vector<std::vector<std::uint8_t>>;

/// Blobs of KHR_draco_mesh_compression: both methods at several speeds, attributes of several types.
Seeds draco_seeds();

/// What fuzz_meshopt.cpp takes: every mode, with every filter that suits it.
Seeds meshopt_seeds();

}  // namespace gltf_radiosity::fuzz
