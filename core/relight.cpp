#include "core/relight.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/photometry.h"
#include "core/reconstruct/fit_system.h"

namespace radiosity {
namespace {

/// Of a fit, once it is near.
constexpr int kMaxIterations = 2000;

FitMatrix matrix_of(const LightTransport& transport) {
  FitMatrix matrix;
  matrix.diagonal.assign(transport.value_count(), 0.0);
  matrix.elements.reserve(transport.fit_values.size());
  for (std::size_t e = 0; e < transport.fit_values.size(); ++e) {
    const glm::uvec3& at = transport.fit_values[e];
    const float* share = transport.fit_shares.data() + 6 * e;
    matrix.add({{at.x, at.y, at.z},
                double{share[0]},
                double{share[1]},
                double{share[2]},
                double{share[3]},
                double{share[4]},
                double{share[5]}});
  }
  return matrix;
}

/// The sum of what belongs to `index` of each group, dimmed: `values` are [count][group_count].
glm::dvec3 dimmed_sum(std::span<const Rgb> values, std::size_t index, std::span<const Rgb> dimmers) {
  glm::dvec3 sum(0.0);
  for (std::size_t g = 0; g < dimmers.size(); ++g) {
    sum += glm::dvec3(values[index * dimmers.size() + g]) * glm::dvec3(dimmers[g]);
  }
  return sum;
}

std::vector<glm::dvec3> dimmed_fits(const LightTransport& transport, std::span<const Rgb> dimmers) {
  const std::size_t count = transport.value_count();
  std::vector<glm::dvec3> sum(count, glm::dvec3(0.0));
  for (std::size_t g = 0; g < dimmers.size(); ++g) {
    for (std::size_t v = 0; v < count; ++v) {
      sum[v] += glm::dvec3(transport.fits[g * count + v]) * glm::dvec3(dimmers[g]);
    }
  }
  return sum;
}

/// Gauss-Seidel over the rows that are known, as solve_gathering() does, until a sweep hardly changes anything.
std::vector<glm::dvec3> solve_exchange(const LightTransport& transport, std::span<const glm::dvec3> first,
                                       std::span<const Rgb> reflectance, const Progress& progress) {
  constexpr int kMaxSweeps = 1000;
  constexpr double kEnough = 1e-7;
  std::vector<glm::dvec3> radiosity(first.begin(), first.end());
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    progress.update("solve", static_cast<double>(sweep) / kMaxSweeps);
    double change = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      glm::dvec3 gathered(0.0);
      for (std::uint64_t k = transport.row_begin[i]; k < transport.row_begin[i + 1]; ++k) {
        gathered += double{transport.row_factor[k]} * radiosity[transport.row_patch[k]];
      }
      const glm::dvec3 updated = first[i] + glm::dvec3(reflectance[i]) * gathered;
      change += std::abs(double{luminance_of(Rgb(updated - radiosity[i]))});
      sum += double{luminance_of(Rgb(updated))};
      radiosity[i] = updated;
    }
    if (change <= kEnough * sum) break;
  }
  return radiosity;
}

/// What patches send to the samples, lm/m2.
std::vector<Rgb> sent_light(const LightTransport& transport, std::span<const Rgb> dimmers,
                            std::span<const Rgb> reflectance, const Progress& progress) {
  std::vector<glm::dvec3> first(reflectance.size());
  std::vector<Rgb> glow(reflectance.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    glow[i] = transport.glow[i] * dimmers[transport.glow_group[i]];
    first[i] = glm::dvec3(exitance_of_luminance(glow[i])) +
               glm::dvec3(reflectance[i]) * dimmed_sum(transport.patch_direct, i, dimmers);
  }
  const std::vector<glm::dvec3> radiosity = solve_exchange(transport, first, reflectance, progress);
  std::vector<Rgb> sent(radiosity.size());
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = sent_part(Rgb(radiosity[i]), glow[i], transport.parts);
  return sent;
}

/// Light at the samples, lx.
std::vector<Rgb> gather_again(const LightTransport& transport, std::span<const Rgb> dimmers, std::span<const Rgb> sent,
                              const Progress& progress) {
  const std::size_t cell_count = transport.cell_factor.size();
  std::vector<Rgb> irradiance(transport.sample_element.size());
  parallel_in_chunks(irradiance.size(), 65536, progress, "gather", [&](std::size_t s) {
    glm::vec3 seen(0.0F);
    const std::span<const std::uint32_t> cells = transport.cell_patch.subspan(s * cell_count, cell_count);
    for (std::size_t c = 0; c < cell_count; ++c) {
      if (cells[c] != kNothing) seen += transport.cell_factor[c] * sent[cells[c]];
    }
    irradiance[s] = seen + Rgb(dimmed_sum(transport.sample_direct, s, dimmers));
  });
  return irradiance;
}

std::vector<Rgb> at_vertices(const LightTransport& transport, std::span<const glm::dvec3> value) {
  return of_vertices(transport.value_of_vertex, value);
}

}  // namespace

std::vector<Rgb> relight(const LightTransport& transport, std::span<const Rgb> dimmers) {
  std::vector<glm::dvec3> value = dimmed_fits(transport, dimmers);
  const bool has_negative =
      std::ranges::any_of(value, [](const glm::dvec3& light) { return luminance_of(Rgb(light)) < 0.0F; });
  if (has_negative) {
    // As the fit does: what undershoots is held at zero, and the rest fits itself to that.
    const FitMatrix matrix = matrix_of(transport);
    hold_dark(matrix, multiply(matrix, value), kMaxIterations, value);
  }
  return at_vertices(transport, value);
}

std::vector<Rgb> relight(const LightTransport& transport, std::span<const Rgb> dimmers,
                         std::span<const Rgb> reflectance, const Progress& progress) {
  // Exchange and gather.
  const std::vector<Rgb> sent = sent_light(transport, dimmers, reflectance, progress);
  const std::vector<Rgb> irradiance = gather_again(transport, dimmers, sent, progress);

  // Fit, from the light with the old reflectances on.
  progress.update("fit", 0.0);
  const FitMatrix matrix = matrix_of(transport);
  std::vector<glm::dvec3> right(transport.value_count(), glm::dvec3(0.0));
  for (std::size_t s = 0; s < irradiance.size(); ++s) {
    const glm::uvec3& at = transport.fit_values[transport.sample_element[s]];
    for (int k = 0; k < 3; ++k) right[at[k]] += double{transport.sample_weight[s][k]} * glm::dvec3(irradiance[s]);
  }
  std::vector<glm::dvec3> value = dimmed_fits(transport, dimmers);
  solve(matrix, right, {}, kMaxIterations, value);
  hold_dark(matrix, right, kMaxIterations, value);
  progress.update("fit", 1.0);
  return at_vertices(transport, value);
}

}  // namespace radiosity
