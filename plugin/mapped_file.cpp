#include "plugin/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace gltf_radiosity {
namespace {

Error cannot_map(const std::filesystem::path& path, int code) {
  return bad_input(path.string(), "cannot be read: " + std::generic_category().message(code));
}

/// Maps an open file.
Result<std::span<const std::uint8_t>> map_descriptor(int descriptor, const std::filesystem::path& path) {
  struct stat status = {};
  if (::fstat(descriptor, &status) != 0) return cannot_map(path, errno);
  if (!S_ISREG(status.st_mode)) return bad_input(path.string(), "cannot be read: is not a file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return std::span<const std::uint8_t>{};
  void* const address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (address == MAP_FAILED) return cannot_map(path, errno);
  return std::span(static_cast<const std::uint8_t*>(address), size);
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  // Without O_NONBLOCK a pipe would wait for a writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return cannot_map(path, errno);
  const Result<std::span<const std::uint8_t>> bytes = map_descriptor(descriptor, path);
  ::close(descriptor);
  if (!bytes) return bytes.error();
  return MappedFile(*bytes);
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

MappedFile::~MappedFile() {
  if (bytes_.empty()) return;
  ::munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

}  // namespace gltf_radiosity
