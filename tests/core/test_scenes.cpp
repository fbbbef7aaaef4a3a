#include "tests/core/test_scenes.h"

#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <tuple>
#include <utility>

namespace radiosity::test {
namespace {

using Quad = std::array<glm::vec3, 4>;

/// Adds two triangles (a,b,c) and (a,c,d) on four vertices of their own, shaded flat.
void add_quad(Scene& scene, const Quad& corners, std::uint32_t surface) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  for (const glm::vec3& corner : corners) {
    scene.positions.push_back(corner);
    scene.normals.push_back(normal);
  }
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene.triangles.emplace_back(first, first + 2, first + 3);
  scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), 2, surface);
}

/// The walls of the box from `low` to `high`, wound to face inward.
std::array<Quad, 6> walls_of(const glm::vec3& low, const glm::vec3& high) {
  const auto corner = [&](int x, int y, int z) {
    return glm::vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  return {{
      {corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1)},  // -x
      {corner(1, 0, 0), corner(1, 0, 1), corner(1, 1, 1), corner(1, 1, 0)},  // +x
      {corner(0, 0, 0), corner(0, 0, 1), corner(1, 0, 1), corner(1, 0, 0)},  // -y
      {corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1)},  // +y
      {corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)},  // -z
      {corner(0, 0, 1), corner(0, 1, 1), corner(1, 1, 1), corner(1, 0, 1)},  // +z
  }};
}

/// Adds a closed box seen from outside.
void add_solid_box(Scene& scene, const glm::vec3& low, const glm::vec3& high, std::uint32_t surface) {
  for (const Quad& wall : walls_of(low, high)) {
    add_quad(scene, {wall[0], wall[3], wall[2], wall[1]}, surface);
  }
}

/// A horizontal square centred on the y axis, facing up or down.
Quad level_square(float width, float y, bool faces_up) {
  const float h = 0.5F * width;
  const Quad up = {{{-h, y, -h}, {-h, y, h}, {h, y, h}, {h, y, -h}}};
  return faces_up ? up : Quad{up[3], up[2], up[1], up[0]};
}

/// A block standing on the floor: its top, counter-clockwise from above, and the four sides below the edges of the top.
void add_block(Scene& scene, const Quad& top, std::uint32_t surface) {
  add_quad(scene, top, surface);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec3 a = top[i];
    const glm::vec3 b = top[(i + 1) % 4];
    add_quad(scene, {{a, {a.x, 0.0F, a.z}, {b.x, 0.0F, b.z}, b}}, surface);
  }
}

Surface matte(const Rgb& reflectance) { return {.reflectance = reflectance}; }

Surface lamp(const Rgb& luminance, const Rgb& reflectance) {
  return {.reflectance = reflectance, .emission = luminance};
}

/// Stripes across x, told from the position of a point.
class Stripes final : public SurfaceDetail {
 public:
  Stripes(Scene scene, float width) : scene_(std::move(scene)), width_(width) {}

  Rgb reflectance(std::uint32_t triangle, const SubTriangle& /*part*/) const override {
    return scene_.surfaces[scene_.surface_of_triangle[triangle]].reflectance;
  }
  Rgb emission(std::uint32_t triangle, const SubTriangle& /*part*/) const override {
    return scene_.surfaces[scene_.surface_of_triangle[triangle]].emission;
  }
  float opacity(std::uint32_t triangle, Barycentrics at) const override {
    const float stripe = std::floor(point_at(scene_, triangle, at).x / width_);
    return std::fmod(stripe, 2.0F) == 0.0F ? 1.0F : 0.0F;
  }

 private:
  Scene scene_;
  float width_;
};

/// Makes the vertices of a tessellation, each once.
class Tessellation {
 public:
  Tessellation(const Scene& scene, int n) : scene_(scene), n_(n), result_(scene) {}

  /// The vertex `step` n-ths of the way from `a` to `b`, shared by all triangles on that edge.
  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, int step) {
    if (step == 0 || a == b) {
      return a;
    }
    if (step == n_) {
      return b;
    }
    if (after(a, b)) {
      std::swap(a, b);
      step = n_ - step;
    }
    const auto [found, is_new] = edge_vertices_.try_emplace({a, b, step}, next_vertex());
    if (is_new) {
      add(static_cast<float>(n_ - step), a, static_cast<float>(step), b, 0.0F, b);
    }
    return found->second;
  }

  /// The vertex i n-ths towards corner 1 and j n-ths towards corner 2.
  std::uint32_t vertex(const glm::uvec3& corners, int i, int j) {
    if (j == 0) {
      return on_edge(corners.x, corners.y, i);
    }
    if (i == 0) {
      return on_edge(corners.x, corners.z, j);
    }
    if (i + j == n_) {
      return on_edge(corners.y, corners.z, j);
    }
    const std::uint32_t made = next_vertex();
    add(static_cast<float>(n_ - i - j), corners.x, static_cast<float>(i), corners.y, static_cast<float>(j), corners.z);
    return made;
  }

  Scene& result() { return result_; }

 private:
  /// Both copies of a seam walk the edge in one direction, so their vertices meet exactly.
  bool after(std::uint32_t a, std::uint32_t b) const {
    const auto key = [this](std::uint32_t v) {
      return std::tuple(scene_.positions[v].x, scene_.positions[v].y, scene_.positions[v].z, v);
    };
    return key(a) > key(b);
  }
  std::uint32_t next_vertex() const { return static_cast<std::uint32_t>(result_.positions.size()); }
  void add(float weight_a, std::uint32_t a, float weight_b, std::uint32_t b, float weight_c, std::uint32_t c) {
    const auto mix = [&](const std::vector<glm::vec3>& of) {
      return (of[a] * weight_a + of[b] * weight_b + of[c] * weight_c) / static_cast<float>(n_);
    };
    const glm::vec3 normal = mix(scene_.normals);
    const float length = glm::length(normal);
    result_.positions.push_back(mix(scene_.positions));
    result_.normals.push_back(length > 0.0F ? normal / length : normal);
  }

  const Scene& scene_;
  int n_;
  Scene result_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, int>, std::uint32_t> edge_vertices_;
};

}  // namespace

