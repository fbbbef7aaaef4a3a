#include "plugin/image_decode.h"

#include <gtest/gtest.h>
#include <jpeglib.h>
#include <png.h>
#include <webp/encode.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

/// A PNG of one of libpng's simple formats.
Bytes encode_png_as(png_uint_32 format, png_uint_32 width, png_uint_32 height, const void* pixels,
                    const void* palette = nullptr, png_uint_32 palette_size = 0) {
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = format;
  image.colormap_entries = palette_size;
  Bytes bytes(4096);
  png_alloc_size_t size = bytes.size();
  EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, palette), 0);
  bytes.resize(size);
  return bytes;
}

Bytes encode_jpeg(J_COLOR_SPACE space, int components, const std::vector<std::uint8_t>& row, bool progressive = false) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = static_cast<JDIMENSION>(row.size()) / static_cast<JDIMENSION>(components);
  jpeg.image_height = 1;
  jpeg.input_components = components;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  JSAMPROW pointer = const_cast<JSAMPROW>(row.data());
  jpeg_write_scanlines(&jpeg, &pointer, 1);
  jpeg_finish_compress(&jpeg);
  const Bytes bytes(memory, memory + size);
  jpeg_destroy_compress(&jpeg);
  std::free(memory);
  return bytes;
}

std::vector<std::uint8_t> pixels_of(const Bytes& bytes) {
  const auto pixels = decode_image(bytes, "images[0]");
  EXPECT_TRUE(pixels) << pixels.error().text();
  return pixels ? pixels->rgba : std::vector<std::uint8_t>();
}

std::string image_verdict(const Bytes& bytes) {
  const auto pixels = decode_image(bytes, "images[0]");
  return pixels ? "fine" : pixels.error().text();
}

TEST(ImageDecode, PngComesBackAsWritten) {
  const std::vector<std::uint8_t> rgba = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12,
                                          13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24};
  const auto pixels = decode_image(encode_png(3, 2, rgba), "");
  ASSERT_TRUE(pixels) << pixels.error().text();
  EXPECT_EQ(pixels->width, 3);
  EXPECT_EQ(pixels->height, 2);
  EXPECT_EQ(pixels->rgba, rgba);
}

TEST(ImageDecode, EveryPngBecomesRgba) {
  const std::uint8_t gray[] = {7, 200};
  EXPECT_EQ(pixels_of(encode_png_as(PNG_FORMAT_GRAY, 2, 1, gray)), (Bytes{7, 7, 7, 255, 200, 200, 200, 255}));
  const std::uint8_t gray_alpha[] = {7, 100};
  EXPECT_EQ(pixels_of(encode_png_as(PNG_FORMAT_GA, 1, 1, gray_alpha)), (Bytes{7, 7, 7, 100}));
  const std::uint8_t rgb[] = {1, 2, 3};
  EXPECT_EQ(pixels_of(encode_png_as(PNG_FORMAT_RGB, 1, 1, rgb)), (Bytes{1, 2, 3, 255}));
  const std::uint8_t palette[] = {9, 8, 7, 255, 4, 5, 6, 50}, indices[] = {1, 0};
  EXPECT_EQ(pixels_of(encode_png_as(PNG_FORMAT_RGBA_COLORMAP, 2, 1, indices, palette, 2)),
            (Bytes{4, 5, 6, 50, 9, 8, 7, 255}));
}

TEST(ImageDecode, SixteenBitsKeepTheirUpperEight) {
  // Half linear is stored as is: libpng marks the file as linear, the numbers stay.
  const std::uint16_t linear[] = {0x8000, 0xffff, 0x0100};
  EXPECT_EQ(pixels_of(encode_png_as(PNG_FORMAT_LINEAR_RGB, 1, 1, linear)), (Bytes{0x80, 0xff, 0x01, 255}));
}

TEST(ImageDecode, JpegInColorGrayAndCmyk) {
  const auto near = [](const Bytes& got, const Bytes& wanted) {
    ASSERT_EQ(got.size(), wanted.size());
    for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted[i], 3) << i;
  };
  near(pixels_of(encode_jpeg(JCS_RGB, 3, {200, 100, 50})), {200, 100, 50, 255});
  near(pixels_of(encode_jpeg(JCS_GRAYSCALE, 1, {90})), {90, 90, 90, 255});
  // libjpeg marks CMYK as Adobe's, which stores it inverted: 255 is no ink.
  near(pixels_of(encode_jpeg(JCS_CMYK, 4, {255, 128, 0, 255})), {255, 128, 0, 255});
}

TEST(ImageDecode, Webp) {
  const std::uint8_t rgba[] = {10, 20, 30, 255, 40, 50, 60, 70};
  std::uint8_t* encoded = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(rgba, 2, 1, 8, &encoded);
  const Bytes bytes(encoded, encoded + size);
  WebPFree(encoded);
  EXPECT_EQ(pixels_of(bytes), (Bytes{10, 20, 30, 255, 40, 50, 60, 70}));
}

