#include "plugin/whole_file.h"

#include "plugin/pending_files.h"

namespace gltf_radiosity {

Result<Done> write_whole_file(const std::string& file, std::string_view text) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
    return Error{ErrorCode::kCannotWrite, file, "the folder does not exist"};
  }
  PendingFiles files(file);
  if (auto added = files.add(file, text); !added) return added;
  return files.commit();
}

void remove_temporaries_of(const std::string& output) { remove_own_temporaries(output); }

}  // namespace gltf_radiosity
