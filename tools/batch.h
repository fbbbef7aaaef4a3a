// Many bakes, each in a process of its own.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "tools/batch_report.h"

namespace gltf_radiosity::tools {

/// How the machine is shared by the files of a batch that are baked at once.
struct BatchShares {
  int jobs = 1;                  ///< files at once
  int threads = 1;               ///< for each
  std::uint64_t max_memory = 0;  ///< for each, bytes; 0: the default
};

/// Shares of what `line` gives to the whole batch; never more jobs than files.
BatchShares batch_shares(const CommandLine& line, std::size_t file_count);

/// What is told as each file ends: how it fared, and that in a line.
using BatchListener = std::function<void(const BatchResult& result, std::string_view text)>;

/// Bakes every file as `line` says, whatever happens to the others, until interrupted_by() says to stop. Answers
/// [files.size()] results.
std::vector<BatchResult> bake_batch(const CommandLine& line, std::span<const BatchFile> files,
                                    const BatchShares& shares, const BatchListener& say);

}  // namespace gltf_radiosity::tools
