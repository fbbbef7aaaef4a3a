// Stands before malloc and the system's calls on files (LD_PRELOAD) and lets one of them fail.
#include "faults.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstddef>
#include <cstdlib>

namespace faults {
namespace {

std::atomic<Kind> armed{Kind::kNone};
std::atomic<std::uint64_t> wanted{0};
std::atomic<std::uint64_t>* count = nullptr;

/// Counts a call that may fail; whether this one does.
bool strikes(bool and_all_after = false) {
  const std::uint64_t number = count->fetch_add(1, std::memory_order_relaxed) + 1;
  const std::uint64_t nth = wanted.load(std::memory_order_relaxed);
  return number == nth || (and_all_after && number > nth);
}

bool no_memory() {
  const Kind kind = armed.load(std::memory_order_relaxed);
  if (kind != Kind::kAllocation && kind != Kind::kAllAllocations) return false;
  return strikes(kind == Kind::kAllAllocations);
}

/// Before a call on a file: may be the moment to be killed; whether a call of `kind` fails.
bool fails(Kind kind, bool and_all_after = false) {
  const Kind now = armed.load(std::memory_order_relaxed);
  if (now == Kind::kKill && strikes()) ::kill(::getpid(), SIGKILL);
  return now == kind && strikes(and_all_after);
}

bool is_file(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

void arm(Kind kind, std::uint64_t nth, std::atomic<std::uint64_t>& counter) {
  count = &counter;
  wanted = nth;
  armed = kind;
}

}  // namespace faults

// glibc's own, under the names that are not replaced.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  if (!faults::no_memory()) return __libc_malloc(size);
  errno = ENOMEM;
  return nullptr;
}

void* calloc(std::size_t count, std::size_t size) {
  if (!faults::no_memory()) return __libc_calloc(count, size);
  errno = ENOMEM;
  return nullptr;
}

void* realloc(void* old, std::size_t size) {
  if (!faults::no_memory()) return __libc_realloc(old, size);
  errno = ENOMEM;
  return nullptr;
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return faults::no_memory() ? nullptr : __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) { return aligned_alloc(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = aligned_alloc(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  static const auto real = faults::next<ssize_t (*)(int, const void*, std::size_t)>("write");
  if (!faults::is_file(descriptor) || !faults::fails(faults::Kind::kWrite, true)) return real(descriptor, bytes, size);
  // Half fits; the call after it will say why.
  static std::atomic<bool> half_written{false};
  if (size > 1 && !half_written.exchange(true)) return real(descriptor, bytes, size / 2);
  errno = ENOSPC;
  return -1;
}

ssize_t read(int descriptor, void* bytes, std::size_t size) {
  static const auto real = faults::next<ssize_t (*)(int, void*, std::size_t)>("read");
  static std::atomic<unsigned> turn{0};
  if (faults::armed != faults::Kind::kRead || !faults::is_file(descriptor)) return real(descriptor, bytes, size);
  if (turn++ % 2 == 0) {
    errno = EINTR;
    return -1;
  }
  return real(descriptor, bytes, std::min<std::size_t>(size, 1 + turn % 1000));
}

int fsync(int descriptor) {
  static const auto real = faults::next<int (*)(int)>("fsync");
  if (!faults::fails(faults::Kind::kFlush)) return real(descriptor);
  errno = EIO;
  return -1;
}

int open(const char* path, int flags, ...) {
  static const auto real = faults::next<int (*)(const char*, int, ...)>("open");
  va_list more;
  va_start(more, flags);
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : mode_t{0};
  va_end(more);
  if ((flags & O_CREAT) == 0 || !faults::fails(faults::Kind::kOpen)) return real(path, flags, mode);
  errno = EACCES;
  return -1;
}
int open64(const char* path, int flags, ...) __attribute__((alias("open")));

int rename(const char* from, const char* to) {
  static const auto real = faults::next<int (*)(const char*, const char*)>("rename");
  if (!faults::fails(faults::Kind::kRename)) return real(from, to);
  errno = EACCES;
  return -1;
}
}
