// The world that light travels through: triangles, what they are made of, and what lights them.
//
// Everything is in world space and metres; light is three independent linear Rec. 709 bands. The scene is
// made once (plugin/import_scene.h makes it from glTF) and never changes while the light is computed.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rgb.h"
#include "core/sky.h"

namespace radiosity {

/// Marks "no triangle", "no patch", "no vertex".
inline constexpr std::uint32_t kNothing = 0xffffffffU;

/// Barycentric coordinates of a point in a triangle: the weights of its corners 1 and 2. Corner 0 weighs the rest.
using Barycentrics = glm::vec2;

/// A part of a triangle, by the barycentric coordinates of its corners in the whole triangle.
struct SubTriangle {
  Barycentrics corner[3] = {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}};
};

/// How a material takes part in the exchange of diffuse light.
struct Surface {
  Rgb reflectance{0.5F};  ///< rho, share of light leaving again, [0,1]; the solvers keep it below kMaxReflectance
  /// Le, luminance the surface shows by itself, cd/m2. Where it varies: what the whole is in proportion to, band by
  /// band, or nothing if that is not known.
  Rgb emission{0.0F};
  bool two_sided = false;         ///< receives, reflects and emits on both sides; otherwise the back only blocks
  bool varies = false;            ///< reflectance or emission change over the surface: ask Scene::detail
  bool see_through = false;       ///< not everywhere opaque: ask Scene::detail for the opacity at each hit
  std::uint32_t light_group = 0;  ///< that its emission belongs to
  Rgb undyed_reflectance{1.0F};   ///< if its factor were white; unless it varies
};

/// The largest reflectance that light transport accepts: a closed room with more never grows dark.
inline constexpr float kMaxReflectance = 0.99F;

/// Answers for surfaces that vary from point to point (textures, vertex colours).
///
/// Thread-safe: every method may be called from several threads at once.
class SurfaceDetail {
 public:
  virtual ~SurfaceDetail() = default;

  /// Mean reflectance over a part of `triangle`, unitless.
  virtual Rgb reflectance(std::uint32_t triangle, const SubTriangle& part) const = 0;
  /// The same if the factor of the surface were white: what its reflectance is in proportion to, band by band.
  virtual Rgb undyed_reflectance(std::uint32_t triangle, const SubTriangle& part) const {
    return reflectance(triangle, part);
  }
  /// Mean emitted luminance over a part of `triangle`, cd/m2.
  virtual Rgb emission(std::uint32_t triangle, const SubTriangle& part) const = 0;
  /// How opaque `triangle` is at a point: 0 lets all light pass, 1 none. An alpha mask answers 0 or 1.
  virtual float opacity(std::uint32_t triangle, Barycentrics at) const = 0;
};

/// A light without extent (KHR_lights_punctual).
struct Light {
  enum class Kind : std::uint8_t { kPoint, kSpot, kDirectional };
  Kind kind = Kind::kPoint;
  glm::vec3 position{0.0F};                ///< metres; unused by directional lights
  glm::vec3 direction{0.0F, 0.0F, -1.0F};  ///< unit, the way the light travels; unused by point lights
  Rgb intensity{1.0F};                     ///< candela for point and spot lights, lux for directional ones
  float range = 0.0F;                      ///< metres beyond which nothing arrives; 0 means no limit
  float inner_cone_cos = 1.0F;             ///< cosine of the angle up to which a spot is at full strength
  float outer_cone_cos = 0.70710678F;      ///< cosine of the angle where a spot ends
  std::uint32_t light_group = 0;
};

/// Shapes: `positions` and `normals` are [vertex_count]; `triangles` and `surface_of_triangle` are [triangle_count].
///
/// A vertex here is what glTF calls one: a position *and* its attributes. Vertices at one position that differ in
/// another attribute (a seam) are separate; mesh/weld.h finds them again.
struct Scene {
  std::vector<glm::vec3> positions;   ///< metres, finite
  std::vector<glm::vec3> normals;     ///< unit shading normals; zero where triangles are to be shaded flat
  std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from the front
  std::vector<std::uint32_t> surface_of_triangle;
  std::vector<Surface> surfaces;
  std::vector<Light> lights;
  Sky sky;  ///< what shows wherever nothing is hit
  /// What the light of each group is multiplied by, per band; ones if empty. What is dimmed to nothing still has a
  /// light of its own in Bake::group_irradiance.
  std::vector<Rgb> dimmers;
  const SurfaceDetail* detail = nullptr;  ///< not owned; needed if any surface `varies` or is `see_through`
};

/// Says what is wrong with a scene (an index out of range, a position that is not finite, ...), or nothing.
std::optional<std::string> validate(const Scene& scene);

/// As many as there are dimmers, or one more than the largest light group of a surface, a light or the sky.
std::uint32_t light_group_count(const Scene& scene);

/// Of a light group: by what its light is multiplied.
Rgb dimmer_of(const Scene& scene, std::uint32_t light_group);

/// Length of the bounding box's diagonal, metres; 0 for a scene without vertices.
float diagonal(const Scene& scene);

/// Distance below which two points count as one, metres: rays start and end this far off a surface.
float surface_offset(const Scene& scene);

/// Cross product of two edges of a triangle: along the geometric normal, twice the area long (m2).
glm::vec3 scaled_normal(const Scene& scene, std::uint32_t triangle);

/// The point of `triangle` at `at`, metres.
glm::vec3 point_at(const Scene& scene, std::uint32_t triangle, Barycentrics at);

/// Reflectance averaged over a part of a triangle, at most kMaxReflectance per band.
Rgb mean_reflectance(const Scene& scene, std::uint32_t triangle, const SubTriangle& part);

/// The same if the factor of the surface were white, without a limit.
Rgb undyed_reflectance(const Scene& scene, std::uint32_t triangle, const SubTriangle& part);

/// Emitted luminance averaged over a part of a triangle, before it is dimmed, cd/m2.
Rgb mean_emission(const Scene& scene, std::uint32_t triangle, const SubTriangle& part);

/// The same as it shows, dimmed.
Rgb shown_emission(const Scene& scene, std::uint32_t triangle, const SubTriangle& part);

/// How bright `emission`, a part of a surface's, is for the eye, were the surface's factor white: what decides on
/// shadow rays does not depend on how a lamp is coloured or dimmed.
float undyed_brightness(const Surface& surface, const Rgb& emission);

/// Luminance that the open sky shows in a direction (unit, away from the viewer), cd/m2: exact, a sun in it and all.
Rgb sky_luminance(const Scene& scene, const glm::vec3& direction);

/// Whether light passes through `triangle` at `at`. A partly opaque surface lets a ray through if its opacity is not
/// above the ray's `threshold`: spread thresholds evenly over [0,1) and (1 - opacity) of the rays pass.
bool lets_through(const Scene& scene, std::uint32_t triangle, Barycentrics at, float threshold);

}  // namespace radiosity
