#include "plugin/pending_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;

Error cannot_write(const fs::path& target, int code) {
  return {ErrorCode::kCannotWrite, target.string(), "cannot be written: " + std::generic_category().message(code)};
}

/// An open file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Writes everything; returns errno of what failed, or 0.
  int write_all(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kLargestWrite = std::size_t{1} << 30;
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), std::min(bytes.size(), kLargestWrite));
      if (written < 0 && errno != EINTR) return errno;
      if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
  }

  /// Flushes what was written to the disk and closes; errno or 0.
  int finish() {
    if (::fsync(descriptor_) != 0) return errno;
    return close();
  }

 private:
  int close() {
    const int descriptor = std::exchange(descriptor_, -1);
    return descriptor >= 0 && ::close(descriptor) != 0 ? errno : 0;
  }

  int descriptor_;
};

/// Creates a file of a name that nobody has in the folder of `target`; 0 or errno.
int create_beside(const fs::path& target, fs::path& temporary, int& descriptor) {
  static std::atomic<unsigned> counter{0};
  do {
    const std::string name = target.filename().string().substr(0, 200);
    temporary = target.parent_path() / fmt::format(".{}.tmp-{}-{}", name, ::getpid(), counter++);
    descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EEXIST);
  return descriptor < 0 ? errno : 0;
}

}  // namespace

PendingFiles::~PendingFiles() {
  std::error_code ignored;
  for (const File& file : files_) fs::remove(file.temporary, ignored);
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) fs::remove(*folder, ignored);
}

void PendingFiles::make_folder(const fs::path& folder) {
  std::error_code ignored;  // creating the file says what is wrong
  if (folder.empty() || fs::exists(folder, ignored)) return;
  make_folder(folder.parent_path());
  if (fs::create_directory(folder, ignored)) folders_.push_back(folder);
}

Result<Done> PendingFiles::add_parts(const fs::path& target, std::span<const std::span<const std::uint8_t>> parts) {
  // Where the bytes shall end up.
  std::error_code error;
  fs::path file = fs::is_symlink(target, error) ? fs::weakly_canonical(target, error) : target;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    return Error{ErrorCode::kCannotWrite, target.string(), "cannot be written: exists and is not a file"};
  }
  make_folder(file.parent_path());

  // Beside it.
  fs::path temporary;
  int descriptor = -1;
  if (const int code = create_beside(file, temporary, descriptor); code != 0) return cannot_write(target, code);
  Descriptor open_file(descriptor);
  files_.push_back({temporary, file});
  for (const std::span<const std::uint8_t> part : parts) {
    if (const int code = open_file.write_all(part); code != 0) return cannot_write(target, code);
  }
  if (const int code = open_file.finish(); code != 0) return cannot_write(target, code);
  return Done{};
}

Result<Done> PendingFiles::add(const fs::path& target, std::span<const std::uint8_t> bytes) {
  return add_parts(target, std::span(&bytes, 1));
}

Result<Done> PendingFiles::add(const fs::path& target, std::string_view text) {
  return add(target, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Result<Done> PendingFiles::commit() {
  for (const File& file : files_) {
    std::error_code error;
    fs::rename(file.temporary, file.target, error);
    if (error) return cannot_write(file.target, error.value());
  }
  files_.clear();
  folders_.clear();
  return Done{};
}

}  // namespace gltf_radiosity
