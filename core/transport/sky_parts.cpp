#include "core/transport/sky_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/parallel.h"
#include "core/photometry.h"

namespace radiosity {
namespace {

constexpr double kSphere = 4.0 * double{kPi};

/// Rows of the finest grid that groups are made of: a sun, half a degree wide, falls into one to four of its cells.
constexpr int kGroupRows = 256;

std::span<const Rgb> row_of(const Sky& sky, int row) {
  const auto width = static_cast<std::size_t>(sky.width);
  return std::span(sky.map).subspan(static_cast<std::size_t>(row) * width, width);
}

/// The part of a texel below the limit.
Rgb smooth_part(const Rgb& luminance, float limit) {
  const float bright = luminance_of(luminance);
  return bright > limit ? luminance * (limit / bright) : luminance;
}

/// Mean over the sphere of the eye-weighted luminance up to a limit.
double mean_below(const Sky& sky, double limit) {
  std::vector<double> row_sum(static_cast<std::size_t>(sky.height));
  in_parallel(0, row_sum.size(), [&](std::size_t k) {
    const int row = static_cast<int>(k);
    double sum = 0.0;
    for (const Rgb& texel : row_of(sky, row)) sum += std::min(double{luminance_of(texel)}, limit);
    row_sum[k] = sum * texel_solid_angle(sky, row);
  });
  return std::accumulate(row_sum.begin(), row_sum.end(), 0.0) / kSphere;
}

//     -1   row   1      The face a direction leaves the cube by: the axis of its largest component, and its sign.
//   1 +-----------+     Row and column are the other two components, in their cyclic order after that axis.
//     |           |
// column          |
//     |           |
//  -1 +-----------+
std::size_t cube_cell(const glm::vec3& direction, int resolution) {
  const glm::vec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int next = axis == 2 ? 0 : axis + 1, last = axis == 0 ? 2 : axis - 1;
  const float scale = 0.5F * static_cast<float>(resolution), distance = size[axis];
  const int row = std::clamp(static_cast<int>((direction[next] / distance + 1.0F) * scale), 0, resolution - 1);
  const int column = std::clamp(static_cast<int>((direction[last] / distance + 1.0F) * scale), 0, resolution - 1);
  const int face = 2 * axis + (direction[axis] < 0.0F ? 1 : 0);
  return static_cast<std::size_t>((face * resolution + row) * resolution + column);
}

/// Cosines and sines of evenly spread longitudes from -x on, `cuts` in each column.
std::vector<glm::vec2> longitudes(const Sky& sky, int cuts) {
  std::vector<glm::vec2> circle(static_cast<std::size_t>(sky.width) * static_cast<std::size_t>(cuts));
  for (std::size_t k = 0; k < circle.size(); ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(circle.size());
    const double longitude = 2.0 * double{kPi} * (share - 0.5);
    circle[k] = {std::cos(longitude), std::sin(longitude)};
  }
  return circle;
}

/// Averages of the map over the cells of a cube, each texel at so many places that no cell goes without.
std::vector<Rgb> average_over_cube(const Sky& sky, int resolution, float limit) {
  constexpr int kPlacesAcrossCell = 8;
  const int coarsest = std::min(sky.height, (sky.width + 1) / 2);
  const int cuts = (kPlacesAcrossCell * 2 * resolution + coarsest - 1) / coarsest;
  const std::vector<glm::vec2> circle = longitudes(sky, cuts);
  const glm::mat3 world_from_map = glm::transpose(sky.map_from_world);
  const auto count = static_cast<std::size_t>(6 * resolution * resolution);
  std::vector<glm::dvec3> sum(count, glm::dvec3(0.0));
  std::vector<double> weight(count, 0.0);
  for (int k = 0; k < sky.height * cuts; ++k) {
    const std::span<const Rgb> row = row_of(sky, k / cuts);
    const double weight_here = texel_solid_angle(sky, k / cuts) / (static_cast<double>(cuts) * cuts);
    const double latitude = double{kPi} * (0.5 - (k + 0.5) / (static_cast<double>(sky.height) * cuts));
    const auto level = static_cast<float>(std::cos(latitude)), y = static_cast<float>(std::sin(latitude));
    for (std::size_t m = 0; m < circle.size(); ++m) {
      const glm::vec3 direction = world_from_map * glm::vec3(level * circle[m].x, y, level * circle[m].y);
      const std::size_t cell = cube_cell(direction, resolution);
      sum[cell] += weight_here * glm::dvec3(smooth_part(row[m / static_cast<std::size_t>(cuts)], limit));
      weight[cell] += weight_here;
    }
  }
  std::vector<Rgb> mean(count);
  for (std::size_t cell = 0; cell < count; ++cell) mean[cell] = Rgb(sum[cell] / weight[cell]);
  return mean;
}

}  // namespace

float bright_limit(const Sky& sky) {
  // Where so little is lit that its multiple is below any limit, the limit is 0.
  constexpr double kLeast = std::numeric_limits<float>::min();
  const double lit_share = mean_below(sky, kLeast) / kLeast;
  if (kBrightness * lit_share <= 1.0) return 0.0F;

  // From above towards the one limit that is kBrightness times its own mean.
  constexpr int kSteps = 64;
  constexpr double kNear = 0.01;
  double limit = kBrightness * mean_below(sky, std::numeric_limits<double>::infinity());
  for (int step = 0; step < kSteps; ++step) {
    const double next = kBrightness * mean_below(sky, limit);
    if (next > (1.0 - kNear) * limit) break;
    limit = next;
  }
  return static_cast<float>(limit);
}

SmoothSky::SmoothSky(const Sky& sky, int resolution) : constant_(sky.luminance), resolution_(resolution) {
  if (sky.has_map()) cells_ = average_over_cube(sky, resolution, bright_limit(sky));
}

bool SmoothSky::is_black() const {
  const auto black = [](const Rgb& luminance) { return !(luminance_of(luminance) > 0.0F); };
  return is_constant() ? black(constant_) : std::all_of(cells_.begin(), cells_.end(), black);
}

std::size_t SmoothSky::cell_at(const glm::vec3& direction) const { return cube_cell(direction, resolution_); }

BrightSky::BrightSky(const Sky& sky) : sky_(sky) {
  if (!sky.has_map()) return;
  const float limit = bright_limit(sky);
  for (std::uint32_t texel = 0; texel < sky.map.size(); ++texel) {
    if (luminance_of(sky.map[texel]) > limit) texels_.push_back(texel);
  }

  // Grouped by the cells of the finest grid of rows and columns that makes few enough groups.
  int rows = kGroupRows;
  do {
    group_texels(rows, limit);
    rows /= 2;
  } while (groups_.size() > kMaxSkyGroups);
}

void BrightSky::group_texels(int rows, float limit) {
  const auto width = static_cast<std::uint32_t>(sky_.width);
  const auto tall = static_cast<std::uint32_t>((sky_.height + rows - 1) / rows);
  const auto wide = static_cast<std::uint32_t>((sky_.width + 2 * rows - 1) / (2 * rows));
  const auto cell_of = [=](std::uint32_t texel) { return texel / width / tall * width + texel % width / wide; };
  std::stable_sort(texels_.begin(), texels_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return cell_of(a) < cell_of(b); });
  groups_.clear();
  illuminance_until_.clear();
  for (std::uint32_t first = 0; first < texels_.size();) {
    std::uint32_t last = first;
    while (last < texels_.size() && cell_of(texels_[last]) == cell_of(texels_[first])) ++last;
    add_group(first, last - first, limit);
    first = last;
  }
}

