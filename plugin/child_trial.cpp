#include "plugin/child_trial.h"

#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace gltf_radiosity {
namespace {

void set_limit(decltype(RLIMIT_CPU) which, rlim_t limit) {
  const struct rlimit both = {limit, limit + 1};  // the hard one kills, the soft one says why
  ::setrlimit(which, &both);
}

/// Never returns. Neither output that is buffered nor what is registered for the end of the program is the copy's.
[[noreturn]] void work_as_child(const std::function<void()>& work, unsigned seconds) {
  // What would have been said or done about a crash of the whole program is not wanted here.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU}) std::signal(signal, SIG_DFL);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, seconds);
  try {
    work();
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

}  // namespace

TrialEnd try_in_child(const std::function<void()>& work, unsigned seconds) {
  const pid_t child = ::fork();
  if (child < 0) return TrialEnd::kNoProcess;
  if (child == 0) work_as_child(work, seconds);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return TrialEnd::kNoProcess;
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status) == 0 ? TrialEnd::kWell : TrialEnd::kCrashed;
  // The hard limit ends with SIGKILL where both limits are the same.
  const bool out_of_time = WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL;
  return out_of_time ? TrialEnd::kTooLong : TrialEnd::kCrashed;
}

}  // namespace gltf_radiosity
