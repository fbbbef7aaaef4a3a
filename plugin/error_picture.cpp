#include "plugin/error_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string_view>

#include "core/parallel.h"
#include "core/photometry.h"
#include "core/verify/camera.h"
#include "core/verify/path_tracer.h"
#include "core/verify/places.h"
#include "plugin/verified_places.h"

namespace gltf_radiosity {
namespace {

using radiosity::Ray;
using radiosity::Rgb;

constexpr int kSmoothing = 2;                                       ///< pixels to each side
constexpr std::uint64_t kPictureStreams = std::uint64_t{1} << 40U;  ///< of random numbers; places take those from 0
constexpr int kLegendHeight = 24;                                   ///< pixels

/// What is known of one pixel.
struct Pixel {
  Rgb displayed{0.0F};     ///< linear colour
  Rgb truth{0.0F};         ///< cd/m2, cut off at white as the display does
  glm::vec3 normal{0.0F};  ///< of the baked surface, any length; zero where there is none
};

std::uint8_t srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  const float encoded = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255.0F * encoded));
}

/// Blue, white, red, for errors from -1 to 1; linear.
Rgb false_color(float error) {
  const Rgb full = error < 0.0F ? Rgb(0.02F, 0.1F, 0.8F) : Rgb(0.8F, 0.03F, 0.02F);
  return glm::mix(Rgb(1.0F), full, std::min(std::abs(error), 1.0F));
}

/// Where panels and legend are written.
class Canvas {
 public:
  Canvas(int width, int height) {
    pixels_.width = width;
    pixels_.height = height;
    pixels_.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 255);
  }

  void set(int x, int y, const Rgb& linear) {
    const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels_.width) + static_cast<std::size_t>(x);
    for (int band = 0; band < 3; ++band) pixels_.rgba[at * 4 + static_cast<std::size_t>(band)] = srgb(linear[band]);
  }

  /// Digits, signs and %, 3 x 5 dots each, every dot two pixels wide; top left corner at x, y.
  void write(std::string_view text, int x, int y) {
    // Rows from the top, three bits each.
    constexpr std::string_view kGlyphs = "0123456789+-%";
    constexpr std::uint16_t kDots[] = {075557, 026227, 071747, 071717, 055711, 074717, 074757,
                                       071111, 075757, 075717, 002720, 000700, 051245};
    for (const char c : text) {
      const std::size_t glyph = kGlyphs.find(c);
      for (int dot = 0; glyph != std::string_view::npos && dot < 15 * 4; ++dot) {
        const int column = dot % 6, row = dot / 6;
        if ((kDots[glyph] >> (14 - (row / 2 * 3 + column / 2)) & 1) != 0) set(x + column, y + row, Rgb(0.0F));
      }
      x += 8;
    }
  }

  Pixels finish() { return std::move(pixels_); }

 private:
  Pixels pixels_;
};

/// Computes the pixels of all panels.
class Painter {
 public:
  Painter(const PicturedScenes& scenes, const PictureScale& scale, const VerifyOptions& options)
      : scenes_(scenes),
        scale_(scale),
        options_(options),
        tracer_(scenes.input_rays),
        baked_(baked_triangles(scenes.output)),
        white_(static_cast<float>(1.0 / scale.exposure)),
        camera_(camera_of(scenes.output_rays, options.camera)),
        input_step_(radiosity::surface_offset(scenes.input.scene)),
        output_step_(radiosity::surface_offset(scenes.output.scene)) {}

  Pixel paint(int x, int y) const {
    const int width = options_.camera.width;
    radiosity::Random random(options_.seed, kPictureStreams + static_cast<std::uint64_t>(y * width + x));
    Pixel pixel;
    const int samples = options_.image_samples;
    for (int s = 0; s < samples; ++s) {
      const float u = 2.0F * (static_cast<float>(x) + random.share()) / static_cast<float>(width) - 1.0F;
      const float v =
          1.0F - 2.0F * (static_cast<float>(y) + random.share()) / static_cast<float>(options_.camera.height);
      const Ray ray = camera_.ray(u, v);
      add_displayed(ray, random, pixel);
      pixel.truth += truth_along(ray, random);
    }
    pixel.displayed /= static_cast<float>(samples);
    // What is reflected is cut off on the mean: single paths are far brighter and far darker than it.
    pixel.truth = glm::min(pixel.truth / static_cast<float>(samples), white_);
    return pixel;
  }

  /// Relative error as Comparison has it, over kShownError.
  float shown_error(const Pixel& pixel) const {
    const double is = static_cast<double>(radiosity::luminance_of(pixel.displayed)) / scale_.exposure;
    const double should_be = static_cast<double>(radiosity::luminance_of(pixel.truth));
    return static_cast<float>((is - should_be) / (should_be + 0.1 * scale_.mean) / kShownError);
  }

 private:
  static radiosity::Camera camera_of(const radiosity::RayScene& rays, const VerifyCamera& wanted) {
    radiosity::View view = radiosity::default_view(rays);
    if (wanted.eye) view.eye = glm::vec3((*wanted.eye)[0], (*wanted.eye)[1], (*wanted.eye)[2]);
    if (wanted.at) view.at = glm::vec3((*wanted.at)[0], (*wanted.at)[1], (*wanted.at)[2]);
    if (view.eye == view.at) view.at.z -= 1.0F;
    const float aspect = static_cast<float>(wanted.width) / static_cast<float>(wanted.height);
    return radiosity::make_camera(view, static_cast<float>(wanted.fov_degrees), aspect);
  }

