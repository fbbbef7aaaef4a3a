// --light-groups files: a file for each group of lights beside the output.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "plugin/append_accessor.h"
#include "plugin/document.h"
#include "plugin/export_light_groups.h"

namespace gltf_radiosity {

/// The output with the light of one group in COLOR_0.
struct GroupFile {
  std::string in_file;  ///< GroupNames::in_file
  Document document;
  BufferBuilder added;
};

/// Copies of an exported document and its added buffer that hold the bytes of each group; none if there are none. Each
/// is signed as storage "file" of its group.
std::vector<GroupFile> group_files(const Document& document, const BufferBuilder& added, const GroupBytes& bytes,
                                   std::span<const GroupNames> names);

/// out.glb, NAME -> out.NAME.glb
std::filesystem::path path_of_group(const std::filesystem::path& output, const std::string& in_file);

/// Writes the output and the files of the groups beside it: all appear or none. An error if one of them is the input.
Result<Done> write_with_groups(Document document, const BufferBuilder& added, std::vector<GroupFile> groups,
                               const std::filesystem::path& input, const std::filesystem::path& output);

}  // namespace gltf_radiosity
