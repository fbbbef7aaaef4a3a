#include "tools/batch.h"

#include <gtest/gtest.h>

namespace gltf_radiosity::tools {
namespace {

CommandLine line_with(int jobs, int threads, std::uint64_t max_memory) {
  CommandLine line;
  line.jobs = jobs;
  line.options.threads = threads;
  line.options.max_memory = max_memory;
  return line;
}

TEST(BatchShares, DivideThreadsAndMemoryAmongJobs) {
  const BatchShares shares = batch_shares(line_with(4, 10, std::uint64_t{8} << 30U), 100);
  EXPECT_EQ(shares.jobs, 4);
  EXPECT_EQ(shares.threads, 2);
  EXPECT_EQ(shares.max_memory, std::uint64_t{2} << 30U);
}

TEST(BatchShares, AJobForEachThreadUnlessAsked) {
  EXPECT_EQ(batch_shares(line_with(0, 6, 0), 100).jobs, 6);
  EXPECT_EQ(batch_shares(line_with(0, 6, 0), 100).threads, 1);
}

TEST(BatchShares, NoMoreJobsThanFiles) {
  const BatchShares shares = batch_shares(line_with(8, 8, std::uint64_t{8} << 30U), 2);
  EXPECT_EQ(shares.jobs, 2);
  EXPECT_EQ(shares.threads, 4);
  EXPECT_EQ(shares.max_memory, std::uint64_t{4} << 30U);
}

TEST(BatchShares, NeverTooLittleToWorkWith) {
  const BatchShares shares = batch_shares(line_with(64, 2, std::uint64_t{64} << 20U), 100);
  EXPECT_EQ(shares.threads, 1);
  EXPECT_EQ(shares.max_memory, std::uint64_t{64} << 20U);
}

}  // namespace
}  // namespace gltf_radiosity::tools
