#include "plugin/import_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "plugin/check_document.h"
#include "plugin/image_decode.h"
#include "plugin/srgb.h"

namespace gltf_radiosity {
namespace {

constexpr float kMaxCells = 256.0F;        ///< texels of one level looked at for a mean: its cost is bounded
constexpr float kMaxTexels = 64.0F;        ///< of these, about as many lie in the triangle
constexpr std::size_t kMaxStorage = 1040;  ///< cells and a margin, for the narrowest grid of kMaxCells
constexpr float kFarAway = 1.0e6F;         ///< texture coordinates beyond it have no fraction worth speaking of

std::array<float, 256> make_linear_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<float>(i) / 255.0F;
  return table;
}

const std::array<float, 256> kByteToLinear = make_linear_table();

}  // namespace

/// Level 0 as decoded; the others half as large each, linear, 16 bit, down to one texel.
struct MipPyramid {
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint16_t> rgba;  ///< [height * width * 4], linear; empty at level 0
  };
  std::vector<std::uint8_t> base;  ///< level 0, [height * width * 4]
  std::vector<Level> levels;       ///< [0] holds only the size
  TexelKind kind = TexelKind::kData;

  glm::vec4 texel(std::size_t level, int x, int y) const {
    const auto at =
        (static_cast<std::size_t>(y) * static_cast<std::size_t>(levels[level].width) + static_cast<std::size_t>(x)) * 4;
    if (level == 0) {
      const std::array<float, 256>& table = kind == TexelKind::kData ? kByteToLinear : kSrgbToLinear;
      return {table[base[at]], table[base[at + 1]], table[base[at + 2]], kByteToLinear[base[at + 3]]};
    }
    const std::uint16_t* value = levels[level].rgba.data() + at;
    return glm::vec4(value[0], value[1], value[2], value[3]) * (1.0F / 65535.0F);
  }

  /// How much a texel's colour counts in an average, beside the area.
  float color_weight(const glm::vec4& texel_value) const {
    return kind == TexelKind::kCoveredColor ? texel_value.w : 1.0F;
  }
};

namespace {

/// A weighted mean of texels, colour and alpha each with their own weights.
class TexelSum {
 public:
  explicit TexelSum(const MipPyramid& image) : image_(image) {}

  void add(const glm::vec4& texel, float weight) {
    const float color_weight = weight * image_.color_weight(texel);
    weight_ += weight;
    color_weight_ += color_weight;
    plain_ += texel * weight;
    covered_ += glm::vec3(texel) * color_weight;
  }
  float weight() const { return weight_; }
  /// REQUIRES: something was added. Where nothing is covered the colour is the plain mean.
  glm::vec4 mean() const {
    const glm::vec4 plain = plain_ / weight_;
    return color_weight_ > 1e-6F * weight_ ? glm::vec4(covered_ / color_weight_, plain.w) : plain;
  }

 private:
  const MipPyramid& image_;
  float weight_ = 0.0F, color_weight_ = 0.0F;
  glm::vec4 plain_{0.0F};
  glm::vec3 covered_{0.0F};
};

/// The texels of a level that one texel of the next level stands for, along one axis. Odd sizes take three with weights
/// that let every texel count the same in total.
struct Taps {
  int first = 0, count = 1;
  float weight[3] = {1.0F, 0.0F, 0.0F};
};

Taps taps_of(int index, int size) {
  if (size == 1) return {};
  if (size % 2 == 0) return {2 * index, 2, {0.5F, 0.5F, 0.0F}};
  const auto half = static_cast<float>(size / 2), i = static_cast<float>(index),
             scale = 1.0F / static_cast<float>(size);
  return {2 * index, 3, {(half - i) * scale, half * scale, (i + 1.0F) * scale}};
}

MipPyramid::Level half_of(const MipPyramid& image, std::size_t level) {
  const MipPyramid::Level& from = image.levels[level];
  MipPyramid::Level to;
  to.width = std::max(1, from.width / 2);
  to.height = std::max(1, from.height / 2);
  to.rgba.resize(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height) * 4);
  std::uint16_t* out = to.rgba.data();
  for (int y = 0; y < to.height; ++y) {
    const Taps rows = taps_of(y, from.height);
    for (int x = 0; x < to.width; ++x) {
      const Taps columns = taps_of(x, from.width);
      TexelSum sum(image);
      for (int j = 0; j < rows.count; ++j) {
        for (int i = 0; i < columns.count; ++i) {
          sum.add(image.texel(level, columns.first + i, rows.first + j), rows.weight[j] * columns.weight[i]);
        }
      }
      const glm::vec4 mean = sum.mean() * 65535.0F + 0.5F;
      for (int channel = 0; channel < 4; ++channel) *out++ = static_cast<std::uint16_t>(mean[channel]);
    }
  }
  return to;
}

