#include "plugin/hdr_decode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>

#include "tests/plugin/hdr_file.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;
using testing::HasSubstr;

std::string fault_of(const Bytes& bytes) {
  const auto image = decode_hdr(bytes, "sky.hdr");
  return image ? "nothing is wrong" : image.error().text();
}

Bytes text(std::string_view characters) { return {characters.begin(), characters.end()}; }

TEST(DecodeHdr, ReadsTexelsFromTheTop) {
  const std::vector<Rgb> texels = {{1, 0.5F, 0.25F}, {0, 0, 0}, {1024, 512, 8}, {0.001953125F, 0, 0}};
  const auto image = decode_hdr(encode_hdr(2, 2, texels), "sky.hdr");
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_EQ(image->width, 2);
  EXPECT_EQ(image->height, 2);
  EXPECT_EQ(image->texels, texels);
}

TEST(DecodeHdr, ReadsRunLengths) {
  Bytes bytes = hdr_header(8, 2);
  for (int row = 0; row < 2; ++row) {
    for (const int byte : {2, 2, 0, 8}) bytes.push_back(static_cast<std::uint8_t>(byte));
    for (const int value : {128, 64, 32, 129}) {
      bytes.push_back(128 + 8);
      bytes.push_back(static_cast<std::uint8_t>(value));
    }
  }
  const auto image = decode_hdr(bytes, "sky.hdr");
  ASSERT_TRUE(image) << image.error().text();
  EXPECT_EQ(image->texels, std::vector<Rgb>(16, Rgb(1.0F, 0.5F, 0.25F)));
  bytes.pop_back();
  EXPECT_EQ(fault_of(bytes), "sky.hdr: the HDR image is broken");
}

TEST(DecodeHdr, RefusesWhatIsNoHdrImage) {
  EXPECT_THAT(fault_of({}), HasSubstr("is not a Radiance HDR image"));
  EXPECT_THAT(fault_of(text("\x89PNG\r\n")), HasSubstr("is not a Radiance HDR image"));
  EXPECT_THAT(fault_of(text("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n....")), HasSubstr("is not"));
  EXPECT_THAT(fault_of(text("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -Y 1\n....")), HasSubstr("is not"));
  EXPECT_THAT(fault_of(hdr_header(0, 1)), HasSubstr("sky.hdr"));
  EXPECT_THAT(fault_of(hdr_header(-4, 1)), HasSubstr("sky.hdr"));
}

TEST(DecodeHdr, RefusesWhatBreaksOff) {
  const Bytes whole = encode_hdr(3, 2, std::vector<Rgb>(6, Rgb(1.0F)));
  const std::size_t header = hdr_header(3, 2).size();
  EXPECT_EQ(fault_of(whole), "nothing is wrong");
  for (std::size_t size = header; size + 4 <= whole.size(); size += 4) {
    EXPECT_EQ(fault_of(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
              "sky.hdr: the HDR image is broken")
        << size;
  }
}

TEST(DecodeHdr, RefusesWhatIsTooLargeBeforeDecodingIt) {
  EXPECT_EQ(fault_of(hdr_header(16385, 2)), "sky.hdr: the HDR image is larger than 16384 x 8192");
  EXPECT_EQ(fault_of(hdr_header(2, 8193)), "sky.hdr: the HDR image is larger than 16384 x 8192");
  const Bytes header = hdr_header(16384, 8192);
  EXPECT_EQ(fault_of(header), "sky.hdr: " + std::to_string(header.size()) + " bytes cannot hold 16384 x 8192 pixels");
  EXPECT_THAT(fault_of(hdr_header(2'000'000'000, 2'000'000'000)), HasSubstr("sky.hdr"));
}

TEST(DecodeHdr, RefusesLightBeyondAllMeasure) {
  Bytes bytes = hdr_header(1, 1);
  for (const int byte : {255, 255, 255, 255}) bytes.push_back(static_cast<std::uint8_t>(byte));
  EXPECT_EQ(fault_of(bytes), "sky.hdr: holds light that is negative, not finite or above 1e30");
}

}  // namespace
}  // namespace gltf_radiosity
