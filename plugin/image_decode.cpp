#include "plugin/image_decode.h"

#include <fmt/format.h>
#include <jpeglib.h>
#include <png.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs FILE
#include <cstring>
#include <new>

namespace gltf_radiosity {
namespace {

constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;

/// What a pixel takes while it is decoded: RGBA, and the coefficients of a progressive JPEG.
constexpr std::uint64_t kBytesPerPixel = 12;

/// Where an image is decoded to.
struct ImageTarget {
  Pixels pixels;
  std::uint64_t max_pixels = kMaxPixels;
  std::uint64_t width = 0, height = 0;  ///< what the file says

  /// Makes room; false if the image is empty, larger than allowed, or has more than the `most` pixels it can have.
  bool allocate(std::uint64_t said_width, std::uint64_t said_height, std::uint64_t most = kMaxPixels) {
    width = said_width;
    height = said_height;
    if (width == 0 || height == 0 || is_too_large() || width * height > most) return false;
    pixels.width = static_cast<int>(width);
    pixels.height = static_cast<int>(height);
    pixels.rgba.resize(width * height * 4);
    return true;
  }
  bool is_too_large() const { return width > kMaxPixels || height > kMaxPixels || width * height > max_pixels; }
};

/// The most pixels that a PNG or JPEG of so many bytes can have: deflate makes up to 1032 bytes of one, of 8 pixels
/// each, and JPEG less. What costs nothing is let through: a file may be cut off.
std::uint64_t most_pixels_in(std::size_t bytes) {
  constexpr std::uint64_t kFreePixels = std::uint64_t{1} << 24U, kMaxPixelsPerByte = std::uint64_t{1032} * 8;
  return kFreePixels + kMaxPixelsPerByte * bytes;
}

// PNG. libpng leaves through longjmp, so nothing with a destructor lives in the function that is left.

struct PngSource {
  std::span<const std::uint8_t> left;
};

void read_png_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
  if (count > source->left.size()) png_error(png, "truncated");
  std::memcpy(to, source->left.data(), count);
  source->left = source->left.subspan(count);
}

[[noreturn]] void leave_png(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void ignore_png_warning(png_structp, png_const_charp) {}

/// Asks libpng for 8-bit RGBA, whatever the file holds.
void expect_rgba(png_structp png, png_infop info) {
  png_set_expand(png);  // palettes, fewer than 8 bits, tRNS
  png_set_strip_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

bool read_png(png_structp png, png_infop info, PngSource& source, ImageTarget& target) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &source, read_png_bytes);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
  png_read_info(png, info);
  const std::uint64_t most = most_pixels_in(source.left.size());
  if (!target.allocate(png_get_image_width(png, info), png_get_image_height(png, info), most)) return false;
  Pixels& pixels = target.pixels;
  expect_rgba(png, info);
  const std::size_t row_size = static_cast<std::size_t>(pixels.width) * 4;
  if (png_get_rowbytes(png, info) != row_size) return false;
  // Interlaced images come in several passes over the same rows.
  const int passes = png_get_interlace_type(png, info) == PNG_INTERLACE_NONE ? 1 : PNG_INTERLACE_ADAM7_PASSES;
  for (int pass = 0; pass < passes; ++pass) {
    for (int row = 0; row < pixels.height; ++row) {
      png_read_row(png, pixels.rgba.data() + static_cast<std::size_t>(row) * row_size, nullptr);
    }
  }
  return true;
}

bool decode_png(std::span<const std::uint8_t> bytes, ImageTarget& target) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leave_png, ignore_png_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  PngSource source{bytes};
  bool decoded = false;
  try {
    decoded = info != nullptr && read_png(png, info, source, target);
  } catch (const std::bad_alloc&) {
    decoded = false;
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return decoded;
}

// JPEG. The same holds for libjpeg.

struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf leave;
};

[[noreturn]] void leave_jpeg(j_common_ptr jpeg) {
  // The manager is the first member of JpegErrors (libjpeg.txt, "Error handling").
  std::longjmp(reinterpret_cast<JpegErrors*>(jpeg->err)->leave, 1);
}
void ignore_jpeg_message(j_common_ptr) {}

/// Every scan of a progressive image goes over all of it, and may be a few bytes long: a hundred, where ten are usual.
void stop_after_many_scans(j_common_ptr jpeg) {
  constexpr int kMaxScans = 100;
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMaxScans) leave_jpeg(jpeg);
}

/// CMYK as Adobe stores it, inverted, to RGB.
void cmyk_to_rgba(std::uint8_t* row, int width, bool inverted) {
  for (int x = 0; x < width; ++x) {
    std::uint8_t* pixel = row + static_cast<std::size_t>(x) * 4;
    const unsigned key = inverted ? pixel[3] : 255U - pixel[3];
    for (int band = 0; band < 3; ++band) {
      const unsigned ink = inverted ? pixel[band] : 255U - pixel[band];
      pixel[band] = static_cast<std::uint8_t>(ink * key / 255U);
    }
    pixel[3] = 255;
  }
}