  void add_displayed(const Ray& ray, radiosity::Random& random, Pixel& pixel) const {
    const auto hit =
        radiosity::nearest_seen(scenes_.output_rays, ray, output_step_, [&random] { return random.share(); });
    if (!hit) {
      const Rgb sky = radiosity::sky_luminance(scenes_.input.scene, ray.direction);
      pixel.displayed += glm::min(sky * static_cast<float>(scale_.exposure), Rgb(1.0F));
      return;
    }
    pixel.displayed += scenes_.output.detail->unlit_color(hit->triangle, hit->at);
    if (baked_[hit->triangle] == 0) return;
    const glm::vec3 front = glm::normalize(radiosity::scaled_normal(scenes_.output.scene, hit->triangle));
    pixel.normal += hit->back ? -front : front;
  }

  /// Luminance; sky and emission cut off where white is, sample by sample as the display does.
  Rgb truth_along(const Ray& ray, radiosity::Random& random) const {
    const radiosity::Scene& scene = scenes_.input.scene;
    const auto hit =
        radiosity::nearest_seen(scenes_.input_rays, ray, input_step_, [&random] { return random.share(); });
    if (!hit) return glm::min(radiosity::sky_luminance(scene, ray.direction), white_);
    const radiosity::SurfacePlace place{hit->triangle, hit->at};
    const glm::vec3 front = radiosity::shading_normal(scene, place);
    const glm::vec3 position = radiosity::point_at(scene, place.triangle, place.at);
    const radiosity::PathSample path = tracer_.sample(position, hit->back ? -front : front, random);
    const Rgb emission = radiosity::mean_emission(scene, place.triangle, {{place.at, place.at, place.at}});
    return radiosity::reflected_luminance(displayed_reflectance(scenes_.input, place), path.irradiance) +
           glm::min(emission, white_);
  }

  const PicturedScenes& scenes_;
  const PictureScale& scale_;
  const VerifyOptions& options_;
  radiosity::PathTracer tracer_;
  std::vector<std::uint8_t> baked_;
  Rgb white_;  ///< the brightest that can be shown, cd/m2
  radiosity::Camera camera_;
  float input_step_, output_step_;  ///< metres behind a surface that is not seen
};

/// Pixels by row, and what is near them.
class Panel {
 public:
  Panel(std::vector<Pixel> pixels, int width, int height)
      : pixels_(std::move(pixels)), width_(width), height_(height) {}

  const Pixel& at(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  }

  /// The mean over the pixels around that lie on a surface of the same direction. REQUIRES: the pixel has a surface.
  Pixel around(int x, int y) const {
    constexpr float kSameDirection = 0.95F;
    Pixel sum;
    sum.normal = at(x, y).normal;
    float count = 0.0F;
    for (int j = std::max(y - kSmoothing, 0); j <= std::min(y + kSmoothing, height_ - 1); ++j) {
      for (int i = std::max(x - kSmoothing, 0); i <= std::min(x + kSmoothing, width_ - 1); ++i) {
        const Pixel& near = at(i, j);
        const float cosine = glm::dot(near.normal, sum.normal);
        if (!(cosine > kSameDirection * glm::length(near.normal) * glm::length(sum.normal))) continue;
        sum.displayed += near.displayed;
        sum.truth += near.truth;
        count += 1.0F;
      }
    }
    sum.displayed /= std::max(count, 1.0F);
    sum.truth /= std::max(count, 1.0F);
    return sum;
  }

 private:
  std::vector<Pixel> pixels_;
  int width_, height_;
};

/// -20%  |blue ... white ... red|  +20%
void draw_legend(Canvas& canvas, int left, int right, int top) {
  constexpr int kText = 36;
  const int first = left + kText, last = right - kText;
  for (int x = first; x < last; ++x) {
    const float share = static_cast<float>(x - first) / static_cast<float>(last - first);
    for (int y = top + 4; y < top + kLegendHeight - 4; ++y) canvas.set(x, y, false_color(2.0F * share - 1.0F));
  }
  canvas.write("-20%", left + 2, top + 7);
  canvas.write("+20%", last + 4, top + 7);
}

}  // namespace

Pixels draw_error(const PicturedScenes& scenes, const PictureScale& scale, const VerifyOptions& options,
                  const radiosity::Progress& progress) {
  // All pixels.
  const int width = options.camera.width, height = options.camera.height;
  const Painter painter(scenes, scale, options);
  std::vector<Pixel> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  radiosity::parallel_in_chunks(pixels.size(), 1024, progress, "image", [&](std::size_t i) {
    pixels[i] = painter.paint(static_cast<int>(i) % width, static_cast<int>(i) / width);
  });

  // Three panels.
  const Panel panel(std::move(pixels), width, height);
  Canvas canvas(3 * width, height + kLegendHeight);
  const auto exposure = static_cast<float>(scale.exposure);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Pixel& pixel = panel.at(x, y);
      canvas.set(x, y, pixel.displayed);
      canvas.set(x + width, y, pixel.truth * exposure);
      Rgb error(0.2F);
      if (pixel.normal != glm::vec3(0.0F)) error = false_color(painter.shown_error(panel.around(x, y)));
      canvas.set(x + 2 * width, y, error);
    }
  }
  draw_legend(canvas, 2 * width, 3 * width, height);
  return canvas.finish();
}

}  // namespace gltf_radiosity
