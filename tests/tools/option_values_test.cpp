#include "tools/option_values.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace gltf_radiosity::tools {
namespace {

TEST(ParseNumber, ReadsDecimalNumbers) {
  EXPECT_EQ(parse_number("0.25", {}), 0.25);
  EXPECT_EQ(parse_number("1e3", {}), 1000.0);
  EXPECT_EQ(parse_number("-6.5", {-30.0, 30.0}), -6.5);
}

TEST(ParseNumber, RefusesWhatIsNoNumber) {
  for (const std::string_view text : {"", " 1", "1 ", "+1", "1x", "0x10", "nan", "NaN", "inf", "infinity", "1e400",
                                      "-inf", "1,5", "--1", "1.0f", "one"}) {
    EXPECT_THROW(parse_number(text, {-10.0, 10.0}), BadValue) << text;
  }
}

TEST(ParseNumber, KeepsToTheRange) {
  EXPECT_EQ(parse_number("0", {}), 0.0);
  EXPECT_THROW(parse_number("-0.001", {}), BadValue);
  EXPECT_THROW(parse_number("0", {.open = true}), BadValue);
  EXPECT_EQ(parse_number("0.5", {0.0, 1.0, true}), 0.5);
  EXPECT_THROW(parse_number("0", {0.0, 1.0, true}), BadValue);
  EXPECT_THROW(parse_number("1", {0.0, 1.0, true}), BadValue);
  EXPECT_EQ(parse_number("1", {0.0, 1.0}), 1.0);
}

TEST(ParseGroup, IsCutAtTheFirstEqualsSign) {
  EXPECT_EQ(parse_group("hall=lamp=*"), (std::pair<std::string, std::string>("hall", "lamp=*")));
  for (const std::string_view text : {"", "hall", "=lamp", "hall="}) EXPECT_THROW(parse_group(text), BadValue) << text;
}

TEST(ParseInteger, RefusesFractionsAndWhatIsOutOfRange) {
  EXPECT_EQ(parse_integer("32", 2, 512), 32);
  for (const std::string_view text : {"", "3.5", "1", "513", "99999999999999999999", "-4", "32x", "x", " 32", "3e1"}) {
    EXPECT_THROW(parse_integer(text, 2, 512), BadValue) << text;
  }
}

TEST(ParseTriple, WantsExactlyThreeNumbers) {
  const std::array<Range, 3> ranges{};
  EXPECT_EQ(parse_triple("0.1,2,3e2", ranges), (std::array{0.1, 2.0, 300.0}));
  for (const std::string_view text :
       {"", "1", "1,2", "1,2,3,4", "1,2,", ",,", "1, 2, 3", "1;2;3", "1,-2,3", "1,2,nan"}) {
    EXPECT_THROW(parse_triple(text, ranges), BadValue) << text;
  }
}

TEST(ParseSky, IsALuminanceOrAFile) {
  EXPECT_EQ(std::get<0>(parse_sky("1,2.5,0")), (std::array{1.0, 2.5, 0.0}));
  for (const std::string_view file : {"sky.hdr", "./1,2,3.hdr", "a,b,c", "2 suns.hdr"}) {
    EXPECT_EQ(std::get<1>(parse_sky(file)), file);
  }
  for (const std::string_view text : {"", "1", "1,1", "1,1,-1", "1,nan,1", "1,1,1e999", "1,2,3,4", ",,"}) {
    EXPECT_THROW(parse_sky(text), BadValue) << text;
  }
}

TEST(ParseSubdivide, CutsAtTheLastEqualsSign) {
  EXPECT_EQ(parse_subdivide("Floor=2"), (std::pair<std::string, int>("Floor", 2)));
  EXPECT_EQ(parse_subdivide("a=b=0"), (std::pair<std::string, int>("a=b", 0)));
  for (const std::string_view text : {"", "Floor", "=2", "Floor=", "Floor=9", "Floor=-1", "Floor=1.5", "Floor=x"}) {
    EXPECT_THROW(parse_subdivide(text), BadValue) << text;
  }
}

TEST(ParseBytes, CountsInPowersOf1024AndWantsASuffix) {
  EXPECT_EQ(parse_bytes("64M"), std::uint64_t{64} << 20U);
  EXPECT_EQ(parse_bytes("65536K"), std::uint64_t{64} << 20U);
  EXPECT_EQ(parse_bytes("8G"), std::uint64_t{8} << 30U);
  EXPECT_EQ(parse_bytes("1T"), std::uint64_t{1} << 40U);
  for (const std::string_view text : {"", "G", "8", "8g", "8GB", "-1G", "1.5G", "0G", "63M", "9999999999G"}) {
    EXPECT_THROW(parse_bytes(text), BadValue) << text;
  }
}

TEST(ParseSun, KeepsAnglesAndLightInRange) {
  const Sun sun = parse_sun("40,-120,80000");
  EXPECT_EQ(sun.elevation_degrees, 40.0);
  EXPECT_EQ(sun.azimuth_degrees, -120.0);
  EXPECT_EQ(sun.illuminance_lux, 80000.0);
  for (const std::string_view text : {"91,0,1", "-91,0,1", "0,361,1", "0,0,-1", "0,0", "40"}) {
    EXPECT_THROW(parse_sun(text), BadValue) << text;
  }
}

constexpr Choices<int, 2> kChoices{{{"one", 1}, {"two", 2}}};

TEST(ParseChoice, KnowsExactlyTheNames) {
  EXPECT_EQ(parse_choice("two", kChoices), 2);
  EXPECT_EQ(name_of(2, kChoices), "two");
  EXPECT_EQ(names_of(kChoices), "one|two");
  for (const std::string_view text : {"", "Two", "tw", "two ", "one|two"}) {
    EXPECT_THROW(parse_choice(text, kChoices), BadValue) << text;
  }
}

TEST(ParseChoice, NamesWhatItKnows) {
  try {
    parse_choice("three", kChoices);
    FAIL() << "nothing was thrown";
  } catch (const BadValue& bad) {
    EXPECT_STREQ(bad.what(), "'three' is not one of one|two");
  }
}

}  // namespace
}  // namespace gltf_radiosity::tools
