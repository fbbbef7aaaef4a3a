#include "core/light_transport.h"

#include <algorithm>

namespace radiosity {
namespace {

/// What patches would reflect if the factors of their materials were white: means over their tiles.
std::vector<Rgb> undyed_reflectances(const Scene& scene, const Patches& patches) {
  std::vector<glm::dvec3> sum(patches.patch_count(), glm::dvec3(0.0));
  std::vector<double> area(sum.size(), 0.0);
  patches.tiling.for_each_leaf([&](const Tile& tile) {
    const glm::dvec3 undyed(undyed_reflectance(scene, tile.triangle, tile.part));
    for (const std::uint32_t patch : {patches.patch_of_tile[tile.tile], patches.back_patch_of_tile[tile.tile]}) {
      if (patch == kNothing || patch == patches.unreached) continue;
      sum[patch] += double{tile.area} * undyed;
      area[patch] += double{tile.area};
    }
  });
  std::vector<Rgb> mean(sum.size(), Rgb(0.0F));
  for (std::size_t p = 0; p < mean.size(); ++p) {
    if (area[p] > 0.0) mean[p] = Rgb(sum[p] / area[p]);
  }
  return mean;
}

}  // namespace

LightTransport KeptTransport::view() const {
  return {group_count,  parts,          value_of_vertex, fits,          fit_values,  fit_shares, row_begin,
          row_patch,    row_factor,     surface,         reflectance,   undyed,      glow,       glow_group,
          patch_direct, sample_element, sample_weight,   sample_direct, cell_factor, cell_patch};
}

void keep_fits(const VertexFit& fit, std::span<const std::vector<glm::dvec3>> fits, KeptTransport& kept) {
  kept.value_of_vertex = fit.groups.group_of_vertex;
  for (const std::vector<glm::dvec3>& of_group : fits)
    kept.fits.insert(kept.fits.end(), of_group.begin(), of_group.end());
  for (const FitElement& m : fit.matrix.elements) {
    kept.fit_values.emplace_back(m.group[0], m.group[1], m.group[2]);
    for (const double share : {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}) {
      kept.fit_shares.push_back(static_cast<float>(share));
    }
  }
}

bool keep_exchange(const Scene& scene, const Patches& patches, const RowCache& rows, std::span<const Rgb> direct,
                   KeptTransport& kept) {
  kept.row_begin.assign(1, 0);
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    const FormFactorRow* row = rows.peek(i);
    if (row == nullptr) {
      forget_rows(kept);
      return false;
    }
    kept.row_patch.insert(kept.row_patch.end(), row->patch.begin(), row->patch.end());
    kept.row_factor.insert(kept.row_factor.end(), row->factor.begin(), row->factor.end());
    kept.row_begin.push_back(kept.row_patch.size());
  }
  kept.surface = patches.surface;
  kept.reflectance = patches.reflectance;
  kept.undyed = undyed_reflectances(scene, patches);
  kept.glow = patches.glow;
  kept.glow_group = glow_groups(scene, patches);
  kept.patch_direct.assign(direct.begin(), direct.end());
  return true;
}

bool keep_samples(const RefinedMesh& mesh, const Samples& samples, const SampleLog& log, const Hemicube& hemicube,
                  KeptTransport& kept) {
  if (log.cell_count == 0) {
    forget_rows(kept);
    return false;
  }
  std::uint32_t fit_element = 0;  // those without area have none
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const float area = element_area(mesh, e);
    if (!(area > 0.0F)) continue;
    const std::uint32_t first = samples.first_of_element[e], last = samples.first_of_element[e + 1];
    for (std::uint32_t s = first; s < last; ++s) {
      const std::size_t number = samples.number[s];
      const auto direct = log.direct.begin() + static_cast<std::ptrdiff_t>(number * log.group_count);
      const auto cells = log.patch_of_cell.begin() + static_cast<std::ptrdiff_t>(number * log.cell_count);
      kept.sample_element.push_back(fit_element);
      kept.sample_weight.push_back(samples.weights[s] * (area / static_cast<float>(last - first)));
      kept.sample_direct.insert(kept.sample_direct.end(), direct, direct + log.group_count);
      kept.cell_patch.insert(kept.cell_patch.end(), cells, cells + log.cell_count);
    }
    ++fit_element;
  }
  const std::span<const float> factors = hemicube.delta_form_factors();
  kept.cell_factor.assign(factors.begin(), factors.end());
  return true;
}

void forget_rows(KeptTransport& kept) {
  KeptTransport fits;
  fits.group_count = kept.group_count;
  fits.parts = kept.parts;
  fits.value_of_vertex = std::move(kept.value_of_vertex);
  fits.fits = std::move(kept.fits);
  fits.fit_values = std::move(kept.fit_values);
  fits.fit_shares = std::move(kept.fit_shares);
  kept = std::move(fits);
}

}  // namespace radiosity
