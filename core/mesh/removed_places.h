// Vertices that were removed, each with the element that now shows the surface at its place, and how well it does.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/carried.h"
#include "core/mesh/refined_mesh.h"
#include "core/scene.h"

namespace radiosity {

/// A place on the mesh as it was: a vertex (twice the same), or the middle between the two ends of an edge.
using Place = glm::uvec2;

/// An element as it would be, prepared for looking up places.
class Stand {
 public:
  /// REQUIRES: area.
  Stand(const RefinedMesh& mesh, const glm::uvec3& corners);

  /// The weights of the corners at the point nearest to `at` in the plane of the element; all positive inside.
  glm::dvec3 weights_at(const glm::dvec3& at) const;

  const glm::uvec3& corners() const { return corners_; }

 private:
  glm::uvec3 corners_;
  glm::dvec3 origin_, u_, v_;
  double uu_ = 0.0, uv_ = 0.0, vv_ = 0.0, area_ = 0.0;  ///< the last one squared, fourfold
};

/// Compares what the mesh showed with what elements would show. Thread-safe.
class Deviation {
 public:
  /// Both must outlive it.
  Deviation(const RefinedMesh& mesh, const Carried& carried) : mesh_(mesh), carried_(carried) {}

  /// Which of `stands` shows a place, and with which weights of its corners. REQUIRES: at least one.
  struct Found {
    std::size_t stand = 0;
    glm::vec3 weights{0.0F};
  };
  Found find(const Place& place, std::span<const Stand> stands) const;

  /// How far what is shown differs from what was, in units of what is allowed: shape, light and values, the largest of
  /// them. What is no number is infinitely far. May stop early with anything above `limit`.
  float of(const Place& place, const glm::uvec3& corners, const glm::vec3& weights, float limit) const;

  /// By how much the luminance differs.
  double of_luminance(const Place& place, const glm::uvec3& corners, const glm::vec3& weights) const;

 private:
  Rgb light_change(const Place& place, const glm::uvec3& corners, const glm::vec3& weights) const;

  const RefinedMesh& mesh_;
  const Carried& carried_;
};

/// Removed vertices, listed by element.
class RemovedPlaces {
 public:
  explicit RemovedPlaces(std::size_t element_count) : first_of_element_(element_count, kNothing) {}

  /// Whether `holds(vertex)` is true of each vertex that an element stands for; not asked any more once it is not.
  template <typename Predicate>
  bool all_of(std::uint32_t element, const Predicate& holds) const {
    for (std::uint32_t i = first_of_element_[element]; i != kNothing; i = removed_[i].next) {
      if (!holds(removed_[i].place)) return false;
    }
    return true;
  }

  void add(std::uint32_t element, const Place& place) {
    removed_.push_back({place, first_of_element_[element]});
    first_of_element_[element] = static_cast<std::uint32_t>(removed_.size() - 1);
  }

  /// Empties the lists of some elements, each given with a hint, and hands each vertex in them to the element that
  /// `holder(hint, vertex)` answers.
  template <typename Hint, typename Holder>
  void deal(const std::vector<std::pair<std::uint32_t, Hint>>& elements, const Holder& holder);

 private:
  struct Removed {
    Place place{0};
    std::uint32_t next = kNothing;
  };
  std::vector<std::uint32_t> first_of_element_;
  std::vector<Removed> removed_;
};

template <typename Hint, typename Holder>
void RemovedPlaces::deal(const std::vector<std::pair<std::uint32_t, Hint>>& elements, const Holder& holder) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> entries;  // and their elements from now on
  for (const auto& [element, hint] : elements) {
    for (std::uint32_t i = first_of_element_[element]; i != kNothing; i = removed_[i].next) {
      entries.emplace_back(i, holder(hint, removed_[i].place));
    }
    first_of_element_[element] = kNothing;
  }
  for (const auto& [entry, element] : entries) {
    removed_[entry].next = first_of_element_[element];
    first_of_element_[element] = entry;
  }
}

}  // namespace radiosity
