#include "core/reconstruct/group_light.h"

#include <algorithm>

#include "core/parallel.h"

namespace radiosity {
namespace {

/// One band at one vertex: parts that are dimmed by something are scaled so that they add up, or if none of them has
/// any light, get the same of it each.
void share_band(double whole, std::size_t vertex, int band, std::span<const Rgb> dimmers,
                std::vector<std::vector<Rgb>>& parts) {
  double sum = 0.0, lit_count = 0.0;
  for (std::size_t g = 0; g < parts.size(); ++g) {
    float& part = parts[g][vertex][band];
    part = std::max(part, 0.0F);
    sum += double{part} * double{dimmers[g][band]};
    lit_count += dimmers[g][band] > 0.0F ? 1.0 : 0.0;
  }
  for (std::size_t g = 0; g < parts.size(); ++g) {
    const double dimmer = double{dimmers[g][band]};
    float& part = parts[g][vertex][band];
    if (!(dimmer > 0.0)) continue;
    part = static_cast<float>(sum > 0.0 ? whole / sum * double{part} : whole / lit_count / dimmer);
  }
}

}  // namespace

std::vector<Rgb> light_of_group(const SampleLog& log, const Samples& samples, std::size_t group) {
  std::vector<Rgb> irradiance(samples.sample_count());
  for (std::size_t s = 0; s < irradiance.size(); ++s) {
    irradiance[s] = log.irradiance[samples.number[s] * std::size_t{log.group_count} + group];
  }
  return irradiance;
}

std::vector<std::vector<Rgb>> share_among_groups(std::span<const Rgb> whole, std::vector<std::vector<Rgb>> free,
                                                 std::span<const Rgb> dimmers) {
  in_parallel(0, whole.size(), [&](std::size_t v) {
    for (int band = 0; band < 3; ++band) share_band(double{whole[v][band]}, v, band, dimmers, free);
  });
  return free;
}

}  // namespace radiosity
