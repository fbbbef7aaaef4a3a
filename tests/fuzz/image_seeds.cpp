#include "tests/fuzz/image_seeds.h"

#include <jpeglib.h>
#include <png.h>
#include <webp/encode.h>

#include <cstdlib>
#include <cstring>

namespace gltf_radiosity::fuzz {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kWidth = 21, kHeight = 17;

/// Something that compresses, but not to nothing: [kHeight * kWidth * bands].
Bytes pixels(int bands) {
  Bytes bytes(static_cast<std::size_t>(kWidth * kHeight * bands));
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<std::uint8_t>(k * k / 7);
  return bytes;
}

void append_png_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto& to = *static_cast<Bytes*>(png_get_io_ptr(png));
  to.insert(to.end(), bytes, bytes + count);
}

Bytes png_seed(int color_type, int depth, int interlace) {
  Bytes bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, append_png_bytes, nullptr);
  png_set_IHDR(png, info, kWidth, kHeight, depth, color_type, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[] = {{10, 20, 30}, {200, 100, 0}, {0, 255, 9}, {255, 255, 255}};
  const png_byte alphas[] = {0, 128, 255};
  if (color_type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette, 4);
    png_set_tRNS(png, info, alphas, 3, nullptr);
  }
  png_write_info(png, info);
  Bytes rows(std::size_t{kHeight} * kWidth * 8);
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<std::uint8_t>(k * k / 5);
  std::vector<png_bytep> pointers;
  for (std::size_t y = 0; y < kHeight; ++y) pointers.push_back(rows.data() + y * kWidth * 8);
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

Bytes jpeg_seed(J_COLOR_SPACE space, int bands, bool progressive, bool arithmetic) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = kWidth;
  jpeg.image_height = kHeight;
  jpeg.input_components = bands;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  jpeg.arith_code = arithmetic ? TRUE : FALSE;
  jpeg.restart_interval = arithmetic ? 2 : 0;
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  Bytes rows = pixels(bands);
  for (std::size_t y = 0; y < kHeight; ++y) {
    JSAMPROW row = rows.data() + y * kWidth * static_cast<std::size_t>(bands);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  const Bytes bytes(memory, memory + size);
  jpeg_destroy_compress(&jpeg);
  std::free(memory);
  return bytes;
}

Bytes webp_seed(bool lossless, int bands) {
  const Bytes rows = pixels(bands);
  std::uint8_t* memory = nullptr;
  const int stride = kWidth * bands;
  std::size_t size = 0;
  if (lossless && bands == 3) size = WebPEncodeLosslessRGB(rows.data(), kWidth, kHeight, stride, &memory);
  if (lossless && bands == 4) size = WebPEncodeLosslessRGBA(rows.data(), kWidth, kHeight, stride, &memory);
  if (!lossless && bands == 3) size = WebPEncodeRGB(rows.data(), kWidth, kHeight, stride, 50.0F, &memory);
  if (!lossless && bands == 4) size = WebPEncodeRGBA(rows.data(), kWidth, kHeight, stride, 50.0F, &memory);
  const Bytes bytes(memory, memory + size);
  WebPFree(memory);
  return bytes;
}

}  // namespace

std::vector<Bytes> image_seeds() {
  std::vector<Bytes> seeds;
  for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
    for (const int depth : {8, 16}) {
      for (const int color :
           {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGBA}) {
        seeds.push_back(png_seed(color, depth, interlace));
      }
    }
    seeds.push_back(png_seed(PNG_COLOR_TYPE_GRAY, 1, interlace));
    seeds.push_back(png_seed(PNG_COLOR_TYPE_PALETTE, 2, interlace));
  }
  for (const bool progressive : {false, true}) {
    for (const bool arithmetic : {false, true}) {
      seeds.push_back(jpeg_seed(JCS_GRAYSCALE, 1, progressive, arithmetic));
      seeds.push_back(jpeg_seed(JCS_RGB, 3, progressive, arithmetic));
      seeds.push_back(jpeg_seed(JCS_CMYK, 4, progressive, arithmetic));
    }
  }
  for (const bool lossless : {false, true}) {
    for (const int bands : {3, 4}) seeds.push_back(webp_seed(lossless, bands));
  }
  return seeds;
}

}  // namespace gltf_radiosity::fuzz
