#include "tools/last_resort.h"

#include <unistd.h>

#include <csignal>
#include <exception>
#include <new>
#include <string_view>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

void print_plainly(std::string_view line) {
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, line.data(), line.size());
}

[[noreturn]] void end_of_program() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    ::_exit(end_without_memory());
  } catch (...) {  // a line says it
  }
  print_plainly("gltf-radiosity: error: a library gave up\n");
  ::_exit(kExitInternal);
}

}  // namespace

extern "C" {
// Only calls that POSIX allows in a handler.
static void end_of_aborted_program(int /*signal*/) {
  constexpr char kLine[] = "gltf-radiosity: error: the program crashed, or a library gave up\n";
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, kLine, sizeof kLine - 1);
  ::_exit(kExitInternal);
}
}

void install_last_resort() {
  std::set_terminate(end_of_program);
  std::signal(SIGABRT, end_of_aborted_program);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they say more
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(crash, end_of_aborted_program);
#endif
}

int end_without_memory() {
  print_plainly("gltf-radiosity: error: not enough memory\n");
  return kExitLimit;
}

}  // namespace gltf_radiosity::tools
