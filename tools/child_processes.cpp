#include "tools/child_processes.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <string_view>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

sigset_t only_sigchld() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  return set;
}

/// When memory runs out the kernel takes the process with the highest score first.
void offer_to_be_killed_first() {
  const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  const ssize_t ignored = ::write(file, "500", 3);
  static_cast<void>(ignored);
  ::close(file);
}

bool write_whole(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::string read_whole(int file) {
  std::string text;
  char buffer[1 << 14];
  for (off_t at = 0;;) {
    const ssize_t got = ::pread(file, buffer, sizeof(buffer), at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(got));
    at += got;
  }
}

/// The life of a child.
[[noreturn]] void live(const ChildProcesses::Work& work, int answer_file, pid_t parent, const sigset_t& signals) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) std::_Exit(kExitInternal);  // it died before it could be watched
  offer_to_be_killed_first();
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  int exit_code = kExitInternal;
  std::string answer;
  try {
    exit_code = work(answer);
  } catch (const std::exception& bug) {
    answer = bug.what();
  }
  std::_Exit(write_whole(answer_file, answer) ? exit_code : kExitInternal);
}

}  // namespace

ChildProcesses::ChildProcesses() {
  // Blocked, so that sigtimedwait() gets it; not ignored, or there would be nothing to wait for.
  std::signal(SIGCHLD, SIG_DFL);
  const sigset_t children = only_sigchld();
  ::sigprocmask(SIG_BLOCK, &children, &signals_before_);
}

ChildProcesses::~ChildProcesses() {
  send(SIGKILL);
  while (!running_.empty()) wait(std::chrono::milliseconds(100));
  ::sigprocmask(SIG_SETMASK, &signals_before_, nullptr);
}

int ChildProcesses::start(std::size_t task, const Work& work) {
  const int answer = ::memfd_create("answer", MFD_CLOEXEC);
  if (answer < 0) return errno;
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) live(work, answer, parent, signals_before_);
  if (process < 0) {
    const int failure = errno;
    ::close(answer);
    return failure;
  }
  ::setpgid(process, process);  // here too: it must have happened before the first signal is sent
  running_.push_back({process, task, answer, Clock::now()});
  return 0;
}

std::optional<EndedChild> ChildProcesses::reap() {
  for (auto child = running_.begin(); child != running_.end(); ++child) {
    int status = 0;
    rusage usage{};
    if (::wait4(child->process, &status, WNOHANG, &usage) != child->process) continue;
    EndedChild ended;
    ended.task = child->task;
    ended.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    ended.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    ended.seconds = std::chrono::duration<double>(Clock::now() - child->since).count();
    ended.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
    ended.answer = read_whole(child->answer);
    ::close(child->answer);
    running_.erase(child);
    return ended;
  }
  return std::nullopt;
}

std::optional<EndedChild> ChildProcesses::wait(std::chrono::milliseconds patience) {
  if (auto ended = reap()) return ended;
  const timespec time{patience.count() / 1000, patience.count() % 1000 * 1'000'000};
  const sigset_t children = only_sigchld();
  ::sigtimedwait(&children, nullptr, &time);
  return reap();
}

void ChildProcesses::send(int signal) {
  for (const Running& child : running_) ::kill(child.process, signal);
}

}  // namespace gltf_radiosity::tools
