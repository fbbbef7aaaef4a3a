// Runs main() of the program it is loaded into (LD_PRELOAD) over and over, each time in a child process in which
// another call fails, and counts what became of the output.
//
// The environment says what to do; faults.test.mjs sets it:
//
//   FAULTS_KIND    allocation, all-allocations, write, flush, open, rename, read or kill
//   FAULTS_FIRST, FAULTS_STEP, FAULTS_RUNS   which calls fail, counted from 1; at most so many runs
//   FAULTS_FOLDER  where the output lies
//   FAULTS_OLD, FAULTS_NEW   folders that hold all files of the output before and after an undisturbed run
//   FAULTS_REPORT  a file for the result, as JSON
#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

#include "faults.h"

namespace {

namespace fs = std::filesystem;
using Main = int (*)(int, char**, char**);

Main real_main = nullptr;

std::string setting(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::uint64_t number(const char* name) { return std::strtoull(setting(name).c_str(), nullptr, 10); }

faults::Kind kind_called(const std::string& name) {
  static const std::map<std::string, faults::Kind> kinds = {{"allocation", faults::Kind::kAllocation},
                                                            {"all-allocations", faults::Kind::kAllAllocations},
                                                            {"write", faults::Kind::kWrite},
                                                            {"flush", faults::Kind::kFlush},
                                                            {"open", faults::Kind::kOpen},
                                                            {"rename", faults::Kind::kRename},
                                                            {"read", faults::Kind::kRead},
                                                            {"kill", faults::Kind::kKill}};
  return kinds.at(name);
}

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Whether every file of `reference` lies in `folder`, byte for byte.
bool holds(const fs::path& folder, const fs::path& reference) {
  for (const auto& entry : fs::directory_iterator(reference)) {
    const fs::path file = folder / entry.path().filename();
    if (!fs::exists(file) || content(file) != content(entry.path())) return false;
  }
  return true;
}

/// The output as it was, beside what killed processes have left.
void restore(const fs::path& folder, const fs::path& old) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().front() != '.') fs::remove(entry.path());
  }
  fs::copy(old, folder, fs::copy_options::recursive);
}

struct Ending {
  int status = 0;
  std::string text;           ///< what it said on stderr
  std::uint64_t counted = 0;  ///< calls that could have failed
};

/// One run in a child.
Ending run(faults::Kind kind, std::uint64_t nth, int argc, char** argv, char** environment) {
  constexpr unsigned kPatience = 300;  // seconds; a child that hangs ends by SIGALRM
  static auto* const counter = static_cast<std::atomic<std::uint64_t>*>(
      ::mmap(nullptr, sizeof(std::atomic<std::uint64_t>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  *counter = 0;
  int ends[2];
  if (::pipe(ends) != 0) std::abort();
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    ::alarm(kPatience);
    faults::arm(kind, nth, *counter);
    std::exit(real_main(argc, argv, environment));
  }
  ::close(ends[1]);
  Ending ending;
  char block[4096];
  for (ssize_t size = 0; (size = ::read(ends[0], block, sizeof block)) > 0;) {
    ending.text.append(block, static_cast<std::size_t>(size));
  }
  ::close(ends[0]);
  ::waitpid(child, &ending.status, 0);
  ending.counted = *counter;
  return ending;
}

/// Lines on stderr, without those that glibc writes by itself where it cannot register a thread's destructor.
int lines_of_ours(const std::string& text) {
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) count += line.starts_with("Fatal glibc error: ") ? 0 : 1;
  return count;
}

struct Tally {
  std::uint64_t runs = 0, kept_old = 0, has_new = 0, lost = 0, wordy = 0;
  std::map<std::string, std::uint64_t> endings;
  std::string examples;

  void note(std::uint64_t nth, const std::string& what, const std::string& text) {
    if (examples.size() > 2000) return;
    for (const char c : std::to_string(nth) + " " + what + ": " + text) {
      examples += static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\' ? ' ' : c;
    }
    examples += " | ";
  }

  std::string json() const {
    std::string text = "{\"runs\": " + std::to_string(runs) + ", \"old\": " + std::to_string(kept_old) +
                       ", \"new\": " + std::to_string(has_new) + ", \"lost\": " + std::to_string(lost) +
                       ", \"wordy\": " + std::to_string(wordy) + ", \"endings\": {";
    std::string separator;
    for (const auto& [name, count] : endings) {
      text += separator + "\"" + name + "\": " + std::to_string(count);
      separator = ", ";
    }
    return text + "}, \"examples\": \"" + examples + "\"}\n";
  }
};

int loop(int argc, char** argv, char** environment) {
  ::unsetenv("LD_PRELOAD");
  const faults::Kind kind = kind_called(setting("FAULTS_KIND"));
  const fs::path folder = setting("FAULTS_FOLDER"), old = setting("FAULTS_OLD"), fresh = setting("FAULTS_NEW");
  const std::uint64_t step = number("FAULTS_STEP"), most = number("FAULTS_RUNS");
  Tally tally;
  for (std::uint64_t nth = number("FAULTS_FIRST"); tally.runs < most; nth += step) {
    restore(folder, old);
    const Ending ending = run(kind, nth, argc, argv, environment);
    if (ending.counted < nth && kind != faults::Kind::kRead) break;  // no call is left to fail
    ++tally.runs;

    // How it ended, and what it said.
    const bool exited = WIFEXITED(ending.status);
    const std::string name = exited ? "exit " + std::to_string(WEXITSTATUS(ending.status))
                                    : "signal " + std::to_string(WTERMSIG(ending.status));
    ++tally.endings[name];
    const int lines = lines_of_ours(ending.text);
    const bool one_line = lines == (exited && WEXITSTATUS(ending.status) != 0 ? 1 : 0);
    if (!one_line) ++tally.wordy;
    if (!one_line || !exited) tally.note(nth, name, ending.text);

    // What is there now.
    const bool is_old = holds(folder, old), is_new = holds(folder, fresh);
    if (is_new) ++tally.has_new;
    if (is_old && !is_new) ++tally.kept_old;
    if (!is_old && !is_new) ++tally.lost;
    if (!is_old && !is_new) tally.note(nth, "lost", name);
    if (exited && WEXITSTATUS(ending.status) == 0 && !is_new) tally.note(nth, "not new", name);
  }
  std::ofstream(setting("FAULTS_REPORT")) << tally.json();
  return 0;
}

}  // namespace

// glibc calls main() through this.
extern "C" int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(),
                                 void (*loader_fini)(), void* stack_end) {
  real_main = main;
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto start = reinterpret_cast<Start>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(loop, argc, argv, init, fini, loader_fini, stack_end);
}
