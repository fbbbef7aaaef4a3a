// START HERE, the command line: parse -> bake, verify or view -> report. The only code that prints and exits.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "plugin/gltf_radiosity.h"
#include "plugin/verify.h"
#include "plugin/view.h"
#include "plugin/whole_file.h"
#include "tools/batch.h"
#include "tools/batch_plan.h"
#include "tools/batch_report.h"
#include "tools/command_line.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/last_resort.h"
#include "tools/memory_limit.h"
#include "tools/messages.h"
#include "tools/progress_bar.h"
#include "tools/relight_command.h"
#include "tools/report_file.h"
#include "tools/verify_command.h"
#include "tools/view_command.h"
#include "tools/watchdog.h"

namespace gltf_radiosity::tools {
namespace {

void print(std::FILE* stream, std::string_view text) { std::fwrite(text.data(), 1, text.size(), stream); }

int end_at_once(const Ending& ending) {
  if (ending.exit_code != kExitDone) {
    print(stderr, error_line(ending.text));
    return ending.exit_code;
  }
  print(stdout, ending.text);
  return std::fflush(stdout) == 0 ? kExitDone : kExitCannotWrite;
}

/// Writes the report if one was asked for; answers `exit_code`, or that the report could not be written.
int report_to_programs(const std::string& file, std::string_view json, int exit_code) {
  if (file.empty()) return exit_code;
  const std::optional<std::string> failure = write_report(file, json);
  if (!failure) return exit_code;
  print(stderr, error_line(*failure));
  return exit_code == kExitDone || exit_code == kExitLimit ? kExitCannotWrite : exit_code;
}

/// Says what went wrong, to people and to programs; answers the exit code.
int report_failure(const Error& error, const std::string& file) {
  print(stderr, error_line(error.text()));
  const int exit_code = exit_code_of(error.code, interrupted_by());
  const bool is_forbidden = error.code == ErrorCode::kBadOption && error.place == file;  // it is the input's own
  return is_forbidden ? exit_code : report_to_programs(file, to_json(error), exit_code);
}

/// `progress` must outlive them.
Callbacks callbacks_of(ProgressBar& progress) {
  Callbacks callbacks;
  callbacks.progress = [&progress](std::string_view phase, double done) { progress.update(phase, done); };
  callbacks.cancelled = [] { return interrupted_by() != 0; };
  return callbacks;
}

/// What is done when a signal asked to stop and nobody does: `files` are what is being written, reports go to `json`.
std::function<void()> last_words(const std::vector<std::string>& files, const std::string& json) {
  return [files, json] {
    for (const std::string& file : files) {
      if (!file.empty()) remove_temporaries_of(file);
    }
    report_failure({ErrorCode::kCancelled, "", "cancelled"}, json);
  };
}

int bake_as_asked(const CommandLine& line) {
  const std::uint64_t max_memory = line.options.max_memory;
  limit_memory(max_memory > 0 ? max_memory : default_max_memory(), line.options.threads);

  // Bake, with a display that is gone before anything else is printed
  const auto start = std::chrono::steady_clock::now();
  ProgressBar progress(resolve(line.progress), standard_error());
  const Result<Report> result = [&] {
    const Watchdog watchdog(last_words({line.output}, line.json));
    return bake_file(line.input, line.output, line.options, callbacks_of(progress));
  }();

  // What went wrong
  if (!result) {
    progress.abandon();
    return report_failure(result.error(), line.json);
  }

  // What was done
  progress.finish();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  for (const Warning& warning : result->warnings) print(stderr, warning_line(warning));
  const int whole = result->time_limit_reached ? kExitLimit : kExitDone;
  const int exit_code = report_to_programs(line.json, to_json(*result), whole);
  if (line.progress != ProgressStyle::kNone) print(stderr, summary_line(line.output, *result, elapsed.count()));
  return exit_code;
}

int batch_as_asked(const CommandLine& line) {
  // Which files
  const auto planned = plan_batch(line.input, line.output, std::cin);
  if (const Ending* const ending = std::get_if<Ending>(&planned)) return end_at_once(*ending);
  const std::vector<BatchFile>& files = std::get<0>(planned);

  // Bake them
  const auto start = std::chrono::steady_clock::now();
  const BatchShares shares = batch_shares(line, files.size());
  const bool quiet = line.progress == ProgressStyle::kNone;
  const auto say = [quiet](const BatchResult& result, std::string_view text) {
    if (!quiet || result.exit_code != kExitDone) print(stderr, text);
  };
  const std::vector<BatchResult> results = bake_batch(line, files, shares, say);

  // What was done
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const int exit_code = batch_exit_code(results, interrupted_by());
  const BatchSummary summary{files, results, exit_code, shares.jobs, elapsed.count()};
  if (!quiet) print(stderr, batch_table(summary));
  return report_to_programs(line.json, to_json(summary), exit_code);
}

int run_as_asked(const CommandLine& line) { return line.batch ? batch_as_asked(line) : bake_as_asked(line); }

int verify_as_asked(const VerifyCommand& command) {
  limit_memory(default_max_memory(), command.options.bake.threads);

  // Verify
  ProgressBar progress(resolve(command.progress), standard_error());
  const Result<VerifyReport> result = [&] {
    const Watchdog watchdog(last_words({command.options.image}, command.json));
    return verify_files(command.input, command.output, command.options, callbacks_of(progress));
  }();
  if (!result) {
    progress.abandon();
    return report_failure(result.error(), command.json);
  }

  // The result, and whether it is good enough
  progress.finish();
  for (const Warning& warning : result->warnings) print(stderr, warning_line(warning));
  if (command.json != "-") print(stdout, verified_lines(*result));
  const int exit_code = report_to_programs(command.json, to_json(*result), kExitDone);
  if (exit_code != kExitDone || std::fflush(stdout) != 0) return kExitCannotWrite;
  if (!command.max_error || result->relative_rmse <= *command.max_error) return kExitDone;
  print(stderr, too_inexact_line(*result, *command.max_error));
  return kExitTooInexact;
}

int view_as_asked(const ViewCommand& command) {
  ProgressBar progress(resolve(command.progress), standard_error());
  const Result<ViewReport> result = view_file(command.baked, command.html, command.options, callbacks_of(progress));
  if (!result) {
    progress.abandon();
    return report_failure(result.error(), "");
  }
  progress.finish();
  for (const Warning& warning : result->warnings) print(stderr, warning_line(warning));
  if (command.progress != ProgressStyle::kNone) print(stderr, viewed_line(command.html, *result));
  return kExitDone;
}

int relight_as_asked(const RelightCommand& command) {
  const auto start = std::chrono::steady_clock::now();
  Callbacks callbacks;
  callbacks.cancelled = [] { return interrupted_by() != 0; };
  const Result<RelightReport> result = relight_file(command.transport, command.output, command.options, callbacks);
  if (!result) return report_failure(result.error(), command.json);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  for (const Warning& warning : result->warnings) print(stderr, warning_line(warning));
  const int exit_code = report_to_programs(command.json, to_json(*result), kExitDone);
  print(stderr, relit_line(command.output, *result, elapsed.count()));
  return exit_code;
}

/// Does what was parsed, with signals caught.
template <typename Command>
int act(const std::variant<Command, Ending>& parsed, int (*as_asked)(const Command&)) {
  if (const Ending* const ending = std::get_if<Ending>(&parsed)) return end_at_once(*ending);
  catch_interrupts();
  return as_asked(std::get<Command>(parsed));
}

int run(std::span<const char* const> arguments) {
  if (is_relight_command(arguments)) return act(parse_relight_command(arguments), relight_as_asked);
  if (is_verify_command(arguments)) return act(parse_verify_command(arguments), verify_as_asked);
  if (is_view_command(arguments)) return act(parse_view_command(arguments), view_as_asked);
  return act(parse_command_line(arguments), run_as_asked);
}

}  // namespace
}  // namespace gltf_radiosity::tools

int main(int argc, char** argv) try {
  gltf_radiosity::tools::install_last_resort();
  return gltf_radiosity::tools::run({argv, static_cast<std::size_t>(argc)});
} catch (const std::bad_alloc&) {
  return gltf_radiosity::tools::end_without_memory();
} catch (const std::exception& bug) {
  gltf_radiosity::tools::print(stderr, gltf_radiosity::tools::error_line(bug.what()));
  return gltf_radiosity::tools::kExitInternal;
}
