#include "plugin/pending_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>  // NOLINT(modernize-deprecated-headers): renameat2 and RENAME_NOREPLACE are not in cstdio
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <set>
#include <system_error>
#include <thread>

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;

Error cannot_write(const fs::path& target, int code) {
  return {ErrorCode::kCannotWrite, target.string(), "cannot be written: " + std::generic_category().message(code)};
}

/// What the names of all temporary files of an output begin with; short enough for any file system.
std::string temporary_prefix(const fs::path& output) {
  return fmt::format(".{}.tmp-", output.filename().string().substr(0, 200));
}

bool try_lock(const Descriptor& file, int kind) { return ::flock(file.get(), kind | LOCK_NB) == 0; }

/// Whether `file` is still what `name` stands for.
bool has_name(const Descriptor& file, const fs::path& name) {
  struct stat of_file {
  }, of_name{};
  return ::fstat(file.get(), &of_file) == 0 && ::lstat(name.c_str(), &of_name) == 0 &&
         of_file.st_ino == of_name.st_ino && of_file.st_dev == of_name.st_dev;
}

/// Calls `visit(file)` for what lies in a folder under names that begin with `prefix`.
template <typename Visit>
void for_names(const fs::path& folder, const std::string& prefix, const Visit& visit) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename().string().starts_with(prefix)) visit(entry->path());
  }
}

/// Removes a temporary file unless its process lives.
void remove_if_abandoned(const fs::path& temporary) {
  const Descriptor file(::open(temporary.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!file.is_open() || !try_lock(file, LOCK_EX) || !has_name(file, temporary)) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
}

/// 0 or errno.
int rename_file(const fs::path& from, const fs::path& to, Replace replace) {
  if (replace == Replace::kYes) return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // The file system cannot rename so; a link replaces nothing either.
  if (::link(from.c_str(), to.c_str()) != 0) return errno;
  return ::unlink(from.c_str()) == 0 ? 0 : errno;
}

/// New names are on the disk afterwards; 0 or errno.
int flush_folder(const fs::path& folder) {
  const Descriptor open_folder(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return open_folder.is_open() ? open_folder.flush() : 0;  // a folder may be closed to readers
}

}  // namespace

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

PendingFiles::PendingFiles(const fs::path& output) : prefix_(temporary_prefix(output)) {}

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

/// Creates a file of a name that nobody has in the folder of `target`, and locks it; 0 or errno.
int PendingFiles::create_beside(const fs::path& target, File& file) const {
  static std::atomic<unsigned> counter{0};
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    file.temporary = target.parent_path() / fmt::format("{}{}-{}", prefix_, ::getpid(), counter++);
    file.lock = Descriptor(::open(file.temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!file.lock.is_open() && errno == EEXIST) continue;
    if (!file.lock.is_open()) return errno;
    // Whoever tidies up may have found it before it was locked.
    const bool taken = !try_lock(file.lock, LOCK_EX) && errno == EWOULDBLOCK;
    if (!taken && has_name(file.lock, file.temporary)) return 0;
  }
  return EBUSY;
}

Result<Done> PendingFiles::add_parts(const fs::path& target, std::span<const std::span<const std::uint8_t>> parts,
                                     Replace replace) {
  // Where the bytes shall end up.
  std::error_code error;
  File file;
  file.target = fs::is_symlink(target, error) ? fs::weakly_canonical(target, error) : target;
  file.replace = replace;
  if (fs::exists(file.target, error) && !fs::is_regular_file(file.target, error)) {
    return Error{ErrorCode::kCannotWrite, target.string(), "cannot be written: exists and is not a file"};
  }
  const fs::path folder = folder_of(file.target);
  make_folder(folder);
  if (std::ranges::find(tidied_folders_, folder) == tidied_folders_.end()) {
    for_names(folder, prefix_, remove_if_abandoned);
    tidied_folders_.push_back(folder);
  }

  // Beside it.
  files_.reserve(files_.size() + 1);  // once it is created it must get into the list
  if (const int code = create_beside(file.target, file); code != 0) return cannot_write(target, code);
  files_.push_back(std::move(file));
  const Descriptor& open_file = files_.back().lock;
  for (const std::span<const std::uint8_t> part : parts) {
    if (const int code = open_file.write_all(part); code != 0) return cannot_write(target, code);
  }
  if (const int code = open_file.flush(); code != 0) return cannot_write(target, code);
  return Done{};
}

Result<Done> PendingFiles::add(const fs::path& target, std::span<const std::uint8_t> bytes, Replace replace) {
  return add_parts(target, std::span(&bytes, 1), replace);
}

Result<Done> PendingFiles::add(const fs::path& target, std::string_view text) {
  return add(target, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Result<Done> PendingFiles::commit() {
  // The new names.
  std::set<fs::path> folders;
  for (const File& file : files_) {
    if (const int code = rename_file(file.temporary, file.target, file.replace); code != 0) {
      return cannot_write(file.target, code);
    }
    folders.insert(folder_of(file.target));
  }
  for (const fs::path& made : folders_) folders.insert(folder_of(made));
  files_.clear();
  folders_.clear();

  // To the disk.
  for (const fs::path& folder : folders) {
    if (const int code = flush_folder(folder); code != 0) return cannot_write(folder, code);
  }
  return Done{};
}

void remove_own_temporaries(const fs::path& output) {
  std::error_code error;
  const fs::path target = fs::is_symlink(output, error) ? fs::weakly_canonical(output, error) : output;
  for_names(folder_of(target), fmt::format("{}{}-", temporary_prefix(output), ::getpid()),
            [&error](const fs::path& file) { fs::remove(file, error); });
}

FolderLock::FolderLock(const fs::path& folder, Kind kind)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  constexpr int kTries = 500;
  constexpr std::chrono::milliseconds kPause(10);
  if (!folder_.is_open()) return;
  is_held_ = try_lock(folder_, kind == Kind::kShared ? LOCK_SH : LOCK_EX);
  for (int i = 0; i < kTries && !is_held_ && errno == EWOULDBLOCK && kind == Kind::kShared; ++i) {
    std::this_thread::sleep_for(kPause);
    is_held_ = try_lock(folder_, LOCK_SH);
  }
}

}  // namespace gltf_radiosity
