#include "plugin/base64.h"

#include <gtest/gtest.h>

#include <string>

namespace gltf_radiosity {
namespace {

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Base64, GivesWhatTheStandardSays) {
  // RFC 4648, section 10.
  EXPECT_EQ(encode_base64({}), "");
  EXPECT_EQ(encode_base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(encode_base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(encode_base64(bytes_of("foo")), "Zm9v");
  EXPECT_EQ(encode_base64(bytes_of("foobar")), "Zm9vYmFy");
}

TEST(Base64, EveryByteComesBack) {
  Bytes bytes;
  for (int length = 0; length < 300; ++length) {
    EXPECT_EQ(decode_base64(encode_base64(bytes)), bytes) << length;
    bytes.push_back(static_cast<std::uint8_t>(length * 37));
  }
}

TEST(Base64, TakesTheAlphabetOfUrlsAndNoPadding) { EXPECT_EQ(decode_base64("_-8"), (Bytes{0xff, 0xef})); }

TEST(Base64, WhatIsNoDigitIsRefused) {
  for (const char* broken : {"Zm9v!", "Zm 9v", "Z", "Zm9vY", "Zm=v"}) EXPECT_FALSE(decode_base64(broken)) << broken;
}

}  // namespace
}  // namespace gltf_radiosity
