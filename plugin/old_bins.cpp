#include "plugin/old_bins.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "plugin/content_name.h"
#include "plugin/input_folder.h"
#include "plugin/pending_files.h"

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;

/// More text than this is not searched for names.
constexpr std::uint64_t kMaxSearchedBytes = std::uint64_t{1} << 28;

bool is_gltf_or_copy(const fs::path& file) {
  std::string name = file.filename().string();
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name.find(".gltf") != std::string::npos;
}

/// Whether nobody has changed what was written.
bool holds_what_its_name_says(const fs::path& file, const fs::path& bin) {
  const auto bytes = read_file(file, "");
  return bytes && name_by_content(bin, *bytes).filename() == file.filename();
}

/// Takes those out of `bins` that `text` mentions. What their names add to the output's has no character that a URI
/// writes in another way.
void keep_unmentioned(std::string_view text, std::vector<fs::path>& bins) {
  std::erase_if(bins, [text](const fs::path& bin) {
    const std::string stem = bin.stem().string();
    return text.find(stem.substr(stem.rfind('-'))) != std::string_view::npos;
  });
}

/// The regular files of a folder; none if it cannot be looked through.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  if (error) files.clear();
  return files;
}

}  // namespace

void remove_old_bins(const fs::path& output) {
  // Nobody may switch to one of them meanwhile.
  const fs::path folder = folder_of(output);
  const FolderLock lock(folder, FolderLock::Kind::kExclusive);
  if (!lock.is_held()) return;

  // What might be removed.
  fs::path bin = output;
  bin.replace_extension(".bin");
  const std::vector<fs::path> files = files_in(folder);
  std::vector<fs::path> old;
  std::ranges::copy_if(files, std::back_inserter(old),
                       [&bin](const fs::path& file) { return is_name_by_content(file, bin); });

  // What of it is needed.
  std::uint64_t searched = 0;
  for (const fs::path& file : files) {
    if (old.empty()) return;
    if (!is_gltf_or_copy(file)) continue;
    const auto text = read_file(file, "", kMaxSearchedBytes - searched);
    if (!text) return;
    searched += text->size();
    keep_unmentioned({reinterpret_cast<const char*>(text->data()), text->size()}, old);
  }
  std::erase_if(old, [&bin](const fs::path& file) { return !holds_what_its_name_says(file, bin); });

  std::error_code ignored;
  for (const fs::path& file : old) fs::remove(file, ignored);
}

}  // namespace gltf_radiosity
