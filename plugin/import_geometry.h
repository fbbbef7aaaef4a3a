// A glTF primitive -> triangles with attributes, in the mesh's own space.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Shapes: per vertex [vertex_count] or empty where the primitive lacks the attribute.
struct PrimitiveGeometry {
  std::vector<glm::vec3> positions;  ///< finite
  std::vector<glm::vec3> normals;    ///< any length; zero where triangles are shaded flat; never empty
  std::vector<glm::uvec3> triangles;
  std::vector<glm::vec4> colors;                    ///< COLOR_0, linear, within [0,1]
  std::map<int, std::vector<glm::vec2>> texcoords;  ///< by set
  std::vector<std::array<std::uint32_t, 4>> joints;
  std::vector<glm::vec4> weights;
  std::vector<std::uint32_t> source_vertex;  ///< PrimitiveInstance::source_vertex
  std::uint32_t recomputed_normals = 0;      ///< that were not finite or zero in the file
};

/// Whether a primitive is made of triangles; points and lines take no part in light.
bool has_triangles(const tinygltf::Model& model, std::size_t mesh, std::size_t primitive);

/// Reads triangles, strips and fans. `texcoords`: the sets wanted. `morph_weights`: of the mesh's morph targets, may be
/// empty. Indices beyond the vertices and positions that are not finite are errors.
Result<PrimitiveGeometry> read_primitive(const Document& document, const tinygltf::Model& model, std::size_t mesh,
                                         std::size_t primitive, const std::set<int>& texcoords,
                                         std::span<const double> morph_weights);

/// World transforms of vertices that follow a skin: for each, the blend of its joints' matrices. [vertex_count].
/// Joints that the skin does not have count as its first.
std::vector<glm::dmat4> skin_transforms(const PrimitiveGeometry& geometry, std::span<const glm::dmat4> world_from_bind);

}  // namespace gltf_radiosity