TEST(ImageDecode, TruncatedImagesAreRefused) {
  const Bytes png = encode_png(3, 2, std::vector<std::uint8_t>(24, 9));
  for (std::size_t size = 0; size + 16 < png.size(); ++size) {
    EXPECT_NE(image_verdict({png.begin(), png.begin() + static_cast<std::ptrdiff_t>(size)}), "fine") << size;
  }
  const Bytes jpeg = encode_jpeg(JCS_RGB, 3, {200, 100, 50});
  EXPECT_EQ(image_verdict({jpeg.begin(), jpeg.begin() + 30}), "images[0]: the JPEG image is broken");
}

TEST(ImageDecode, FlippedBytesNeverCrash) {
  const Bytes sound[] = {encode_png(3, 2, std::vector<std::uint8_t>(24, 9)),
                         encode_jpeg(JCS_RGB, 3, {200, 100, 50, 1, 2, 3})};
  for (const Bytes& bytes : sound) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      Bytes changed = bytes;
      changed[i] ^= 0xff;
      const auto pixels = decode_image(changed, "");
      EXPECT_TRUE(!pixels || pixels->rgba.size() == static_cast<std::size_t>(pixels->width * pixels->height) * 4);
    }
  }
}

/// The checksum of a PNG's chunk (PNG 1.2, appendix 15).
std::uint32_t png_checksum(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0xffffffffU;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~sum;
}

/// A PNG whose header is sound and says this size.
Bytes png_of_size(std::uint32_t width, std::uint32_t height) {
  Bytes png = encode_png(3, 2, std::vector<std::uint8_t>(24, 9));
  const auto write = [&png](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) png[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  };
  write(16, width);
  write(20, height);
  write(29, png_checksum(std::span(png).subspan(12, 17)));
  return png;
}

TEST(ImageDecode, HugeSizesAreRefusedBeforeMemoryIsTaken) {
  EXPECT_EQ(image_verdict(png_of_size(3, 2)), "fine");
  EXPECT_EQ(image_verdict(png_of_size(65535, 65535)),
            "images[0]: the PNG image has 65535 x 65535 pixels, more than 2^28");
  EXPECT_EQ(image_verdict(png_of_size(0x7fffffff, 0x7fffffff)),
            "images[0]: the PNG image has 2147483647 x 2147483647 pixels, more than 2^28");
}

TEST(ImageDecode, SizesThatDoNotFitIntoMemoryAreALimit) {
  const MemoryBudget memory(std::uint64_t{1} << 30U);
  EXPECT_TRUE(decode_image(png_of_size(3, 2), "images[0]", &memory));
  const auto pixels = decode_image(png_of_size(16000, 16000), "images[0]", &memory);
  ASSERT_FALSE(pixels);
  EXPECT_EQ(pixels.error().code, ErrorCode::kLimit);
  EXPECT_EQ(
      pixels.error().text(),
      "images[0]: 256000000 pixels (16000 x 16000) need about 2.86 GiB, and of --max-memory, 1 GiB, 1 GiB are left");
}

TEST(ImageDecode, OtherFormatsAreNamed) {
  EXPECT_EQ(image_verdict({0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb}), "images[0]: KTX2 textures are not supported");
  EXPECT_EQ(image_verdict({}), "images[0]: is neither PNG, JPEG nor WebP");
}

// Found by fuzz_image: 673 bytes became 42 million grey pixels.
TEST(ImageDecode, AJpegOfMorePixelsThanItsBytesCanHoldIsRefused) {
  Bytes jpeg = encode_jpeg(JCS_GRAYSCALE, 1, {90});
  const Bytes marker = {0xff, 0xc0};
  const auto frame = std::search(jpeg.begin(), jpeg.end(), marker.begin(), marker.end());
  const Bytes size = {0x20, 0x00, 0x40, 0x00};  // 8192 rows of 16384
  std::copy(size.begin(), size.end(), frame + 5);
  EXPECT_EQ(image_verdict(jpeg), "images[0]: the JPEG image is broken");
}

// Each scan costs as much as the whole image, however short it is.
TEST(ImageDecode, AJpegOfHundredsOfScansIsRefused) {
  Bytes jpeg = encode_jpeg(JCS_GRAYSCALE, 1, {90}, true);
  const Bytes marker = {0xff, 0xda};
  const auto last = std::find_end(jpeg.begin(), jpeg.end(), marker.begin(), marker.end());
  const Bytes scan(last, jpeg.end() - 2);
  EXPECT_EQ(image_verdict(jpeg), "fine");
  for (int k = 0; k < 300; ++k) jpeg.insert(jpeg.end() - 2, scan.begin(), scan.end());
  EXPECT_EQ(image_verdict(jpeg), "images[0]: the JPEG image is broken");
}

}  // namespace
}  // namespace gltf_radiosity
