#include "plugin/group_files.h"

#include <system_error>
#include <utility>

#include "plugin/our_extras.h"
#include "plugin/pending_files.h"
#include "plugin/write_gltf.h"

namespace gltf_radiosity {

std::vector<GroupFile> group_files(const Document& document, const BufferBuilder& added, const GroupBytes& bytes,
                                   std::span<const GroupNames> names) {
  std::vector<GroupFile> files;
  for (std::size_t g = 0; g < bytes.size(); ++g) {
    GroupFile file{names[g].in_file, document, added};
    for (const ColorBytes& colors : bytes[g]) file.added.replace(colors.offset, colors.bytes);
    our_extras(file.document.json["asset"])["lightGroups"] = {{"storage", "file"},
                                                              {"groups", {{{"name", names[g].name}}}}};
    files.push_back(std::move(file));
  }
  return files;
}

std::filesystem::path path_of_group(const std::filesystem::path& output, const std::string& in_file) {
  const std::string name = output.filename().string();
  const std::size_t ending =
      file_kind(output) == FileKind::kEmbedded ? name.rfind('.', name.rfind('.') - 1) : name.rfind('.');
  std::filesystem::path path = output;
  path.replace_filename(name.substr(0, ending) + "." + in_file + name.substr(ending));
  return path;
}

Result<Done> write_with_groups(Document document, const BufferBuilder& added, std::vector<GroupFile> groups,
                               const std::filesystem::path& input, const std::filesystem::path& output) {
  PendingFiles files(output);
  std::vector<std::filesystem::path> outputs;
  for (GroupFile& group : groups) {
    const std::filesystem::path path = path_of_group(output, group.in_file);
    std::error_code error;
    if (std::filesystem::equivalent(input, path, error)) {
      return Error{ErrorCode::kBadOption, path.string(), "the file of a light group is the input itself"};
    }
    if (const auto checked = check_output(path); !checked) return checked.error();
    if (auto written = add_gltf(std::move(group.document), group.added, path, files); !written) return written;
    outputs.push_back(path);
  }
  if (auto written = add_gltf(std::move(document), added, output, files); !written) return written;
  outputs.push_back(output);
  return commit_gltfs(files, outputs);
}

}  // namespace gltf_radiosity
