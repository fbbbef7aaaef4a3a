#include "tools/batch_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

using testing::HasSubstr;

BatchResult ended_with(std::optional<int> exit_code) { return {exit_code, 1.5, 3U << 20U, "an\noutcome", "{}"}; }

int code_of(const std::vector<std::optional<int>>& exit_codes, int signal = 0) {
  std::vector<BatchResult> results;
  for (const std::optional<int>& code : exit_codes) results.push_back(ended_with(code));
  return batch_exit_code(results, signal);
}

TEST(BatchExitCode, IsZeroIfAllAreDone) { EXPECT_EQ(code_of({0, 0}), kExitDone); }

TEST(BatchExitCode, IsThatOfTheWorst) {
  EXPECT_EQ(code_of({0, 2, 0}), kExitUsage);
  EXPECT_EQ(code_of({2, 1, 0}), kExitBadInput);
  EXPECT_EQ(code_of({4, 1, 2}), kExitLimit);
  EXPECT_EQ(code_of({4, 3, 1}), kExitCannotWrite);
  EXPECT_EQ(code_of({3, 70, 1}), kExitInternal);
}

TEST(BatchExitCode, CountsCrashesAsBugsAndKillsAsLimits) {
  EXPECT_EQ(code_of({1, 139}), kExitInternal);
  EXPECT_EQ(code_of({1, 137}), kExitLimit);
}

TEST(BatchExitCode, IsTheSignalsIfItWasInterrupted) {
  EXPECT_EQ(code_of({130, std::nullopt}, 2), 130);
  EXPECT_EQ(code_of({0, 70}, 15), 143);
}

TEST(BatchLine, NamesFileOutcomeAndTimeOnOneLine) {
  EXPECT_EQ(batch_line({"a\nb.glb", "out"}, ended_with(0), 3, 20),
            "gltf-radiosity: [3/20] a b.glb: an outcome, 1.50 s\n");
  EXPECT_EQ(batch_line({"a.glb", "out"}, ended_with(1), 3, 20),
            "gltf-radiosity: [3/20] a.glb: error: an outcome, 1.50 s\n");
}

TEST(BatchTable, HasARowForEachFileAndTheTotals) {
  const std::vector<BatchFile> files{{"a.glb", "o/a.glb"}, {"b.glb", "o/b.glb"}, {"c.glb", "o/c.glb"}};
  const std::vector<BatchResult> results{ended_with(0), ended_with(1), {}};
  EXPECT_EQ(batch_table({files, results, 1, 2, 4.25}),
            "result        seconds    memory  file\n"
            "done             1.50      3 MB  a.glb\n"
            "exit 1           1.50      3 MB  b.glb: an outcome\n"
            "not started      0.00      0 MB  c.glb\n"
            "gltf-radiosity: batch: 1 of 3 files baked, 1 failed, 1 not started, 4.25 s\n");
}

TEST(BatchJson, EscapesNamesAndTakesTheReportsAsTheyAre) {
  const std::vector<BatchFile> files{{"a\"\xff.glb", "o/a.glb"}, {"b.glb", "o/b.glb"}};
  const std::vector<BatchResult> results{{0, 1.5, 3, "", "{\n  \"version\": 1\n}"}, {}};
  const std::string json = to_json(BatchSummary{files, results, 0, 2, 4.25});
  EXPECT_THAT(json, HasSubstr("\"input\": \"a\\\"\\ufffd.glb\""));
  EXPECT_THAT(json, HasSubstr("\"report\": {\n        \"version\": 1\n      }"));
  EXPECT_THAT(json, HasSubstr("\"exitCode\": null"));
  EXPECT_THAT(json, HasSubstr("\"report\": null"));
}

}  // namespace
}  // namespace gltf_radiosity::tools
