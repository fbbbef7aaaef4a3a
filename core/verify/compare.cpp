#include "core/verify/compare.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "core/photometry.h"

namespace radiosity {
namespace {

double luminance_in_double(const glm::dvec3& rgb) { return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z; }

/// What a place could show at best, cd/m2.
glm::dvec3 showable_reference(const ComparedPlace& place, double exposure) {
  const glm::dvec3 reference(place.reference);
  return place.clipped ? glm::min(reference, glm::dvec3(1.0 / exposure)) : reference;
}

double error_of(const ComparedPlace& place, double exposure) {
  return luminance_in_double(glm::dvec3(place.displayed) / exposure - showable_reference(place, exposure));
}

}  // namespace

double fitted_exposure(std::span<const ComparedPlace> places) {
  double products = 0.0;
  double squares = 0.0;
  for (const ComparedPlace& place : places) {
    if (place.clipped) continue;
    products += glm::dot(glm::dvec3(place.displayed), glm::dvec3(place.reference));
    squares += glm::dot(glm::dvec3(place.reference), glm::dvec3(place.reference)) - place.band_variance;
  }
  return products > 0.0 && squares > 0.0 ? products / squares : 1.0;
}

double relative_error(const ComparedPlace& place, double exposure, double mean) {
  const double scale = luminance_in_double(showable_reference(place, exposure)) + 0.1 * mean;
  const double error = error_of(place, exposure);
  return scale > 0.0 ? error / scale : error == 0.0 ? 0.0 : std::copysign(1.0, error);
}

Comparison compare(std::span<const ComparedPlace> places, double exposure) {
  Comparison result;
  result.exposure = exposure;
  const auto count = static_cast<double>(places.size());

  // Sums.
  double square_error = 0.0;
  double variance = 0.0;
  for (const ComparedPlace& place : places) {
    const double error = error_of(place, exposure);
    square_error += error * error / count;
    variance += place.variance / count;
    result.mean += luminance_in_double(showable_reference(place, exposure)) / count;
    result.clipped_share += place.clipped ? 1.0 / count : 0.0;
  }
  if (result.mean > 0.0) {
    result.relative_rmse = std::sqrt(std::max(0.0, square_error - variance)) / result.mean;
    result.reference_noise = std::sqrt(variance) / result.mean;
  } else {
    result.relative_rmse = square_error > 0.0 ? 1.0 : 0.0;
  }

  // Order.
  std::vector<double> errors;
  for (const ComparedPlace& place : places) errors.push_back(std::abs(relative_error(place, exposure, result.mean)));
  std::sort(errors.begin(), errors.end());
  result.median = errors[errors.size() / 2];
  result.p95 = errors[errors.size() * 95 / 100];
  result.p99 = errors[errors.size() * 99 / 100];
  return result;
}

}  // namespace radiosity
