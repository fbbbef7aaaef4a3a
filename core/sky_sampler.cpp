#include "core/sky_sampler.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "core/photometry.h"

namespace radiosity {
namespace {

constexpr float kUniformPdf = 1.0F / (4.0F * kPi);

/// The last number below 1: what is left of a place may not reach the next texel.
constexpr float kBelowOne = 0x1.fffffep-1F;

/// Which of the running shares holds `place`, and how far into its own share.
template <typename Share>
std::pair<std::size_t, float> pick(std::span<const Share> until, float place) {
  const auto wanted = static_cast<Share>(place);
  auto found = std::upper_bound(until.begin(), until.end(), wanted);
  if (found == until.end()) found = std::lower_bound(until.begin(), until.end(), until.back());
  const Share before = found == until.begin() ? Share{0} : *std::prev(found);
  const auto along = static_cast<float>((wanted - before) / (*found - before));
  return {static_cast<std::size_t>(found - until.begin()), std::clamp(along, 0.0F, kBelowOne)};
}

SkySample uniform_sample(const Rgb& luminance, const glm::vec2& place) {
  const float y = 1.0F - 2.0F * place.y, level = std::sqrt(std::max(0.0F, 1.0F - y * y));
  const float longitude = 2.0F * kPi * (place.x - 0.5F);
  return {{level * std::cos(longitude), y, level * std::sin(longitude)}, luminance, kUniformPdf};
}

}  // namespace

SkySampler::SkySampler(const Sky& sky) : sky_(sky) {
  if (!sky.has_map()) {
    total_ = 4.0 * double{kPi} * double{luminance_of(sky.luminance)};
    return;
  }
  const auto width = static_cast<std::size_t>(sky.width);
  texel_until_.resize(sky.map.size());
  std::vector<double> sum(width);
  for (int row = 0; row < sky.height; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * width;
    double row_sum = 0.0;
    for (std::size_t k = 0; k < width; ++k) sum[k] = row_sum += double{luminance_of(sky.map[first + k])};
    for (std::size_t k = 0; k < width; ++k) {
      texel_until_[first + k] = row_sum > 0.0 ? static_cast<float>(sum[k] / row_sum) : 0.0F;
    }
    total_ += row_sum * texel_solid_angle(sky, row);
    row_until_.push_back(total_);
  }
  if (is_black()) return;
  for (double& until : row_until_) until /= total_;
}

SkySample SkySampler::sample(const glm::vec2& place) const {
  if (is_black()) return {};
  if (!sky_.has_map()) return uniform_sample(sky_.luminance, place);
  const auto [row, down] = pick<double>(row_until_, place.y);
  const auto width = static_cast<std::size_t>(sky_.width);
  const auto [column, right] = pick<float>(std::span(texel_until_).subspan(row * width, width), place.x);
  const std::size_t texel = row * width + column;
  const auto pdf = static_cast<float>(double{luminance_of(sky_.map[texel])} / total_);
  return {direction_in_texel(sky_, texel, {right, down}), sky_.map[texel], pdf};
}

float SkySampler::pdf(const glm::vec3& direction) const {
  if (is_black()) return 0.0F;
  if (!sky_.has_map()) return kUniformPdf;
  return static_cast<float>(double{luminance_of(luminance_towards(sky_, direction))} / total_);
}

}  // namespace radiosity
