// Where a primitive without normals must be split, so that light can differ from facet to facet.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace gltf_radiosity {

/// glTF shades a primitive without normals flat. Around each position, faces that follow each other across edges and
/// crease by no more than this share a vertex, so that a faceted sphere is lit smoothly; across a sharper edge the
/// light may jump.
inline constexpr double kCreaseDegrees = 20.0;

/// Gives corners of `triangles` vertices of their own where faces crease. Returns which vertex each one is a copy of:
/// the old vertices first, in order, then the copies; empty if nothing was split. Vertices at one position count as one
/// for finding neighbours (core/mesh/weld.h). Triangles without area stay as they are. Deterministic.
std::vector<std::uint32_t> split_creases(std::span<const glm::vec3> positions, std::vector<glm::uvec3>& triangles);

}  // namespace gltf_radiosity
