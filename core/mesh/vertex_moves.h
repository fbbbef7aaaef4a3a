// Whether a vertex may move onto a neighbour, and what that would cost.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh/carried.h"
#include "core/mesh/collapse_net.h"
#include "core/mesh/refined_mesh.h"
#include "core/mesh/removed_places.h"
#include "core/mesh/weld.h"

namespace radiosity {

/// A vertex class, where it would go, and the cost: (0,1] is allowed.
struct VertexMove {
  std::uint32_t to = kNothing;  ///< kNothing: nowhere
  float cost = 0.0F;
};

/// The mesh while vertices are taken out of it.
class ShrinkingMesh {
 public:
  /// All must outlive it.
  ShrinkingMesh(const RefinedMesh& mesh, const Carried& carried);

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(fixed_.size()); }

  /// The cheapest move of a class that costs no more than `allowed`. May be asked from several threads.
  VertexMove best_move(std::uint32_t vertex, float allowed) const;

  /// Makes a move that best_move() found and nothing has come near since; fills in the vertices around. False where it
  /// would change what the surface is joined to. Not for several threads.
  bool make(std::uint32_t vertex, std::uint32_t to, std::vector<std::uint32_t>& around);

  /// Corners of each element, those that are gone name no vertex: kNothing.
  const std::vector<glm::uvec3>& elements() const { return elements_; }
  const RemovedPlaces& removed() const { return removed_; }

 private:
  struct Fan;
  struct Plan;
  Fan fan_of(std::uint32_t vertex) const;
  std::optional<Plan> plan_of(const Fan& fan, std::size_t along) const;
  /// The most that anything around changes; above `allowed` if it is too much.
  float cost_of(const Fan& fan, const Plan& plan, float allowed) const;
  void rewrite_elements(const Fan& fan, const Plan& plan, std::size_t along);

  const glm::vec3& position(std::uint32_t vertex) const { return mesh_.positions[first_of_class_[vertex]]; }
  double distance_from_line(std::uint32_t vertex, const glm::uvec2& ends) const;

  const RefinedMesh& mesh_;
  const Carried& carried_;
  Deviation deviation_;
  Weld welded_;
  std::vector<std::uint32_t> first_of_class_;
  std::vector<glm::uvec3> elements_;
  CollapseNet net_;
  std::vector<std::uint8_t> fixed_;     ///< [class_count]
  std::vector<float> line_error_;       ///< [edge_count]: how far the line was that an edge stands for, metres
  std::vector<std::uint8_t> is_whole_;  ///< [edge_count]: 1 where an edge is one of the mesh as it was
  float line_tolerance_ = 0.0F;
  RemovedPlaces removed_;
};

}  // namespace radiosity
