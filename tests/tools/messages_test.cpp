#include "tools/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace gltf_radiosity::tools {
namespace {

TEST(ErrorLine, IsOneLineThatNamesTheProgram) {
  EXPECT_EQ(error_line("meshes[3].primitives[0]: no POSITION"),
            "gltf-radiosity: error: meshes[3].primitives[0]: no POSITION\n");
}

TEST(ErrorLine, StaysOneLineWhateverTheFileNamesThings) {
  const std::string line = error_line("a\nb\r\x1b[2Jc\x7f");
  EXPECT_EQ(line, "gltf-radiosity: error: a b  [2Jc \n");
}

TEST(ErrorLine, KeepsNamesInOtherScripts) { EXPECT_EQ(one_line("Küche 台所"), "Küche 台所"); }

TEST(WarningLine, EndsWithItsCode) {
  EXPECT_EQ(warning_line({"default-sky", "", "no light"}), "gltf-radiosity: warning: no light [default-sky]\n");
  EXPECT_EQ(warning_line({"skin", "nodes[3]", "rest\npose"}), "gltf-radiosity: warning: nodes[3]: rest pose [skin]\n");
}

TEST(SummaryLine, CountsWhatWasWritten) {
  Report report;
  report.output_triangles = 12;
  report.output_vertices = 24;
  report.exposure = 0.25;
  EXPECT_EQ(summary_line("out.glb", report, 1.234),
            "gltf-radiosity: out.glb: 12 triangles, 24 vertices, 1.23 s, exposure 0.25 m2/cd\n");
}

}  // namespace
}  // namespace gltf_radiosity::tools
