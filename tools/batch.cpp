#include "tools/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include "tools/child_processes.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/memory_limit.h"
#include "tools/report_file.h"

namespace gltf_radiosity::tools {
namespace {

using namespace std::chrono_literals;

/// How long an interrupted child may take to clean up before it is killed: the whole batch stops within a second.
constexpr auto kLastWords = 800ms;

/// With less memory nothing worth the while is baked.
constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20U;

int core_count() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

/// What a child does: bakes one file. The answer's first line is for people, the rest is the report.
int bake_one(const CommandLine& line, const BatchFile& file, const BatchShares& shares, std::string& answer) {
  // A folder that cannot be made is missing afterwards, and the bake says so.
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(file.output).parent_path(), ignored);

  Options options = line.options;
  limit_memory(shares.max_memory, shares.threads);
  options.threads = shares.threads;
  options.max_memory = shares.max_memory;
  Callbacks callbacks;
  callbacks.cancelled = [] { return interrupted_by() != 0; };
  const Result<Report> result = bake_file(file.input, file.output, options, callbacks);
  if (!result) {
    answer = result.error().text() + "\n" + to_json(result.error());
    return exit_code_of(result.error().code, interrupted_by());
  }
  const std::size_t warnings = result->warnings.size();
  answer = fmt::format("{} triangles, {} vertices{}\n{}", result->output_triangles, result->output_vertices,
                       warnings == 0 ? "" : fmt::format(", {} warning{}", warnings, warnings == 1 ? "" : "s"),
                       to_json(*result));
  return result->time_limit_reached ? kExitLimit : kExitDone;
}

/// A child that did not come to its end: killed by us, by the kernel for its memory, or by a bug.
Error error_of_signal(int signal, bool stopping) {
  if (stopping) return {ErrorCode::kCancelled, "", "cancelled"};
  if (signal == SIGKILL) return {ErrorCode::kLimit, "", "was killed, as happens when the machine runs out of memory"};
  return {ErrorCode::kInternal, "", fmt::format("crashed: {}", ::strsignal(signal))};
}

BatchResult result_of(const EndedChild& ended, bool stopping) {
  BatchResult result{ended.exit_code, ended.seconds, ended.peak_memory_bytes, {}, {}};
  if (ended.signal != 0) {
    const Error error = error_of_signal(ended.signal, stopping);
    result.exit_code = 128 + ended.signal;
    result.outcome = error.text();
    result.report = to_json(error);
    return result;
  }
  const std::size_t line_end = std::min(ended.answer.find('\n'), ended.answer.size());
  result.outcome = ended.answer.substr(0, line_end);
  if (line_end < ended.answer.size()) result.report = ended.answer.substr(line_end + 1);
  return result;
}

}  // namespace

BatchShares batch_shares(const CommandLine& line, std::size_t file_count) {
  const int threads = line.options.threads > 0 ? line.options.threads : core_count();
  const std::uint64_t memory = line.options.max_memory > 0 ? line.options.max_memory : default_max_memory();
  const int wanted = line.jobs > 0 ? line.jobs : threads;
  BatchShares shares;
  shares.jobs = std::max(1, static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(wanted), file_count)));
  shares.threads = std::max(1, threads / shares.jobs);
  shares.max_memory = std::max(kLeastMemory, memory / static_cast<std::uint64_t>(shares.jobs));
  return shares;
}

std::vector<BatchResult> bake_batch(const CommandLine& line, std::span<const BatchFile> files,
                                    const BatchShares& shares, const BatchListener& say) {
  std::vector<BatchResult> results(files.size());
  ChildProcesses children;
  std::size_t next = 0, ended_count = 0;
  const auto end = [&](std::size_t file, BatchResult result) {
    results[file] = std::move(result);
    say(results[file], batch_line(files[file], results[file], ++ended_count, files.size()));
  };

  std::chrono::steady_clock::time_point deadline{};
  bool stopping = false, killed = false;
  while (children.running_count() > 0 || (!stopping && next < files.size())) {
    // Start what there is room for.
    while (!stopping && next < files.size() && children.running_count() < static_cast<std::size_t>(shares.jobs)) {
      const std::size_t file = next++;
      const int failure =
          children.start(file, [&, file](std::string& answer) { return bake_one(line, files[file], shares, answer); });
      if (failure == 0) continue;
      const Error error{ErrorCode::kLimit, "", fmt::format("no process could be started: {}", std::strerror(failure))};
      end(file, {kExitLimit, 0.0, 0, error.text(), to_json(error)});
    }

    // Wait, and pass on a signal that asks to stop.
    if (auto ended = children.wait(50ms)) end(ended->task, result_of(*ended, stopping));
    if (const int signal = interrupted_by(); signal != 0 && !stopping) {
      stopping = true;
      deadline = std::chrono::steady_clock::now() + kLastWords;
      children.send(signal);
    }
    if (stopping && !killed && std::chrono::steady_clock::now() > deadline) {
      killed = true;
      children.send(SIGKILL);
    }
  }
  return results;
}

}  // namespace gltf_radiosity::tools
