#include "plugin/rows_archive.h"

#include <array>
#include <utility>
#include <vector>

namespace gltf_radiosity {
namespace {

using radiosity::FormFactorRow;

/// What a row holds besides its factors: to_sky, to_backs, and the sky's red, green and blue.
using RowRest = std::array<float, 5>;

/// Rows one after the other. Patch numbers ascend in a row: their differences are smaller, and pack better.
struct FlatRows {
  std::vector<std::uint32_t> count;  ///< of factors, per row
  std::vector<std::uint32_t> step;   ///< from patch to patch, the first from 0
  std::vector<float> factor;
  std::vector<RowRest> rest;  ///< per row
};

class StoredRows final : public radiosity::RowSource {
 public:
  explicit StoredRows(FlatRows rows) : rows_(std::move(rows)) {
    std::uint64_t first = 0;
    for (const std::uint32_t count : rows_.count) {
      first_.push_back(first);
      first += count;
    }
  }

  std::uint32_t patch_count() const override { return static_cast<std::uint32_t>(rows_.count.size()); }

  FormFactorRow row(std::uint32_t patch) const override {
    FormFactorRow row;
    const std::uint64_t first = first_[patch], last = first + rows_.count[patch];
    row.patch.reserve(rows_.count[patch]);
    std::uint32_t j = 0;
    for (std::uint64_t k = first; k < last; ++k) row.patch.push_back(j += rows_.step[k]);
    row.factor.assign(rows_.factor.begin() + static_cast<std::ptrdiff_t>(first),
                      rows_.factor.begin() + static_cast<std::ptrdiff_t>(last));
    const RowRest& rest = rows_.rest[patch];
    row.to_sky = rest[0];
    row.to_backs = rest[1];
    row.sky = {rest[2], rest[3], rest[4]};
    return row;
  }

  /// Whether every row ends within the arrays and names patches that there are.
  bool is_sound() const {
    const std::uint64_t total = first_.empty() ? 0 : first_.back() + rows_.count.back();
    if (rows_.step.size() != total || rows_.factor.size() != total || rows_.rest.size() != first_.size()) return false;
    for (std::uint32_t i = 0; i < patch_count(); ++i) {
      std::uint64_t j = 0;
      for (std::uint64_t k = first_[i]; k < first_[i] + rows_.count[i]; ++k) j += rows_.step[k];
      if (j >= patch_count()) return false;
    }
    return true;
  }

 private:
  FlatRows rows_;
  std::vector<std::uint64_t> first_;  ///< [patch_count]
};

}  // namespace

void add_rows(ArchiveWriter& archive, const radiosity::RowCache& rows) {
  FlatRows flat;
  for (std::uint32_t i = 0; i < rows.patch_count(); ++i) {
    const FormFactorRow& row = *rows.peek(i);
    flat.count.push_back(static_cast<std::uint32_t>(row.patch.size()));
    std::uint32_t last = 0;
    for (const std::uint32_t j : row.patch) flat.step.push_back(j - std::exchange(last, j));
    flat.factor.insert(flat.factor.end(), row.factor.begin(), row.factor.end());
    flat.rest.push_back({row.to_sky, row.to_backs, row.sky.x, row.sky.y, row.sky.z});
  }
  archive.add("counts", flat.count, Packing::kZstd);
  archive.add("steps", flat.step, Packing::kZstd);
  archive.add("factors", flat.factor, Packing::kZstd);
  archive.add("rest", flat.rest, Packing::kZstd);
}

Result<std::unique_ptr<radiosity::RowSource>> read_rows(const Archive& archive, std::uint32_t patch_count) {
  auto count = archive.read_vector<std::uint32_t>("counts");
  if (!count) return count.error();
  auto step = archive.read_vector<std::uint32_t>("steps");
  if (!step) return step.error();
  auto factor = archive.read_vector<float>("factors");
  if (!factor) return factor.error();
  auto rest = archive.read_vector<RowRest>("rest");
  if (!rest) return rest.error();
  if (count->size() != patch_count) return archive.damaged("counts", "has another size");
  auto rows =
      std::make_unique<StoredRows>(FlatRows{std::move(*count), std::move(*step), std::move(*factor), std::move(*rest)});
  if (!rows->is_sound()) return archive.damaged("steps", "does not fit the others");
  return std::unique_ptr<radiosity::RowSource>(std::move(rows));
}

}  // namespace gltf_radiosity