Scene box_room(const glm::vec3& size, const Surface& surface) {
  Scene scene;
  scene.surfaces = {surface};
  for (const Quad& wall : walls_of(glm::vec3(0.0F), size)) {
    add_quad(scene, wall, 0);
  }
  return scene;
}

Scene unit_cube_faces() {
  Scene scene;
  scene.surfaces.assign(6, matte(Rgb(0.2F)));
  std::uint32_t surface = 0;
  for (const Quad& wall : walls_of(glm::vec3(0.0F), glm::vec3(1.0F))) {
    add_quad(scene, wall, surface++);
  }
  return scene;
}

Scene parallel_squares(float distance) {
  Scene scene;
  scene.surfaces = {lamp(Rgb(1.0F), Rgb(0.0F)), matte(Rgb(0.5F))};
  add_quad(scene, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 0);
  add_quad(scene, {{{0, 0, distance}, {0, 1, distance}, {1, 1, distance}, {1, 0, distance}}}, 1);
  return scene;
}

Scene perpendicular_squares() {
  Scene scene;
  scene.surfaces = {lamp(Rgb(1.0F), Rgb(0.0F)), matte(Rgb(0.5F))};
  add_quad(scene, {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}}, 0);
  add_quad(scene, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 1);
  return scene;
}

Scene cornell_box() {
  const Rgb white(0.725F, 0.71F, 0.68F);
  Scene scene;
  scene.surfaces = {matte(white), matte({0.63F, 0.065F, 0.05F}), matte({0.14F, 0.45F, 0.091F}),
                    lamp({17.0F, 12.0F, 4.0F}, Rgb(0.78F))};

  // The walls are not quite square: the room was measured.
  add_quad(scene, {{{0.5528F, 0, 0}, {0, 0, 0}, {0, 0, 0.5592F}, {0.5496F, 0, 0.5592F}}}, 0);
  add_quad(scene, {{{0.556F, 0.5488F, 0}, {0.556F, 0.5488F, 0.5592F}, {0, 0.5488F, 0.5592F}, {0, 0.5488F, 0}}}, 0);
  add_quad(scene, {{{0.5496F, 0, 0.5592F}, {0, 0, 0.5592F}, {0, 0.5488F, 0.5592F}, {0.556F, 0.5488F, 0.5592F}}}, 0);
  add_quad(scene, {{{0, 0, 0.5592F}, {0, 0, 0}, {0, 0.5488F, 0}, {0, 0.5488F, 0.5592F}}}, 2);
  add_quad(scene, {{{0.5528F, 0, 0}, {0.5496F, 0, 0.5592F}, {0.556F, 0.5488F, 0.5592F}, {0.556F, 0.5488F, 0}}}, 1);

  // The short and the tall block, and the lamp.
  add_block(scene,
            {{{0.13F, 0.165F, 0.065F}, {0.082F, 0.165F, 0.225F}, {0.24F, 0.165F, 0.272F}, {0.29F, 0.165F, 0.114F}}}, 0);
  add_block(scene,
            {{{0.423F, 0.33F, 0.247F}, {0.265F, 0.33F, 0.296F}, {0.314F, 0.33F, 0.456F}, {0.472F, 0.33F, 0.406F}}}, 0);
  add_quad(
      scene,
      {{{0.343F, 0.5478F, 0.227F}, {0.343F, 0.5478F, 0.332F}, {0.213F, 0.5478F, 0.332F}, {0.213F, 0.5478F, 0.227F}}},
      3);
  return scene;
}

Scene white_furnace(float rho, float luminance) { return box_room(glm::vec3(1.0F), lamp(Rgb(luminance), Rgb(rho))); }

Scene occluder() {
  Surface blocker = matte(Rgb(0.0F));
  blocker.two_sided = true;
  Scene scene;
  scene.surfaces = {matte(Rgb(0.5F)), blocker, lamp(Rgb(100.0F), Rgb(0.0F))};
  add_quad(scene, level_square(4.0F, 0.0F, true), 0);
  add_quad(scene, level_square(1.0F, 1.0F, true), 1);
  add_quad(scene, level_square(0.5F, 2.0F, false), 2);
  return scene;
}

