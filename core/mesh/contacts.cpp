#include "core/mesh/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "core/mesh/subdivide_uniform.h"
#include "core/parallel.h"
#include "core/visibility/hemicube.h"
#include "core/visibility/item_buffer_rays.h"
#include "core/visibility/single_ray.h"

namespace radiosity {
namespace {

/// What meets a surface at less than 10 degrees does not stand on it.
constexpr double kParallelCos = 0.985;

/// A side of a contact is buried if backs fill more of its view than this.
constexpr float kBuriedView = 0.3F;

/// In shares of the size of a patch, or its square: the smallest triangle and the shortest line, and how far beside it
/// light is looked at.
constexpr double kSmallestTriangle = 0.01, kShortestLine = 0.05, kBeside = 0.01;

using Corners = std::array<glm::dvec3, 3>;

Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const glm::uvec3& t = scene.triangles[triangle];
  return {glm::dvec3(scene.positions[t.x]), glm::dvec3(scene.positions[t.y]), glm::dvec3(scene.positions[t.z])};
}

/// A triangle as a plane with axes.
struct Plane {
  explicit Plane(const Corners& corners) : origin(corners[0]) {
    u = glm::normalize(corners[1] - corners[0]);
    normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    v = glm::cross(normal, u);
    for (std::size_t k = 0; k < 3; ++k) outline[k] = flat(corners[k]);
  }

  double height(const glm::dvec3& at) const { return glm::dot(at - origin, normal); }
  glm::dvec2 flat(const glm::dvec3& at) const { return {glm::dot(at - origin, u), glm::dot(at - origin, v)}; }
  glm::dvec3 lifted(const glm::dvec2& at) const { return origin + at.x * u + at.y * v; }

  glm::dvec3 origin, u{0.0}, v{0.0}, normal{0.0};
  std::array<glm::dvec2, 3> outline{};  ///< counter-clockwise
};

/// A stretch of a line in a plane.
struct Stretch {
  glm::dvec2 from, to;
};

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// The part of a stretch inside the outline, widened by `tolerance`.
std::optional<Stretch> clip(const Plane& plane, const Stretch& stretch, double tolerance) {
  double first = 0.0, last = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 a = plane.outline[k], along = glm::normalize(plane.outline[(k + 1) % 3] - a);
    const double inside_from = cross(along, stretch.from - a) + tolerance;
    const double inside_to = cross(along, stretch.to - a) + tolerance;
    if (inside_from < 0.0 && inside_to < 0.0) return std::nullopt;
    const double crossing = inside_from / (inside_from - inside_to);
    if (inside_from < 0.0) first = std::max(first, crossing);
    if (inside_to < 0.0) last = std::min(last, crossing);
  }
  if (first >= last) return std::nullopt;
  return Stretch{glm::mix(stretch.from, stretch.to, first), glm::mix(stretch.from, stretch.to, last)};
}

bool contains(const Plane& plane, const glm::dvec2& at) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (cross(plane.outline[(k + 1) % 3] - plane.outline[k], at - plane.outline[k]) < 0.0) return false;
  }
  return true;
}

/// Where a triangle that reaches above a plane starts from it; nothing if it does not touch it in a line.
std::optional<Stretch> start_on(const Plane& plane, const Corners& other, double tolerance) {
  std::array<double, 3> height{};
  for (std::size_t k = 0; k < 3; ++k) height[k] = plane.height(other[k]);
  if (*std::ranges::max_element(height) <= 4.0 * tolerance) return std::nullopt;

  // Corners on the plane, and edges through it.
  std::vector<glm::dvec2> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (std::abs(height[k]) <= tolerance) ends.push_back(plane.flat(other[k]));
    const bool passes = std::min(height[k], height[next]) < -tolerance && std::max(height[k], height[next]) > tolerance;
    if (passes) {
      ends.push_back(plane.flat(glm::mix(other[k], other[next], height[k] / (height[k] - height[next]))));
    }
  }
  if (ends.size() != 2 || glm::distance(ends[0], ends[1]) <= tolerance) return std::nullopt;
  return Stretch{ends[0], ends[1]};
}

/// Lengthens one of `lines` by a stretch that continues or covers it, or adds a line.
void join(std::vector<Stretch>& lines, const Stretch& stretch, double tolerance) {
  for (Stretch& line : lines) {
    const double length = glm::distance(line.from, line.to);
    const glm::dvec2 along = (line.to - line.from) / length;
    if (std::abs(cross(along, stretch.from - line.from)) > tolerance ||
        std::abs(cross(along, stretch.to - line.from)) > tolerance)
      continue;
    const auto [first, last] =
        std::minmax({glm::dot(along, stretch.from - line.from), glm::dot(along, stretch.to - line.from)});
    if (first > length + tolerance || last < -tolerance) continue;
    const glm::dvec2 from = line.from;
    if (first < 0.0) line.from = from + first * along;
    if (last > length) line.to = from + last * along;
    return;
  }
  lines.push_back(stretch);
}

bool share_an_edge(const Corners& a, const Corners& b) {
  const auto is_corner_of_b = [&b](const glm::dvec3& at) { return std::ranges::find(b, at) != b.end(); };
  return std::ranges::count_if(a, is_corner_of_b) >= 2;
}

