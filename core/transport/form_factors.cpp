#include "core/transport/form_factors.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/transport/sky_light.h"

namespace radiosity {
namespace {

/// Dense sums of one row; reused by each thread.
struct Accumulator {
  std::vector<float> factor;
  std::vector<std::uint32_t> touched;
  ItemBuffer items;

  /// Forgets the row before, which may have run out of memory on the way.
  void begin(std::size_t patch_count) {
    for (const std::uint32_t j : touched) factor[j] = 0.0F;
    touched.clear();
    factor.resize(patch_count, 0.0F);
  }
};

class HemicubeRows final : public RowSource {
 public:
  HemicubeRows(const Patches& patches, const Hemicube& hemicube, const ItemBufferMaker& items, const SmoothSky& sky,
               float surface_offset)
      : patches_(patches), hemicube_(hemicube), items_(items), sky_(sky), offset_(surface_offset) {}

  std::uint32_t patch_count() const override { return patches_.patch_count(); }

  FormFactorRow row(std::uint32_t patch) const override {
    thread_local Accumulator sums;
    sums.begin(patch_count());

    // One hemicube at each point of the patch, each with a twist of its own.
    FormFactorRow row;
    const std::span<const SurfacePoint> points = patches_.points_of(patch);
    const float weight = 1.0F / static_cast<float>(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto twist = low_discrepancy_twist(static_cast<std::uint32_t>(patch * points.size() + k));
      const Viewpoint viewpoint{points[k].position + offset_ * points[k].normal, points[k].normal, twist};
      items_.fill(hemicube_, viewpoint, sums.items);
      add(weight, sums, row);
      if (!sky_.is_constant()) row.sky += weight * luminance_of_sky(sky_, hemicube_, viewpoint, sums.items);
    }

    // Dense to sparse, in ascending order so that sums do not depend on what was seen first.
    std::sort(sums.touched.begin(), sums.touched.end());
    row.patch = sums.touched;
    row.factor.reserve(sums.touched.size());
    for (const std::uint32_t j : sums.touched) row.factor.push_back(sums.factor[j]);
    return row;
  }

 private:
  /// Adds the delta form factors of the item buffer in `sums`.
  void add(float weight, Accumulator& sums, FormFactorRow& row) const {
    const std::span<const float> delta = hemicube_.delta_form_factors();
    for (std::size_t c = 0; c < delta.size(); ++c) {
      const std::uint32_t triangle = sums.items.triangle[c];
      if (triangle == kNothing) {
        row.to_sky += weight * delta[c];
        continue;
      }
      const std::uint32_t j = patches_.patch_at(triangle, sums.items.barycentrics[c], sums.items.back[c] != 0);
      if (j == kNothing) {
        row.to_backs += weight * delta[c];
        continue;
      }
      if (sums.factor[j] == 0.0F) sums.touched.push_back(j);
      sums.factor[j] += weight * delta[c];
    }
  }

  const Patches& patches_;
  const Hemicube& hemicube_;
  const ItemBufferMaker& items_;
  const SmoothSky& sky_;
  float offset_;
};

}  // namespace

std::unique_ptr<RowSource> make_hemicube_rows(const Patches& patches, const Hemicube& hemicube,
                                              const ItemBufferMaker& items, const SmoothSky& sky,
                                              float surface_offset) {
  return std::make_unique<HemicubeRows>(patches, hemicube, items, sky, surface_offset);
}

void RowCache::fetch(std::span<const std::uint32_t> patches) {
  std::vector<std::uint32_t> missing;
  for (const std::uint32_t patch : patches) {
    if (!holds(patch)) missing.push_back(patch);
  }
  std::vector<FormFactorRow> rows(missing.size());
  in_parallel(0, missing.size(), [&](std::size_t k) { rows[k] = source_.row(missing[k]); });

  for (std::size_t k = 0; k < missing.size(); ++k) {
    bytes_ += rows[k].bytes();
    slots_.push_front({missing[k], std::move(rows[k])});
    slot_of_patch_[missing[k]] = slots_.begin();
  }
  computed_count_ += missing.size();
  evict(std::max<std::size_t>(missing.size(), 1));
}

const FormFactorRow& RowCache::row(std::uint32_t patch) {
  if (!holds(patch)) fetch({&patch, 1});
  const auto slot = slot_of_patch_.at(patch);
  slots_.splice(slots_.begin(), slots_, slot);
  return slot->row;
}

void RowCache::evict(std::size_t keep) {
  while (bytes_ > max_bytes_ && slots_.size() > keep) {
    bytes_ -= slots_.back().row.bytes();
    slot_of_patch_.erase(slots_.back().patch);
    slots_.pop_back();
  }
}

}  // namespace radiosity
