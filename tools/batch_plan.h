// Which files a batch bakes, and where each goes.
#pragma once

#include <istream>
#include <string>
#include <variant>
#include <vector>

#include "tools/command_line.h"

namespace gltf_radiosity::tools {

struct BatchFile {
  std::string input;
  std::string output;  ///< ends as the input does
};

/// The files of a batch, or why there is none.
///
/// If `from` is a folder: every .glb and .gltf in it and below, sorted by path, at the same place below `to`; not what
/// lies in `to` itself, nor behind links to folders. Else `from` is a text file of paths, one a line, or "-" for
/// `standard_input`: a relative path keeps its folders below `to`; of one that is absolute or begins with .. only the
/// name is kept. Refused is what would write one file twice, or replace an input.
std::variant<std::vector<BatchFile>, Ending> plan_batch(const std::string& from, const std::string& to,
                                                        std::istream& standard_input);

}  // namespace gltf_radiosity::tools