std::shared_ptr<const MipPyramid> make_pyramid(Pixels pixels, TexelKind kind) {
  auto image = std::make_shared<MipPyramid>();
  image->kind = kind;
  image->levels.push_back({pixels.width, pixels.height, {}});
  image->base = std::move(pixels.rgba);
  while (image->levels.back().width > 1 || image->levels.back().height > 1) {
    image->levels.push_back(half_of(*image, image->levels.size() - 1));
  }
  return image;
}

int wrapped(int index, int size, Wrap wrap) {
  if (index >= 0 && index < size) return index;
  if (wrap == Wrap::kClampToEdge) return std::clamp(index, 0, size - 1);
  const int period = wrap == Wrap::kRepeat ? size : 2 * size;
  const int within = ((index % period) + period) % period;
  return within < size ? within : period - 1 - within;
}

Wrap wrap_of(const Json& sampler, const char* key) {
  const auto wrap = static_cast<Wrap>(sampler.value(key, 10497));
  return wrap == Wrap::kClampToEdge || wrap == Wrap::kMirroredRepeat ? wrap : Wrap::kRepeat;
}

/// The images of a texture, those in formats of their own before the plain one that stands in for them.
std::vector<std::size_t> image_sources(const Json& texture) {
  std::vector<std::size_t> sources;
  for (const char* name : kImageExtensions) {
    const Json* extension = extension_of(texture, name);
    if (extension != nullptr) sources.push_back((*extension)["source"].get<std::size_t>());
  }
  if (texture.contains("source")) sources.push_back(texture["source"].get<std::size_t>());
  return sources;
}

bool is_sane(glm::vec2 uv) { return std::abs(uv.x) < kFarAway && std::abs(uv.y) < kFarAway; }  // false for NaN

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// An edge that rises less than this covers nothing, and its slope may be no number.
constexpr float kFlat = 1e-30F;

/// How much of each cell of a small grid a polygon covers, exactly: every edge adds the signed area to its right, row
/// by row, and a running sum over the row turns that into coverage.
///
/// The method of FreeType's smooth rasteriser in the form of Raph Levien's font-rs (2015).
class Coverage {
 public:
  /// REQUIRES: all edges will lie in [0, columns] x [0, rows], and (columns + 2) * rows <= kMaxStorage.
  Coverage(int columns, int rows)
      : columns_(static_cast<std::size_t>(columns)), size_((columns_ + 2) * static_cast<std::size_t>(rows)) {
    assert(size_ <= kMaxStorage);
    std::fill_n(cells_.begin(), size_, 0.0F);
  }

  void add_edge(glm::vec2 a, glm::vec2 b) {
    const float sign = a.y < b.y ? 1.0F : -1.0F;
    if (a.y > b.y) std::swap(a, b);
    if (b.y - a.y < kFlat) return;
    const float slope = (b.x - a.x) / (b.y - a.y);
    const float least = std::min(a.x, b.x), most = std::max(a.x, b.x);
    const auto last = static_cast<int>(std::ceil(b.y));
    for (int row = static_cast<int>(a.y); row < last; ++row) {
      const float top = std::max(a.y, static_cast<float>(row));
      const float bottom = std::min(b.y, static_cast<float>(row + 1));
      const float x0 = std::clamp(a.x + slope * (top - a.y), least, most);
      const float x1 = std::clamp(a.x + slope * (bottom - a.y), least, most);
      add_span(row, std::min(x0, x1), std::max(x0, x1), sign * (bottom - top));
    }
  }

  /// Calls visit(column, row, share) for every cell with a share above 0.
  template <typename Visit>
  void for_each(Visit visit) const {
    const std::size_t stride = columns_ + 2;
    for (std::size_t row = 0; row * stride < size_; ++row) {
      float share = 0.0F;
      for (std::size_t column = 0; column < columns_; ++column) {
        share += cells_[row * stride + column];
        if (std::abs(share) > 1e-5F) visit(static_cast<int>(column), static_cast<int>(row), std::abs(share));
      }
    }
  }

