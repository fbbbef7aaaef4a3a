#include "tools/batch_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "tools/exit_code.h"
#include "tools/messages.h"
#include "tools/report_file.h"

namespace gltf_radiosity::tools {
namespace {

/// From the worst to the mildest.
constexpr std::array kSeverity = {kExitInternal, kExitCannotWrite, kExitLimit, kExitBadInput, kExitUsage};

/// What a signal that ended a file means for the whole: SIGKILL comes from the kernel when memory runs out.
int without_signal(int exit_code) {
  if (exit_code < 128) return exit_code;
  return exit_code == 128 + SIGKILL ? kExitLimit : kExitInternal;
}

struct Totals {
  std::size_t succeeded = 0, failed = 0, not_started = 0;
  std::uint64_t peak_memory_bytes = 0;
};

Totals totals_of(std::span<const BatchResult> results) {
  Totals totals;
  for (const BatchResult& result : results) {
    if (result.exit_code == kExitDone) ++totals.succeeded;
    if (!result.exit_code) ++totals.not_started;
    totals.peak_memory_bytes = std::max(totals.peak_memory_bytes, result.peak_memory_bytes);
  }
  totals.failed = results.size() - totals.succeeded - totals.not_started;
  return totals;
}

std::string verdict(const BatchResult& result) {
  if (!result.exit_code) return "not started";
  return *result.exit_code == kExitDone ? "done" : fmt::format("exit {}", *result.exit_code);
}

constexpr double kMebibyte = 1024.0 * 1024.0;

/// `json` deeper by so many spaces, but for its first line.
std::string indented(std::string_view json, int spaces) {
  std::string text;
  for (const char c : json) {
    text += c;
    if (c == '\n') text.append(static_cast<std::size_t>(spaces), ' ');
  }
  return text;
}

std::string to_json(const BatchFile& file, const BatchResult& result) {
  return fmt::format(
      "{{\n      \"input\": {},\n      \"output\": {},\n      \"exitCode\": {},\n      \"seconds\": {:.6f},\n"
      "      \"peakMemoryBytes\": {},\n      \"report\": {}\n    }}",
      json_string(file.input), json_string(file.output), result.exit_code ? std::to_string(*result.exit_code) : "null",
      result.seconds, result.peak_memory_bytes, result.report.empty() ? "null" : indented(result.report, 6));
}

}  // namespace

int batch_exit_code(std::span<const BatchResult> results, int interrupted_by) {
  if (interrupted_by != 0) return exit_code_of(ErrorCode::kCancelled, interrupted_by);
  for (const int code : kSeverity) {
    const auto ended_so = [code](const BatchResult& r) { return r.exit_code && without_signal(*r.exit_code) == code; };
    if (std::any_of(results.begin(), results.end(), ended_so)) return code;
  }
  return kExitDone;
}

std::string batch_line(const BatchFile& file, const BatchResult& result, std::size_t ended, std::size_t all) {
  const std::string error = result.exit_code == kExitDone ? "" : "error: ";
  return fmt::format("gltf-radiosity: [{}/{}] {}: {}{}, {:.2f} s\n", ended, all, one_line(file.input), error,
                     one_line(result.outcome), result.seconds);
}

std::string batch_table(const BatchSummary& summary) {
  std::string table = fmt::format("{:<11} {:>9} {:>9}  {}\n", "result", "seconds", "memory", "file");
  for (std::size_t i = 0; i < summary.files.size(); ++i) {
    const BatchResult& result = summary.results[i];
    const double mebibytes = static_cast<double>(result.peak_memory_bytes) / kMebibyte;
    const bool failed = result.exit_code.value_or(kExitDone) != kExitDone;
    table += fmt::format("{:<11} {:>9.2f} {:>6.0f} MB  {}{}\n", verdict(result), result.seconds, mebibytes,
                         one_line(summary.files[i].input), failed ? ": " + one_line(result.outcome) : "");
  }
  const Totals totals = totals_of(summary.results);
  return table + fmt::format("gltf-radiosity: batch: {} of {} files baked, {} failed, {} not started, {:.2f} s\n",
                             totals.succeeded, summary.files.size(), totals.failed, totals.not_started,
                             summary.seconds);
}

std::string to_json(const BatchSummary& summary) {
  const Totals totals = totals_of(summary.results);
  std::string json = fmt::format(
      "{{\n  \"version\": {},\n  \"exitCode\": {},\n  \"totals\": {{\n    \"files\": {},\n    \"succeeded\": {},\n"
      "    \"failed\": {},\n    \"notStarted\": {},\n    \"seconds\": {:.6f},\n    \"peakMemoryBytes\": {},\n"
      "    \"jobs\": {}\n  }},\n  \"files\": [",
      json_string(version()), summary.exit_code, summary.files.size(), totals.succeeded, totals.failed,
      totals.not_started, summary.seconds, totals.peak_memory_bytes, summary.jobs);
  for (std::size_t i = 0; i < summary.files.size(); ++i) {
    json += (i == 0 ? "\n    " : ",\n    ") + to_json(summary.files[i], summary.results[i]);
  }
  return json + "\n  ]\n}";
}

}  // namespace gltf_radiosity::tools
