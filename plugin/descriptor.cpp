#include "plugin/descriptor.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

namespace gltf_radiosity {
namespace {

/// Linux moves less than 2 GiB at a time.
constexpr std::size_t kLargestStep = std::size_t{1} << 30;
constexpr std::size_t kSmallestBuffer = std::size_t{1} << 16;

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    close();
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

int Descriptor::read_all(std::uint64_t max_bytes, std::vector<std::uint8_t>& bytes) const {
  // What the file says of its size; pipes say nothing.
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) return errno;
  const std::uint64_t said = S_ISREG(status.st_mode) ? static_cast<std::uint64_t>(status.st_size) : 0;
  if (said > max_bytes) return EFBIG;
  const std::uint64_t most = said > 0 ? max_bytes : max_bytes / 4;  // to grow takes twice as much, for a moment

  // One byte more than that, so that the end shows without another buffer.
  std::size_t size = 0;
  bytes.assign(std::max<std::size_t>(said + 1, said == 0 ? kSmallestBuffer : 0), 0);
  while (true) {
    if (size == bytes.size()) bytes.resize(2 * size);
    const ssize_t count = ::read(descriptor_, bytes.data() + size, std::min(bytes.size() - size, kLargestStep));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
    if (size > most) return EFBIG;
  }
  bytes.resize(size);
  return 0;
}

int Descriptor::write_all(std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), std::min(bytes.size(), kLargestStep));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

int Descriptor::flush() const {
  while (::fsync(descriptor_) != 0) {
    if (errno == EINVAL || errno == EROFS || errno == ENOTSUP) return 0;
    if (errno != EINTR) return errno;
  }
  return 0;
}

int Descriptor::close() {
  // Linux has closed it even where it answers EINTR.
  const int descriptor = std::exchange(descriptor_, -1);
  return descriptor >= 0 && ::close(descriptor) != 0 && errno != EINTR ? errno : 0;
}

}  // namespace gltf_radiosity