 private:
  /// A piece of an edge inside one row, from x0 to x1, `height` tall (signed).
  void add_span(int row, float x0, float x1, float height) {
    float* cells = cells_.data() + static_cast<std::size_t>(row) * (columns_ + 2);
    const auto first = static_cast<int>(x0);
    float before = 0.0F;  // area to the right of the piece, up to the end of this cell, less the cells before
    for (int column = first; static_cast<float>(column) < x1 || column == first; ++column) {
      const float enter = std::max(x0, static_cast<float>(column));
      const float leave = std::min(x1, static_cast<float>(column + 1));
      // Of the height crossed in this cell, the cell itself has what lies right of the piece, the next one all of it.
      const float crossed = x1 > x0 ? height * (leave - enter) / (x1 - x0) : height;
      const float inside = crossed * (static_cast<float>(column + 1) - 0.5F * (enter + leave));
      cells[column] += before + inside;
      before = crossed - inside;
    }
    const int next = std::max(first, static_cast<int>(std::ceil(x1)) - 1) + 1;
    cells[next] += before;
  }

  std::size_t columns_, size_;
  std::array<float, kMaxStorage> cells_;  ///< [rows * (columns + 2)]; on the stack, this runs per triangle
};

struct Box {
  glm::vec2 low, high;
  glm::vec2 size() const { return high - low; }
};

Box box_of(const std::array<glm::vec2, 3>& points) {
  return {glm::min(glm::min(points[0], points[1]), points[2]), glm::max(glm::max(points[0], points[1]), points[2])};
}

/// The finest level on which the triangle (in texture coordinates) is small enough to look at texel by texel; none if
/// it is too large even on the coarsest.
std::optional<std::size_t> level_for(const MipPyramid& image, const std::array<glm::vec2, 3>& uv, float area) {
  const glm::vec2 extent = box_of(uv).size();
  for (std::size_t level = 0; level < image.levels.size(); ++level) {
    const glm::vec2 size(image.levels[level].width, image.levels[level].height);
    const glm::vec2 cells = extent * size + 1.0F;
    if (cells.x * cells.y <= kMaxCells && area * size.x * size.y <= kMaxTexels) return level;
  }
  return std::nullopt;
}

}  // namespace

glm::vec2 TextureSlot::transformed(glm::vec2 uv) const {
  // KHR_texture_transform: translation x rotation x scale, v pointing down.
  if (rotation == 0.0F) return offset + uv * scale;
  const float cosine = std::cos(rotation), sine = std::sin(rotation);
  const glm::vec2 scaled = uv * scale;
  return offset + glm::vec2(cosine * scaled.x + sine * scaled.y, -sine * scaled.x + cosine * scaled.y);
}

glm::vec4 TextureSlot::at(glm::vec2 uv) const {
  if (!image) return glm::vec4(1.0F);
  const glm::vec2 moved = transformed(uv);
  if (!is_sane(moved)) return image->texel(image->levels.size() - 1, 0, 0);
  const glm::dvec2 position = glm::dvec2(moved) * glm::dvec2(image->levels[0].width, image->levels[0].height) - 0.5;
  const glm::dvec2 corner = glm::floor(glm::clamp(position, -2e9, 2e9));
  const glm::vec2 fraction(position - corner);
  TexelSum sum(*image);
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const float weight = (i == 0 ? 1.0F - fraction.x : fraction.x) * (j == 0 ? 1.0F - fraction.y : fraction.y);
      const int x = wrapped(static_cast<int>(corner.x) + i, image->levels[0].width, wrap_s);
      const int y = wrapped(static_cast<int>(corner.y) + j, image->levels[0].height, wrap_t);
      sum.add(image->texel(0, x, y), weight);
    }
  }
  return sum.mean();
}