bool read_jpeg(jpeg_decompress_struct& jpeg, std::span<const std::uint8_t> bytes, ImageTarget& target) {
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  if (jpeg_read_header(&jpeg, TRUE) != JPEG_HEADER_OK) return false;
  const bool cmyk = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
  jpeg.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
  if (!target.allocate(jpeg.image_width, jpeg.image_height, most_pixels_in(bytes.size()))) return false;
  Pixels& pixels = target.pixels;
  jpeg_start_decompress(&jpeg);
  if (jpeg.output_components != 4) return false;
  while (jpeg.output_scanline < jpeg.output_height) {
    std::uint8_t* row =
        pixels.rgba.data() + std::size_t{jpeg.output_scanline} * static_cast<std::size_t>(pixels.width) * 4;
    jpeg_read_scanlines(&jpeg, &row, 1);
    if (cmyk) cmyk_to_rgba(row, pixels.width, jpeg.saw_Adobe_marker != FALSE);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

bool decode_jpeg(std::span<const std::uint8_t> bytes, ImageTarget& target) {
  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};
  jpeg_progress_mgr scans{};
  scans.progress_monitor = stop_after_many_scans;
  jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = leave_jpeg;
  errors.manager.output_message = ignore_jpeg_message;
  volatile bool decoded = false;
  if (setjmp(errors.leave) == 0) {
    jpeg_create_decompress(&jpeg);
    jpeg.progress = &scans;
    try {
      decoded = read_jpeg(jpeg, bytes, target);
    } catch (const std::bad_alloc&) {
      decoded = false;
    }
  }
  jpeg_destroy_decompress(&jpeg);
  return decoded;
}

// WebP.

bool decode_webp(std::span<const std::uint8_t> bytes, ImageTarget& target) {
  int width = 0, height = 0;
  if (WebPGetInfo(bytes.data(), bytes.size(), &width, &height) == 0 || width <= 0 || height <= 0) return false;
  if (!target.allocate(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height))) return false;
  Pixels& pixels = target.pixels;
  return WebPDecodeRGBAInto(bytes.data(), bytes.size(), pixels.rgba.data(), pixels.rgba.size(), width * 4) != nullptr;
}

using Decoder = bool (*)(std::span<const std::uint8_t>, ImageTarget&);

struct ImageFormat {
  std::size_t at;
  std::string_view signature, name;
  Decoder decoder;  ///< null: there is none
};
constexpr std::array<ImageFormat, 6> kImageFormats = {{{0, "\x89PNG", "PNG", decode_png},
                                                       {0, "\xff\xd8\xff", "JPEG", decode_jpeg},
                                                       {0, "RIFF", "WebP", decode_webp},
                                                       {0, "\xabKTX 20\xbb", "KTX2", nullptr},
                                                       {0, "DDS ", "DDS", nullptr},
                                                       {4, "ftypavif", "AVIF", nullptr}}};

/// Told by content; null if it is none of them.
const ImageFormat* format_of(std::span<const std::uint8_t> bytes) {
  const auto* format = std::find_if(kImageFormats.begin(), kImageFormats.end(), [&bytes](const ImageFormat& known) {
    return bytes.size() >= known.at + known.signature.size() &&
           std::memcmp(bytes.data() + known.at, known.signature.data(), known.signature.size()) == 0;
  });
  return format == kImageFormats.end() ? nullptr : format;
}

}  // namespace

Result<Pixels> decode_image(std::span<const std::uint8_t> bytes, const std::string& place, const MemoryBudget* memory) {
  const ImageFormat* format = format_of(bytes);
  if (format == nullptr) return bad_input(place, "is neither PNG, JPEG nor WebP");
  if (format->decoder == nullptr) return bad_input(place, fmt::format("{} textures are not supported", format->name));
  ImageTarget target;
  if (memory != nullptr) target.max_pixels = std::min(kMaxPixels, memory->left() / kBytesPerPixel);
  if (format->decoder(bytes, target)) return std::move(target.pixels);
  if (!target.is_too_large()) return bad_input(place, fmt::format("the {} image is broken", format->name));
  const std::string size = fmt::format("{} x {}", target.width, target.height);
  if (target.max_pixels == kMaxPixels) {
    return bad_input(place, fmt::format("the {} image has {} pixels, more than 2^28", format->name, size));
  }
  return memory->check(target.width * target.height, kBytesPerPixel, place, fmt::format("pixels ({})", size)).error();
}

std::string_view unsupported_format(std::span<const std::uint8_t> bytes) {
  const ImageFormat* format = format_of(bytes);
  return format != nullptr && format->decoder == nullptr ? format->name : std::string_view();
}

}  // namespace gltf_radiosity