class ContactFinder {
 public:
  ContactFinder(const RayScene& rays, const ContactOptions& options)
      : rays_(rays),
        scene_(rays.scene()),
        options_(options),
        patch_size_(options.patch_size),
        tolerance_(surface_offset(rays.scene())),
        items_(make_item_buffer_rays(rays)) {}

  std::vector<Contact> on(std::uint32_t triangle) const {
    std::vector<Contact> contacts;
    const auto& levels = options_.level_of_triangle;
    if (!levels.empty() && levels[triangle] != kLevelFromPatchSize) return contacts;
    const double area = 0.5 * double{glm::length(scaled_normal(scene_, triangle))};
    if (area < kSmallestTriangle * patch_size_ * patch_size_) return contacts;
    const Plane plane(corners_of(scene_, triangle));
    for (const Stretch& line : lines_on(triangle, plane)) {
      if (glm::distance(line.from, line.to) < kShortestLine * patch_size_) continue;
      const int showing = showing_sides(plane, line);
      if (showing > 0) contacts.push_back({triangle, plane.lifted(line.from), plane.lifted(line.to), showing == 2});
    }
    return contacts;
  }

 private:
  std::vector<Stretch> lines_on(std::uint32_t triangle, const Plane& plane) const {
    const Corners corners = corners_of(scene_, triangle);
    const glm::dvec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    double radius = 0.0;
    for (const glm::dvec3& corner : corners) radius = std::max(radius, glm::distance(centre, corner));

    std::vector<Stretch> lines;
    for (const std::uint32_t other : triangles_near(rays_, glm::vec3(centre), static_cast<float>(radius))) {
      if (other == triangle || scene_.surfaces[scene_.surface_of_triangle[other]].see_through) continue;
      const Corners others = corners_of(scene_, other);
      const glm::dvec3 scaled = glm::cross(others[1] - others[0], others[2] - others[0]);
      if (std::abs(glm::dot(scaled, plane.normal)) >= kParallelCos * glm::length(scaled)) continue;
      if (share_an_edge(corners, others)) continue;
      const std::optional<Stretch> whole = start_on(plane, others, tolerance_);
      const std::optional<Stretch> inside = whole ? clip(plane, *whole, tolerance_) : std::nullopt;
      if (inside && glm::distance(inside->from, inside->to) > tolerance_) join(lines, *inside, 4.0 * tolerance_);
    }
    return lines;
  }

  /// How many of the two sides of a line show, as far as it parts what shows; otherwise 0. A buried side parts if
  /// something shows beyond it within the size of a patch.
  int showing_sides(const Plane& plane, const Stretch& line) const {
    const glm::dvec2 along = glm::normalize(line.to - line.from), across(-along.y, along.x);
    const double beside = std::max(4.0 * tolerance_, kBeside * patch_size_);
    int most = 0;
    for (const double at : {0.5, 0.2, 0.8}) {
      const glm::dvec2 middle = glm::mix(line.from, line.to, at);
      std::array<bool, 2> side{}, farther{};
      for (std::size_t k = 0; k < 2; ++k) {
        const glm::dvec2 away = k == 0 ? across : -across;
        side[k] = shows(plane, middle + beside * away);
        for (const double distance : {0.25, 0.5, 0.75, 1.0}) {
          const glm::dvec2 there = middle + distance * patch_size_ * away;
          farther[k] = farther[k] || (!side[k] && contains(plane, there) && shows(plane, there));
        }
      }
      if (side[0] && side[1]) return 2;
      if ((side[0] && farther[1]) || (side[1] && farther[0])) most = 1;
    }
    return most;
  }

  bool shows(const Plane& plane, const glm::dvec2& at) const {
    thread_local ItemBuffer buffer;
    static const Hemicube narrow(4);
    const glm::dvec3 lifted = plane.lifted(at) + tolerance_ * plane.normal;
    items_->fill(narrow, {glm::vec3(lifted), glm::vec3(plane.normal), 0.0F}, buffer);
    float back_share = 0.0F;
    for (std::size_t c = 0; c < buffer.triangle.size(); ++c) {
      if (buffer.triangle[c] == kNothing || buffer.back[c] == 0) continue;
      const Surface& surface = scene_.surfaces[scene_.surface_of_triangle[buffer.triangle[c]]];
      if (!surface.two_sided) back_share += narrow.delta_form_factors()[c];
    }
    return back_share <= kBuriedView;
  }

  const RayScene& rays_;
  const Scene& scene_;
  ContactOptions options_;
  double patch_size_, tolerance_;
  std::unique_ptr<ItemBufferMaker> items_;
};

}  // namespace

std::vector<Contact> find_contacts(const RayScene& rays, const ContactOptions& options, const Progress& progress) {
  const ContactFinder finder(rays, options);
  std::vector<std::vector<Contact>> of_triangle(rays.scene().triangles.size());
  parallel_in_chunks(of_triangle.size(), 4096, progress, "subdivide", [&](std::size_t triangle) {
    of_triangle[triangle] = finder.on(static_cast<std::uint32_t>(triangle));
  });
  std::vector<Contact> contacts;
  for (const std::vector<Contact>& found : of_triangle) contacts.insert(contacts.end(), found.begin(), found.end());
  return contacts;
}

}  // namespace radiosity