void BrightSky::add_group(std::uint32_t first, std::uint32_t count, float limit) {
  glm::dvec3 illuminance(0.0), direction(0.0);
  double bright = 0.0;
  for (std::uint32_t k = first; k < first + count; ++k) {
    const std::uint32_t texel = texels_[k];
    const Rgb excess = sky_.map[texel] - smooth_part(sky_.map[texel], limit);
    const double angle = texel_solid_angle(sky_, static_cast<int>(texel / static_cast<std::uint32_t>(sky_.width)));
    illuminance += angle * glm::dvec3(excess);
    direction += double{luminance_of(excess)} * texel_vector(sky_, texel);
    bright += double{luminance_of(excess)} * angle;
    illuminance_until_.push_back(bright);
  }
  groups_.push_back({first, count, Rgb(illuminance), glm::vec3(direction / bright)});
}

Rgb BrightSky::illuminance() const {
  glm::dvec3 sum(0.0);
  for (const Group& group : groups_) sum += glm::dvec3(group.illuminance);
  return Rgb(sum);
}

double BrightSky::weigh(const glm::vec3& normal, std::vector<double>& until) const {
  until.clear();
  double total = 0.0;
  for (const Group& group : groups_) {
    total += std::max(0.0, double{glm::dot(normal, group.direction)}) * double{luminance_of(group.illuminance)};
    until.push_back(total);
  }
  return total;
}

ChosenDirection BrightSky::choose(std::span<const double> until, double along, const glm::vec2& place) const {
  // The group at this place of the sum of weights.
  const double wanted = along * until.back();
  auto found = std::upper_bound(until.begin(), until.end(), wanted);
  if (found == until.end()) found = std::lower_bound(until.begin(), until.end(), until.back());
  const double before = found == until.begin() ? 0.0 : *std::prev(found);
  const Group& group = groups_[static_cast<std::size_t>(found - until.begin())];

  // Within the group, what is left of the place picks a texel by its light.
  const auto first = illuminance_until_.begin() + group.first, last = first + group.count;
  const double left = (wanted - before) / (*found - before) * *(last - 1);
  const auto texel = std::min(std::upper_bound(first, last, left), last - 1) - illuminance_until_.begin();
  return {direction_in_texel(sky_, texels_[static_cast<std::size_t>(texel)], place),
          group.illuminance * static_cast<float>(until.back() / double{luminance_of(group.illuminance)})};
}

}  // namespace radiosity