Scene floor_only() {
  Scene scene = occluder();
  scene.triangles.resize(2);
  scene.surface_of_triangle.resize(2);
  scene.positions.resize(4);
  scene.normals.resize(4);
  return scene;
}

Scene solid_box() {
  Scene scene = box_room(glm::vec3(1.0F), {});
  for (glm::uvec3& triangle : scene.triangles) std::swap(triangle.y, triangle.z);
  for (glm::vec3& normal : scene.normals) normal = -normal;
  return scene;
}

Scene rooms_on_one_floor(float wall, float thickness) {
  Scene scene = box_room({2.0F, 1.0F, 1.0F}, matte(Rgb(0.7F)));
  const float right = wall + thickness;
  add_quad(scene, {{{wall, 0, 0}, {wall, 0, 1}, {wall, 1, 1}, {wall, 1, 0}}}, 0);
  add_quad(scene, {{{right, 0, 0}, {right, 1, 0}, {right, 1, 1}, {right, 0, 1}}}, 0);
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.5F * wall, 0.5F, 0.5F}}};
  return scene;
}

Scene sunk_box(float rho) {
  Scene scene = floor_only();
  scene.surfaces = {matte(Rgb(rho)), matte(Rgb(rho))};
  add_solid_box(scene, {-0.37F, -0.5F, -0.71F}, {0.63F, 0.5F, 0.29F}, 1);
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = Rgb(10.0F)}};
  return scene;
}

Scene wall_through_floor(float rho) {
  Scene scene = floor_only();
  scene.surfaces = {matte(Rgb(rho)), matte(Rgb(rho))};
  scene.surfaces[1].two_sided = true;
  const float x = 0.13F;
  add_quad(scene, {{{x, -0.5F, 2}, {x, -0.5F, -2}, {x, 0.5F, -2}, {x, 0.5F, 2}}}, 1);
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = Rgb(10.0F)}};
  return scene;
}

Scene panel_before_wall(float gap) {
  Scene scene;
  scene.surfaces = {matte(Rgb(0.5F)), matte(Rgb(0.5F))};
  add_quad(scene, {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, 0);
  const float h = 0.25F;
  add_quad(scene, {{{-h, -h, gap}, {h, -h, gap}, {h, h, gap}, {-h, h, gap}}}, 1);
  return scene;
}

Scene many_boxes(int count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  const auto random = [&generator](float low, float high) {
    return low + (high - low) * static_cast<float>(static_cast<double>(generator()) / 4294967296.0);
  };
  Scene scene = box_room({10.0F, 4.0F, 10.0F}, matte(Rgb(0.7F)));
  scene.surfaces.push_back(matte({0.6F, 0.3F, 0.2F}));
  scene.surfaces.push_back(lamp(Rgb(1000.0F), Rgb(0.0F)));
  add_quad(scene, {{{6, 3.9F, 4}, {6, 3.9F, 6}, {4, 3.9F, 6}, {4, 3.9F, 4}}}, 2);
  for (int i = 0; i < count; ++i) {
    const glm::vec3 middle(random(1.5F, 8.5F), random(0.5F, 3.0F), random(1.5F, 8.5F));
    const float half_width = random(0.1F, 0.8F);
    const float angle = random(0.0F, 1.5F);
    const glm::vec3 u = half_width * glm::vec3(std::cos(angle), 0.0F, -std::sin(angle));
    const glm::vec3 v = random(0.1F, 0.8F) * glm::vec3(std::sin(angle), 0.0F, std::cos(angle));
    add_block(scene, {{middle - u - v, middle - u + v, middle + u + v, middle + u - v}}, 1);
  }
  return scene;
}

DetailedScene see_through_fence() {
  Scene scene = occluder();
  scene.surfaces[1].see_through = true;
  auto stripes = std::make_unique<Stripes>(scene, 0.125F);
  scene.detail = stripes.get();
  return {.detail = std::move(stripes), .scene = std::move(scene)};
}

Scene tessellated(const Scene& scene, int n) {
  assert(n >= 1);
  Tessellation tessellation(scene, n);
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> surface_of_triangle;
  std::vector<std::uint32_t> grid(static_cast<std::size_t>((n + 1) * (n + 1)));
  const auto at = [&](int i, int j) -> std::uint32_t& { return grid[static_cast<std::size_t>(j * (n + 1) + i)]; };

  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i + j <= n; ++i) {
        at(i, j) = tessellation.vertex(scene.triangles[t], i, j);
      }
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i + j < n; ++i) {
        triangles.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) {
          triangles.emplace_back(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
    }
    surface_of_triangle.insert(surface_of_triangle.end(), static_cast<std::size_t>(n * n),
                               scene.surface_of_triangle[t]);
  }
  Scene result = std::move(tessellation.result());
  result.triangles = std::move(triangles);
  result.surface_of_triangle = std::move(surface_of_triangle);
  return result;
}

}  // namespace radiosity::test
