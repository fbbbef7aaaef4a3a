#include "plugin/import_geometry.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/finite.h"
#include "plugin/accessor_view.h"
#include "plugin/assemble_triangles.h"
#include "plugin/split_creases.h"

namespace gltf_radiosity {
namespace {

using radiosity::is_finite;

/// An accessor of `Size` floats per element; missing components are `fill`.
template <int Size>
std::vector<glm::vec<Size, float>> read_vectors(const Document& document, std::size_t accessor, float fill = 0.0F) {
  const RawAccessor raw = read_accessor(document, accessor);
  const std::vector<float> floats = as_floats(raw);
  std::vector<glm::vec<Size, float>> vectors(raw.count, glm::vec<Size, float>(fill));
  const int shared = std::min(Size, raw.components);
  const float* from = floats.data();
  for (glm::vec<Size, float>& vector : vectors) {
    for (int component = 0; component < shared; ++component) vector[component] = from[component];
    from += raw.components;
  }
  return vectors;
}

Result<std::vector<glm::uvec3>> read_triangles(const Document& document, const tinygltf::Primitive& primitive,
                                               std::size_t vertex_count, const std::string& place) {
  std::vector<std::uint32_t> order;
  if (primitive.indices >= 0) {
    order = as_indices(read_accessor(document, static_cast<std::size_t>(primitive.indices)));
    const auto largest = std::max_element(order.begin(), order.end());
    if (largest != order.end() && *largest >= vertex_count) {
      return bad_input(place, fmt::format("index {} is beyond {} vertices", *largest, vertex_count));
    }
  } else {
    order.resize(vertex_count);
    for (std::size_t i = 0; i < vertex_count; ++i) order[i] = static_cast<std::uint32_t>(i);
  }
  return assemble_triangles(order, primitive.mode);
}

/// Adds weight times morph target (glTF 2.0, section 3.7.2.2).
void apply_morph_targets(const Document& document, const tinygltf::Primitive& primitive,
                         std::span<const double> weights, PrimitiveGeometry& geometry) {
  const std::size_t count = std::min(weights.size(), primitive.targets.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (weights[i] == 0.0) continue;
    const auto weight = static_cast<float>(weights[i]);
    const auto add = [&](const char* name, std::vector<glm::vec3>& to) {
      const auto target = primitive.targets[i].find(name);
      if (target == primitive.targets[i].end() || to.empty()) return;
      const auto offsets = read_vectors<3>(document, static_cast<std::size_t>(target->second));
      for (std::size_t v = 0; v < std::min(to.size(), offsets.size()); ++v) to[v] += offsets[v] * weight;
    };
    add("POSITION", geometry.positions);
    add("NORMAL", geometry.normals);
  }
}

/// Replaces normals that are zero or not finite by the mean of the faces around, weighted by area.
void mend_normals(PrimitiveGeometry& geometry) {
  const auto is_broken = [](const glm::vec3& n) { return !is_finite(n) || n == glm::vec3(0.0F); };
  const std::vector<bool> broken = [&] {
    std::vector<bool> flags(geometry.normals.size());
    std::transform(geometry.normals.begin(), geometry.normals.end(), flags.begin(), is_broken);
    return flags;
  }();
  geometry.recomputed_normals = static_cast<std::uint32_t>(std::count(broken.begin(), broken.end(), true));
  if (geometry.recomputed_normals == 0) return;

  for (std::size_t v = 0; v < broken.size(); ++v) {
    if (broken[v]) geometry.normals[v] = glm::vec3(0.0F);
  }
  for (const glm::uvec3& corners : geometry.triangles) {
    const glm::vec3& a = geometry.positions[corners.x];
    const glm::vec3 normal = glm::cross(geometry.positions[corners.y] - a, geometry.positions[corners.z] - a);
    for (int corner = 0; corner < 3; ++corner) {
      if (broken[corners[corner]]) geometry.normals[corners[corner]] += normal;
    }
  }
  for (glm::vec3& normal : geometry.normals) {
    if (is_broken(normal)) normal = glm::vec3(0.0F);  // only slivers around it: flat
  }
}

float in_unit_range(float value) { return value > 0.0F ? std::min(value, 1.0F) : 0.0F; }  // NaN counts as 0

void read_attributes(const Document& document, const tinygltf::Primitive& primitive, const std::set<int>& texcoords,
                     PrimitiveGeometry& geometry) {
  const auto accessor_of = [&](const std::string& name) -> std::optional<std::size_t> {
    const auto it = primitive.attributes.find(name);
    return it == primitive.attributes.end() ? std::nullopt : std::optional(static_cast<std::size_t>(it->second));
  };
  if (const auto accessor = accessor_of("NORMAL")) geometry.normals = read_vectors<3>(document, *accessor);
  if (const auto accessor = accessor_of("COLOR_0")) {
    geometry.colors = read_vectors<4>(document, *accessor, 1.0F);
    for (glm::vec4& color : geometry.colors) {
      for (int channel = 0; channel < 4; ++channel) color[channel] = in_unit_range(color[channel]);
    }
  }
  for (const int set : texcoords) {
    const auto accessor = accessor_of(fmt::format("TEXCOORD_{}", set));
    if (accessor) geometry.texcoords[set] = read_vectors<2>(document, *accessor);
  }
  const auto joints = accessor_of("JOINTS_0"), weights = accessor_of("WEIGHTS_0");
  if (!joints || !weights) return;
  const std::vector<std::uint32_t> indices = as_indices(read_accessor(document, *joints));
  geometry.joints.resize(indices.size() / 4);
  if (!indices.empty()) std::memcpy(geometry.joints.data(), indices.data(), indices.size() * sizeof(std::uint32_t));
  geometry.weights = read_vectors<4>(document, *weights);
}

template <typename T>
void rearrange(std::vector<T>& values, const std::vector<std::uint32_t>& source) {
  if (values.empty()) return;
  std::vector<T> arranged;
  arranged.reserve(source.size());
  for (const std::uint32_t vertex : source) arranged.push_back(values[vertex]);
  values = std::move(arranged);
}

/// Facets of a primitive without normals get vertices of their own.
void shade_flat(PrimitiveGeometry& geometry) {
  geometry.source_vertex = split_creases(geometry.positions, geometry.triangles);
  if (!geometry.source_vertex.empty()) {
    rearrange(geometry.positions, geometry.source_vertex);
    rearrange(geometry.colors, geometry.source_vertex);
    rearrange(geometry.joints, geometry.source_vertex);
    rearrange(geometry.weights, geometry.source_vertex);
    for (auto& [set, uv] : geometry.texcoords) rearrange(uv, geometry.source_vertex);
  }
  geometry.normals.assign(geometry.positions.size(), glm::vec3(0.0F));
}

}  // namespace

bool has_triangles(const tinygltf::Model& model, std::size_t mesh, std::size_t primitive) {
  const int mode = model.meshes[mesh].primitives[primitive].mode;
  return mode >= TINYGLTF_MODE_TRIANGLES && mode <= TINYGLTF_MODE_TRIANGLE_FAN;
}

Result<PrimitiveGeometry> read_primitive(const Document& document, const tinygltf::Model& model, std::size_t mesh,
                                         std::size_t primitive, const std::set<int>& texcoords,
                                         std::span<const double> morph_weights) {
  const tinygltf::Primitive& source = model.meshes[mesh].primitives[primitive];
  const std::string place = place_of_primitive(mesh, primitive);
  PrimitiveGeometry geometry;
  const auto position = source.attributes.find("POSITION");
  if (position == source.attributes.end()) return geometry;

  // Positions.
  geometry.positions = read_vectors<3>(document, static_cast<std::size_t>(position->second));
  read_attributes(document, source, texcoords, geometry);
  apply_morph_targets(document, source, morph_weights, geometry);
  const auto wild = std::find_if_not(geometry.positions.begin(), geometry.positions.end(), is_finite);
  if (wild != geometry.positions.end()) {
    return bad_input(place, fmt::format("the position of vertex {} is not finite", wild - geometry.positions.begin()));
  }

  // Triangles.
  auto triangles = read_triangles(document, source, geometry.positions.size(), place);
  if (!triangles) return triangles.error();
  geometry.triangles = std::move(*triangles);

  // Normals.
  if (geometry.normals.empty()) {
    shade_flat(geometry);
  } else {
    mend_normals(geometry);
  }
  return geometry;
}

std::vector<glm::dmat4> skin_transforms(const PrimitiveGeometry& geometry,
                                        std::span<const glm::dmat4> world_from_bind) {
  std::vector<glm::dmat4> transforms;
  transforms.reserve(geometry.positions.size());
  for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
    glm::dmat4 blend(0.0);
    double total = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double weight = geometry.weights[v][i];
      if (!(weight > 0.0) || !std::isfinite(weight)) continue;
      const std::uint32_t joint = geometry.joints[v][static_cast<std::size_t>(i)];
      blend += world_from_bind[joint < world_from_bind.size() ? joint : 0] * weight;
      total += weight;
    }
    transforms.push_back(total > 0.0 ? blend / total : world_from_bind[0]);
  }
  return transforms;
}

}  // namespace gltf_radiosity
