#include "plugin/our_extras.h"

#include <gtest/gtest.h>

namespace gltf_radiosity {
namespace {

TEST(OurExtras, StandBesideThoseOfOthers) {
  Json owner = Json::parse(R"({"extras": {"theirs": 1}})");
  our_extras(owner)["ours"] = 2;
  our_extras(owner)["more"] = 3;
  EXPECT_EQ(owner, Json::parse(R"({"extras": {"theirs": 1, "radiosity": {"ours": 2, "more": 3}}})"));
}

TEST(OurExtras, ExtrasThatAreNoObjectAreKept) {
  for (const char* text : {"[1]", "null", "\"word\""}) {
    Json owner = Json::object();
    owner["extras"] = Json::parse(text);
    our_extras(owner) = 2;
    EXPECT_EQ(owner["extras"]["original"], Json::parse(text));
    EXPECT_EQ(owner["extras"]["radiosity"], 2);
  }
}

}  // namespace
}  // namespace gltf_radiosity
