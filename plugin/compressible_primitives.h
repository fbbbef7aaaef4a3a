// The triangle primitives of a document as compressors want them.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "plugin/accessor_view.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// Primitives that share every accessor: they are compressed once.
struct SharedPrimitive {
  struct Place {
    std::size_t mesh = 0, primitive = 0;
  };
  std::vector<Place> places;  ///< in the order of the tree, at least one
  int position_grid = 0;      ///< attribute_grid.h
};

/// Every primitive of the document that is made of triangles with positions, whichever scene shows it. One with an
/// extension that may name its vertices by their numbers is left out, with a warning.
std::vector<SharedPrimitive> compressible_primitives(const Document& document, std::vector<Warning>& warnings);

/// An attribute with its values in memory.
struct AttributeValues {
  std::string semantic;
  std::size_t accessor = 0;  ///< where they come from
  RawAccessor raw;
};

struct PrimitiveValues {
  std::vector<glm::uvec3> triangles;        ///< a list; those with two corners at one vertex are left out; not empty
  std::vector<AttributeValues> attributes;  ///< in the order of the tree, each with as many rows
  std::vector<std::vector<AttributeValues>> targets;

  std::size_t vertex_count() const { return attributes.front().raw.count; }
};

/// Reads what a compressible primitive refers to; every float is finite. An error says in one sentence why it cannot be
/// compressed. Thread-safe. REQUIRES: all data lies in document.buffers.
Result<PrimitiveValues> read_values(const Document& document, const SharedPrimitive::Place& place);

/// "meshes[3].primitives[0]: is not compressed: ..."
Warning not_compressed(const SharedPrimitive::Place& place, const std::string& why);

}  // namespace gltf_radiosity
