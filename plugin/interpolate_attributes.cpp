#include "plugin/interpolate_attributes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace gltf_radiosity {
namespace {

using radiosity::Cut;

/// The first of two that are equally near.
std::uint32_t nearer_end(const Cut& cut) { return cut.at > 0.5F ? cut.ends.y : cut.ends.x; }

std::size_t row_size(const RawAccessor& raw) {
  return static_cast<std::size_t>(raw.components) * component_size(raw.component);
}

void append_bytes(RawAccessor& raw, const Bytes& bytes, std::size_t row_count) {
  raw.bytes.insert(raw.bytes.end(), bytes.begin(), bytes.end());
  raw.count += row_count;
}

/// The value between the ends; if that is no number because an end is none, the other end.
float value_at(float at, float first, float second) {
  const float mean = first * (1.0F - at) + second * at;
  if (std::isfinite(mean)) return mean;
  return std::isfinite(first) ? first : second;
}

/// Scales x, y, z of `row` to unit length; opposite ends that cancel take the first one's direction.
void normalise(float* row, const float* first_end) {
  const float length = std::sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
  const bool valid = std::isfinite(length) && length > 1e-12F;
  for (int c = 0; c < 3; ++c) row[c] = valid ? row[c] / length : first_end[c];
}

struct Influence {
  std::uint32_t joint = 0;
  float weight = 0.0F;
};

/// Every joint that acts on a vertex, once.
class Influences {
 public:
  void add(std::span<const Influence> row, float share) {
    for (const Influence& influence : row) {
      if (!(influence.weight > 0.0F)) continue;
      const auto same =
          std::find_if(sum_.begin(), sum_.end(), [&](const Influence& i) { return i.joint == influence.joint; });
      if (same == sum_.end()) {
        sum_.push_back({influence.joint, influence.weight * share});
      } else {
        same->weight += influence.weight * share;
      }
    }
  }

  /// The strongest into `row`, strongest first, their weights adding up to 1.
  void write_strongest(std::span<Influence> row) {
    std::sort(sum_.begin(), sum_.end(), [](const Influence& a, const Influence& b) {
      return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
    });
    sum_.resize(std::min(sum_.size(), row.size()));
    float total = 0.0F;
    for (const Influence& influence : sum_) total += influence.weight;
    for (std::size_t i = 0; i < sum_.size(); ++i) row[i] = {sum_[i].joint, sum_[i].weight / total};
  }

 private:
  std::vector<Influence> sum_;
};

/// The influences on all vertices, [count * 4 * sets], read from the sets' accessors.
std::vector<Influence> read_influences(const std::vector<SkinSet>& sets, std::size_t cut_count) {
  const std::size_t width = 4 * sets.size(), count = sets.front().joints.count;
  std::vector<Influence> influences((count + cut_count) * width);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::vector<std::uint32_t> joints = as_indices(sets[s].joints);
    const std::vector<float> weights = as_floats(sets[s].weights);
    for (std::size_t i = 0; i < 4 * count; ++i) influences[i / 4 * width + 4 * s + i % 4] = {joints[i], weights[i]};
  }
  return influences;
}

/// Rounds the weights of `row` to what the sets store and lets the strongest take up the difference to 1.
void round_weights(const std::vector<SkinSet>& sets, std::span<Influence> row) {
  if (!(row[0].weight > 0.0F)) return;
  double others = 0.0;
  for (std::size_t i = row.size(); i-- > 0;) {
    const RawAccessor& weights = sets[i / 4].weights;
    if (i == 0) row[0].weight = static_cast<float>(1.0 - others);
    RawAccessor one{weights.component, 1, weights.normalized, 1, {}};
    one.bytes = encode_floats({row[i].weight}, weights.component, weights.normalized);
    row[i].weight = as_floats(one)[0];
    others += static_cast<double>(row[i].weight);
    if (!(row[i].weight > 0.0F)) row[i] = {};  // a joint without weight must be 0
  }
}

