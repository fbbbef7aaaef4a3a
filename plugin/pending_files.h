// Files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plugin/descriptor.h"
#include "plugin/result.h"

namespace gltf_radiosity {

/// What may be at a file's place already.
enum class Replace {
  kYes,  ///< a file, which the new one replaces
  kNo,   ///< nothing: whoever puts something there meanwhile wins, and commit() fails
};

/// The folder that a file lies in; "." where its path names none.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Files written beside their targets under temporary names, `.OUTPUT.tmp-PROCESS-NUMBER`, and renamed together at the
/// end. What was not renamed is removed by the destructor, and so are folders made for it.
///
/// A temporary file is locked (flock) as long as its process lives. What a killed one has left is known by that,
/// whatever machine or container it ran in, and is removed by the next who writes the same output.
class PendingFiles {
 public:
  /// `output` is the file that all this is about: its name is in all temporary ones.
  explicit PendingFiles(const std::filesystem::path& output);
  ~PendingFiles();
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;

  /// Writes the bytes and flushes them to the disk. Makes the folder of `target` if there is none. A target that exists
  /// must be a file; a symbolic link to one stays.
  Result<Done> add(const std::filesystem::path& target, std::span<const std::uint8_t> bytes,
                   Replace replace = Replace::kYes);
  Result<Done> add(const std::filesystem::path& target, std::string_view text);
  /// The bytes of all `parts` in a row.
  Result<Done> add_parts(const std::filesystem::path& target, std::span<const std::span<const std::uint8_t>> parts,
                         Replace replace = Replace::kYes);

  /// Renames the files in the order they were added, and flushes their folders: add last what refers to the others.
  Result<Done> commit();

 private:
  struct File {
    std::filesystem::path temporary, target;
    Replace replace = Replace::kYes;
    Descriptor lock;  ///< open and locked until the file has its name
  };

  void make_folder(const std::filesystem::path& folder);
  int create_beside(const std::filesystem::path& target, File& file) const;

  std::string prefix_;
  std::vector<File> files_;
  std::vector<std::filesystem::path> folders_;         ///< made for the files
  std::vector<std::filesystem::path> tidied_folders_;  ///< where nothing of dead processes is left
};

/// Removes the temporary files of this process beside `output`: for one that ends without destructors.
void remove_own_temporaries(const std::filesystem::path& output);

/// Keeps others from removing what an output refers to while it is switched (kShared), or everybody from switching
/// (kExclusive). A lock on the folder itself: nothing is left of it. Where the file system has none it does nothing.
class FolderLock {
 public:
  enum class Kind { kShared, kExclusive };
  /// Shared: waits up to five seconds, then goes on without. Exclusive: does not wait.
  FolderLock(const std::filesystem::path& folder, Kind kind);

  bool is_held() const { return is_held_; }

 private:
  Descriptor folder_;
  bool is_held_ = false;
};

}  // namespace gltf_radiosity
