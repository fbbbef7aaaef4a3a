// Small glTF documents made in memory, for tests.
//
//   GltfBuilder builder;
//   const std::size_t red = builder.add_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
//   builder.add_node(builder.add_mesh({.positions = {...}, .indices = {0, 1, 2}, .material = red}));
//   const Document document = builder.document();
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

/// One primitive; empty members are left out of the file.
struct PrimitiveParts {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec4> colors;
  std::vector<std::uint32_t> indices;
  std::optional<std::size_t> material = std::nullopt;
  int mode = 4;
};

class GltfBuilder {
 public:
  GltfBuilder();

  /// The tree so far; change what the functions below do not cover.
  Json json;

  /// Appends bytes to the only buffer, aligned to 4, as a new bufferView; returns its index.
  std::size_t add_buffer_view(std::span<const std::uint8_t> bytes);
  /// Appends `count` elements; `type` is glTF's ("VEC3"). Returns the accessor's index.
  std::size_t add_accessor(std::span<const std::uint8_t> bytes, int component_type, const std::string& type,
                           std::size_t count, bool normalized = false);
  std::size_t add_accessor(const std::vector<glm::vec2>& values);
  std::size_t add_accessor(const std::vector<glm::vec3>& values);
  std::size_t add_accessor(const std::vector<glm::vec4>& values);
  std::size_t add_indices(const std::vector<std::uint32_t>& values);

  /// A primitive's JSON with its data appended.
  Json primitive(const PrimitiveParts& parts);
  std::size_t add_mesh(const PrimitiveParts& parts);  ///< of one primitive
  std::size_t add_mesh(const Json& primitives);
  std::size_t add_material(const Json& material);
  /// An RGBA PNG of rows from the top, [height * width * 4], inside the buffer, and a texture of it; returns the
  /// texture.
  std::size_t add_texture(int width, int height, const std::vector<std::uint8_t>& rgba);
  /// A node; a root of scene 0 unless `parent` is given. `more` is merged in.
  std::size_t add_node(std::optional<std::size_t> mesh, const Json& more = Json::object(),
                       std::optional<std::size_t> parent = std::nullopt);
  /// A light (KHR_lights_punctual) on a new node.
  std::size_t add_light(const Json& light, const Json& more = Json::object());

  /// The document as read_document would make it, not checked.
  Document document() const;
  Bytes glb() const;
  /// JSON with the buffer as a data URI.
  std::string embedded() const;

  const Bytes& buffer() const { return buffer_; }

 private:
  Json finished(bool embed) const;

  Bytes buffer_;
};

/// Unit square in the plane y = 0, counter-clockwise from above, texture coordinates over the whole image.
PrimitiveParts unit_square();

Bytes encode_png(int width, int height, const std::vector<std::uint8_t>& rgba);

}  // namespace gltf_radiosity
