#include "core/reconstruct/exposure.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace radiosity {
namespace {

constexpr double kPercentile = 0.99;
constexpr float kDarkest = 0.25F, kBrightest = 1.0F, kWanted = 0.9F;

float brightest_band(const Rgb& luminance) { return std::max({luminance.x, luminance.y, luminance.z}); }

}  // namespace

float automatic_exposure(std::span<const ExposureSample> samples) {
  // The percentile of what is not a lamp, by area.
  std::vector<std::pair<float, float>> by_luminance;
  double total_area = 0.0;
  for (const ExposureSample& sample : samples) {
    if (sample.lamp || !(sample.area > 0.0F)) continue;
    by_luminance.emplace_back(brightest_band(sample.luminance), sample.area);
    total_area += double{sample.area};
  }
  std::sort(by_luminance.begin(), by_luminance.end());
  double area = 0.0;
  float percentile = 0.0F;
  for (const auto& [luminance, share] : by_luminance) {
    area += double{share};
    percentile = luminance;
    if (area >= kPercentile * total_area) break;
  }

  if (percentile >= kDarkest && percentile <= kBrightest) return 1.0F;
  return percentile > 0.0F ? kWanted / percentile : 1.0F;
}

float exposure_from_ev100(float ev100) { return 1.0F / (1.2F * std::exp2(ev100)); }

float clipped_share(std::span<const ExposureSample> samples, float k) {
  double clipped = 0.0, total = 0.0;
  for (const ExposureSample& sample : samples) {
    total += double{sample.area};
    if (k * brightest_band(sample.luminance) > 1.0F) clipped += double{sample.area};
  }
  return total > 0.0 ? static_cast<float>(clipped / total) : 0.0F;
}

}  // namespace radiosity