glm::vec4 TextureSlot::mean(const std::array<glm::vec2, 3>& uv) const {
  if (!image) return glm::vec4(1.0F);
  const std::size_t coarsest = image->levels.size() - 1;
  if (coarsest == 0) return image->texel(0, 0, 0);

  // Near the origin, by whole periods, so that floats are precise.
  std::array<glm::vec2, 3> moved = {transformed(uv[0]), transformed(uv[1]), transformed(uv[2])};
  if (!is_sane(moved[0]) || !is_sane(moved[1]) || !is_sane(moved[2])) return image->texel(coarsest, 0, 0);
  const glm::vec2 periods = glm::floor(moved[0] * 0.5F) * 2.0F;
  for (glm::vec2& point : moved) {
    if (wrap_s != Wrap::kClampToEdge) point.x -= periods.x;
    if (wrap_t != Wrap::kClampToEdge) point.y -= periods.y;
  }

  // A level on which it is a handful of texels.
  const auto area =
      static_cast<float>(std::abs(0.5 * cross(glm::dvec2(moved[1] - moved[0]), glm::dvec2(moved[2] - moved[0]))));
  const auto level = level_for(*image, moved, area);
  if (!level) return image->texel(coarsest, 0, 0);
  const glm::ivec2 size(image->levels[*level].width, image->levels[*level].height);
  for (glm::vec2& point : moved) point *= glm::vec2(size);

  // Every texel by the area it covers.
  const Box box = box_of(moved);
  const glm::vec2 origin = glm::floor(box.low);
  const glm::ivec2 cells(glm::ceil(box.high - origin));
  Coverage coverage(std::max(cells.x, 1), std::max(cells.y, 1));
  for (std::size_t i = 0; i < 3; ++i) coverage.add_edge(moved[i] - origin, moved[(i + 1) % 3] - origin);
  TexelSum sum(*image);
  coverage.for_each([&](int column, int row, float share) {
    const int x = wrapped(static_cast<int>(origin.x) + column, size.x, wrap_s);
    const int y = wrapped(static_cast<int>(origin.y) + row, size.y, wrap_t);
    sum.add(image->texel(*level, x, y), share);
  });
  // A triangle without area in the texture is the colour at its middle.
  return sum.weight() > 0.0F ? sum.mean() : at((uv[0] + uv[1] + uv[2]) / 3.0F);
}

Result<TextureSlot> TextureLibrary::slot(const Json& info, TexelKind kind) {
  // Texture coordinates.
  TextureSlot slot;
  slot.texcoord = info.value("texCoord", 0);
  if (const Json* transform = extension_of(info, "KHR_texture_transform")) {
    slot.texcoord = transform->value("texCoord", slot.texcoord);
    slot.rotation = transform->value("rotation", 0.0F);
    const auto pair = [&](const char* key, glm::vec2 fallback) {
      const auto it = transform->find(key);
      return it == transform->end() ? fallback : glm::vec2((*it)[0].get<float>(), (*it)[1].get<float>());
    };
    slot.offset = pair("offset", slot.offset);
    slot.scale = pair("scale", slot.scale);
  }

  // Sampler.
  const auto index = info["index"].get<std::size_t>();
  const Json& texture = document_.json["textures"][index];
  if (texture.contains("sampler")) {
    const Json& sampler = document_.json["samplers"][texture["sampler"].get<std::size_t>()];
    slot.wrap_s = wrap_of(sampler, "wrapS");
    slot.wrap_t = wrap_of(sampler, "wrapT");
  }

  // Image.
  auto image = image_of(index, kind);
  if (!image) return image.error();
  slot.image = std::move(*image);
  return slot;
}

Result<std::shared_ptr<const MipPyramid>> TextureLibrary::image_of(std::size_t texture, TexelKind kind) {
  const std::vector<std::size_t> sources = image_sources(document_.json["textures"][texture]);
  const std::string place = place_of("textures", texture);
  if (sources.empty()) return bad_input(place, "has no image");
  std::string_view unread;
  std::shared_ptr<const MipPyramid> image;
  for (const std::size_t source : sources) {
    image = decoded_[{source, kind}];
    if (image) break;
    const Result<Bytes> bytes = image_bytes(document_, source);
    if (!bytes) return bytes.error();
    unread = unsupported_format(*bytes);
    if (!unread.empty()) continue;
    MemoryBudget& memory = *document_.memory;
    Result<Pixels> pixels = decode_image(*bytes, place_of("images", source), &memory);
    if (!pixels) return pixels.error();
    constexpr std::uint64_t kBytesPerTexel = 6;  // with coarser levels
    auto fits = memory.reserve(pixels->rgba.size() / 4, kBytesPerTexel, place_of("images", source), "pixels");
    if (!fits) return fits.error();
    image = decoded_[{source, kind}] = make_pyramid(std::move(*pixels), kind);
    break;
  }
  if (unread_.contains(texture) || (image && image == decoded_[{sources.front(), kind}])) return image;
  unread_.insert(texture);
  warnings_.push_back(
      image ? Warning{"texture-fallback", place, "the format of its image cannot be decoded; the plain image was used"}
            : Warning{"texture-unread", place,
                      fmt::format("{} images cannot be decoded and there is no plain one; the light "
                                  "was computed as if the texture was white",
                                  unread)});
  return image;
}

}  // namespace gltf_radiosity
