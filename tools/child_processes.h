// Work in processes of its own: what crashes or runs out of memory there ends nothing else.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gltf_radiosity::tools {

/// How a child ended.
struct EndedChild {
  std::size_t task = 0;
  int exit_code = 0;  ///< its own, if `signal` is 0
  int signal = 0;     ///< that ended it
  double seconds = 0.0;
  std::uint64_t peak_memory_bytes = 0;
  std::string answer;  ///< what it answered, up to where it came
};

/// Forks; use it while the process has no thread but one. Children are in process groups of their own, so that Ctrl-C
/// reaches this process only; they get SIGTERM when it dies, and are the first to go when the machine runs out of
/// memory.
class ChildProcesses {
 public:
  /// What a child does: returns its exit code and writes its answer.
  using Work = std::function<int(std::string& answer)>;

  ChildProcesses();
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;
  /// Kills what is left.
  ~ChildProcesses();

  /// Starts a child; returns 0 or the errno of what failed.
  int start(std::size_t task, const Work& work);
  std::size_t running_count() const { return running_.size(); }
  /// The next child that ends; nothing if none does within `patience`, or a signal arrives.
  std::optional<EndedChild> wait(std::chrono::milliseconds patience);
  void send(int signal);

 private:
  using Clock = std::chrono::steady_clock;
  struct Running {
    pid_t process;
    std::size_t task;
    int answer;  ///< file descriptor
    Clock::time_point since;
  };
  std::optional<EndedChild> reap();

  std::vector<Running> running_;
  sigset_t signals_before_;
};

}  // namespace gltf_radiosity::tools
