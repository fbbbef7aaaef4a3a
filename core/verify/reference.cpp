#include "core/verify/reference.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/photometry.h"

namespace radiosity {
namespace {

constexpr std::uint32_t kMaxGrowth = 4;  ///< times as many samples as before, at most, in one round

/// What is known of a place so far.
struct Estimate {
  explicit Estimate(Random random_numbers) : random(random_numbers) {}

  Random random;
  glm::dvec3 sum{0.0}, band_square_sum{0.0};  ///< of rho H / pi
  double luminance_sum = 0.0, square_sum = 0.0;
  std::uint32_t count = 0, wanted = kFirstSamples, back_count = 0;

  bool buried() const { return back_count > kBuriedPathShare * count; }
  /// Of one path.
  double variance() const {
    return std::max(0.0, (square_sum - luminance_sum * luminance_sum / count) / (count - 1.0));
  }
  double band_variance() const {
    const glm::dvec3 variance = (band_square_sum - sum * sum / static_cast<double>(count)) / (count - 1.0);
    return std::max(0.0, variance.x + variance.y + variance.z);
  }
};

void trace_wanted(const PathTracer& tracer, const ReferencePlace& place, Estimate& estimate) {
  for (; estimate.count < estimate.wanted; ++estimate.count) {
    const PathSample path = tracer.sample(place.position, place.normal, estimate.random);
    const Rgb luminance = reflected_luminance(place.reflectance, path.irradiance);
    const auto seen = static_cast<double>(luminance_of(luminance));
    estimate.sum += glm::dvec3(luminance);
    estimate.band_square_sum += glm::dvec3(luminance) * glm::dvec3(luminance);
    estimate.luminance_sum += seen;
    estimate.square_sum += seen * seen;
    estimate.back_count += path.sees_back ? 1U : 0U;
  }
}

/// Sums over the places that are not buried.
struct Totals {
  double places = 0.0;
  double luminance = 0.0;         ///< cd/m2
  double variance_of_mean = 0.0;  ///< what the noise is made of
  double variance_of_path = 0.0;

  double noise() const { return luminance > 0.0 ? std::sqrt(variance_of_mean * places) / luminance : 0.0; }
};

Totals totals_of(std::span<const ReferencePlace> places, std::span<const Estimate> estimates) {
  Totals totals;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Estimate& estimate = estimates[i];
    if (estimate.buried()) continue;
    totals.places += 1.0;
    totals.luminance += estimate.luminance_sum / estimate.count + static_cast<double>(luminance_of(places[i].emission));
    totals.variance_of_mean += estimate.variance() / estimate.count;
    totals.variance_of_path += estimate.variance();
  }
  return totals;
}

/// Says how many samples each place should have after the next round; answers how many are missing in total until the
/// noise is as wanted, further rounds included.
std::uint64_t plan_round(std::span<Estimate> estimates, const Totals& totals, const ReferenceOptions& options) {
  // Half the variance is the place's own. With n_i = c sigma_i the mean of sigma_i^2 / n_i is that of sigma_i / c.
  const double common = totals.variance_of_path / totals.places;
  const auto deviation = [&](const Estimate& e) { return std::sqrt(0.5 * (e.variance() + common)); };
  double deviation_sum = 0.0;
  for (const Estimate& estimate : estimates) deviation_sum += estimate.buried() ? 0.0 : deviation(estimate);
  const double wanted = options.noise * totals.luminance / totals.places;
  const double scale = deviation_sum / totals.places / (wanted * wanted);

  std::uint64_t missing = 0;
  for (Estimate& estimate : estimates) {
    if (estimate.buried()) continue;
    const double needed = std::min(std::ceil(scale * deviation(estimate)), static_cast<double>(options.max_samples));
    const auto target = std::max(static_cast<std::uint32_t>(needed), estimate.count);
    missing += target - estimate.count;
    estimate.wanted = std::min(target, kMaxGrowth * estimate.count);
  }
  return missing;
}

/// `progress` of a part of the work that begins and ends at these shares of the whole.
Progress part_of(const Progress& progress, double begin, double end) {
  Progress part;
  part.cancelled = progress.cancelled;
  part.report = [&progress, begin, end](std::string_view phase, double done) {
    if (progress.report) progress.report(phase, begin + done * (end - begin));
  };
  return part;
}

Reference summarize(std::span<const ReferencePlace> places, std::span<const Estimate> estimates) {
  Reference result;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Estimate& estimate = estimates[i];
    result.luminance.push_back(Rgb(estimate.sum / static_cast<double>(estimate.count)) + places[i].emission);
    result.variance.push_back(estimate.variance() / estimate.count);
    result.band_variance.push_back(estimate.band_variance() / estimate.count);
    result.buried.push_back(estimate.buried() ? 1 : 0);
    result.sample_count += estimate.count;
  }
  result.noise = totals_of(places, estimates).noise();
  return result;
}

}  // namespace

Reference trace_reference(const PathTracer& tracer, std::span<const ReferencePlace> places,
                          const ReferenceOptions& options, const Progress& progress) {
  std::vector<Estimate> estimates;
  for (std::size_t i = 0; i < places.size(); ++i) estimates.emplace_back(Random(options.seed, i));

  // Rounds, each as large as the one before suggests.
  double done = 0.0;
  double next_done = 0.05;
  for (std::uint64_t missing = places.size(); missing > 0;) {
    const auto trace_one = [&](std::size_t i) { trace_wanted(tracer, places[i], estimates[i]); };
    parallel_in_chunks(places.size(), 64, part_of(progress, done, next_done), "trace", trace_one);

    const Totals totals = totals_of(places, estimates);
    if (totals.noise() <= options.noise) break;
    missing = plan_round(estimates, totals, options);
    std::uint64_t in_round = 0;
    for (const Estimate& estimate : estimates) in_round += estimate.wanted - estimate.count;
    done = next_done;
    if (missing > 0) next_done += (1.0 - done) * static_cast<double>(in_round) / static_cast<double>(missing);
  }
  progress.update("trace", 1.0);
  return summarize(places, estimates);
}

}  // namespace radiosity