void append_set(SkinSet& set, std::size_t set_index, std::span<const Influence> rows, std::size_t width) {
  const std::size_t row_count = rows.size() / width;
  std::vector<float> joints(row_count * 4), weights(row_count * 4);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Influence& influence = rows[i / 4 * width + 4 * set_index + i % 4];
    joints[i] = static_cast<float>(influence.joint);  // exact: joints are 16 bits wide
    weights[i] = influence.weight;
  }
  append_bytes(set.joints, encode_floats(joints, set.joints.component, false), row_count);
  append_bytes(set.weights, encode_floats(weights, set.weights.component, set.weights.normalized), row_count);
}

}  // namespace

Interpolation interpolation_of(std::string_view semantic, const RawAccessor& raw) {
  if (semantic == "NORMAL" && raw.components == 3) return Interpolation::kDirection;
  if (semantic == "TANGENT" && raw.components == 4) return Interpolation::kTangent;
  const bool of_application = semantic.starts_with('_') || semantic.starts_with("JOINTS_");
  const bool whole = raw.component != ComponentType::kF32 && !raw.normalized;
  return of_application && whole ? Interpolation::kLabel : Interpolation::kLinear;
}

RawAccessor picked(RawAccessor source, std::span<const std::uint32_t> rows) {
  if (rows.empty()) return source;
  const std::size_t size = row_size(source);
  Bytes bytes(rows.size() * size);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    assert(rows[i] < source.count);
    std::memcpy(bytes.data() + i * size, source.bytes.data() + rows[i] * size, size);
  }
  source.bytes = std::move(bytes);
  source.count = rows.size();
  return source;
}

void append_cuts(RawAccessor& raw, Interpolation how, std::span<const Cut> cuts) {
  const auto width = static_cast<std::size_t>(raw.components);
  const std::size_t old_count = raw.count;

  // Labels are copied as bytes.
  if (how == Interpolation::kLabel) {
    const std::size_t size = row_size(raw);
    raw.bytes.resize((old_count + cuts.size()) * size);
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      std::memcpy(raw.bytes.data() + (old_count + k) * size, raw.bytes.data() + nearer_end(cuts[k]) * size, size);
    }
    raw.count += cuts.size();
    return;
  }

  // Means are taken of floats, unrounded from cut to cut.
  std::vector<float> values = as_floats(raw);
  values.resize((old_count + cuts.size()) * width);
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const float* first = values.data() + cuts[k].ends.x * width;
    const float* second = values.data() + cuts[k].ends.y * width;
    const float* nearer = values.data() + nearer_end(cuts[k]) * width;
    float* mean = values.data() + (old_count + k) * width;
    for (std::size_t c = 0; c < width; ++c) mean[c] = value_at(cuts[k].at, first[c], second[c]);
    if (how == Interpolation::kDirection || how == Interpolation::kTangent) normalise(mean, nearer);
    if (how == Interpolation::kTangent) mean[3] = nearer[3];
  }
  const std::vector<float> fresh(values.begin() + static_cast<std::ptrdiff_t>(old_count * width), values.end());
  append_bytes(raw, encode_floats(fresh, raw.component, raw.normalized), cuts.size());
}

void append_cuts(std::vector<SkinSet>& sets, std::span<const Cut> cuts) {
  if (sets.empty()) return;
  const std::size_t width = 4 * sets.size(), old_count = sets.front().joints.count;

  // Merge the two ends of each cut.
  std::vector<Influence> influences = read_influences(sets, cuts.size());
  const auto row = [&](std::size_t vertex) { return std::span(influences).subspan(vertex * width, width); };
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    Influences merged;
    merged.add(row(cuts[k].ends.x), 1.0F - cuts[k].at);
    merged.add(row(cuts[k].ends.y), cuts[k].at);
    merged.write_strongest(row(old_count + k));
  }

  // Store.
  for (std::size_t k = 0; k < cuts.size(); ++k) round_weights(sets, row(old_count + k));
  const std::span<const Influence> fresh = std::span(influences).subspan(old_count * width);
  for (std::size_t s = 0; s < sets.size(); ++s) append_set(sets[s], s, fresh, width);
}

}  // namespace gltf_radiosity
