#include "core/reconstruct/smooth_groups.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "core/mesh/weld.h"

namespace radiosity {
namespace {

constexpr float kSmoothCos = 0.9659258F;  // 15 degrees

std::vector<glm::vec3> vertex_normals(const RefinedMesh& mesh) {
  std::vector<glm::vec3> normals = mesh.normals;
  std::vector<glm::vec3> mean(normals.size(), glm::vec3(0.0F));
  for (const glm::uvec3& e : mesh.elements) {
    const glm::vec3 scaled =
        glm::cross(mesh.positions[e.y] - mesh.positions[e.x], mesh.positions[e.z] - mesh.positions[e.x]);
    for (int k = 0; k < 3; ++k) mean[e[k]] += scaled;
  }
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const float length = glm::length(mean[v]);
    if (glm::dot(normals[v], normals[v]) < 0.25F && length > 0.0F) normals[v] = mean[v] / length;
  }
  return normals;
}

}  // namespace

SmoothGroups find_smooth_groups(const RefinedMesh& mesh) {
  const Weld welded = weld(mesh.positions);
  const std::vector<glm::vec3> normals = vertex_normals(mesh);

  // Within a weld class a vertex joins the first group whose founder agrees; groups of a class form a chain.
  const auto agree = [&](std::uint32_t founder, std::uint32_t v) {
    return side_of(mesh, founder) == side_of(mesh, v) && glm::dot(normals[founder], normals[v]) >= kSmoothCos;
  };
  SmoothGroups groups;
  groups.group_of_vertex.resize(mesh.positions.size());
  std::vector<std::uint32_t> first_of_class(welded.class_count, kNothing), next_of_group, founder;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    std::uint32_t* link = &first_of_class[welded.class_of_vertex[v]];
    while (*link != kNothing && !agree(founder[*link], v)) link = &next_of_group[*link];
    if (*link == kNothing) {
      *link = groups.group_count;
      groups.group_of_vertex[v] = groups.group_count++;
      founder.push_back(v);
      next_of_group.push_back(kNothing);  // `link` may dangle from here on
    } else {
      groups.group_of_vertex[v] = *link;
    }
  }
  return groups;
}

void spread_to_unknown(const RefinedMesh& mesh, const SmoothGroups& groups, std::vector<std::uint8_t>& known,
                       std::vector<Rgb>& value) {
  std::vector<glm::vec4> sum(known.size());
  for (bool changed = true; changed;) {
    std::fill(sum.begin(), sum.end(), glm::vec4(0.0F));
    for (const glm::uvec3& element : mesh.elements) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t to = groups.group_of_vertex[element[k]],
                            from = groups.group_of_vertex[element[(k + 1) % 3]];
        if (known[to] == 0 && known[from] != 0) sum[to] += glm::vec4(value[from], 1.0F);
        if (known[from] == 0 && known[to] != 0) sum[from] += glm::vec4(value[to], 1.0F);
      }
    }
    changed = false;
    for (std::size_t g = 0; g < known.size(); ++g) {
      if (sum[g].w <= 0.0F) continue;
      value[g] = Rgb(sum[g]) / sum[g].w;
      known[g] = 1;
      changed = true;
    }
  }
}

}  // namespace radiosity
