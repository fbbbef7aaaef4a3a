#include "tools/batch_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

namespace fs = std::filesystem;

using Plan = std::variant<std::vector<BatchFile>, Ending>;

bool is_gltf(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".glb" || ending == ".gltf";
}

/// A name for what is the same file, whether it exists or not.
fs::path identity(const fs::path& file) {
  std::error_code error;
  const fs::path known = fs::weakly_canonical(fs::absolute(file), error);
  return error ? fs::absolute(file).lexically_normal() : known;
}

Plan files_below(const fs::path& folder, const fs::path& to) {
  const fs::path skipped = identity(to);
  if (skipped == identity(folder)) {
    return Ending{kExitUsage, "--batch: the files of OUT_DIR would replace those of IN_DIR"};
  }
  std::error_code error;
  std::vector<fs::path> found;
  for (auto entry = fs::recursive_directory_iterator(folder, error); !error && entry != fs::end(entry);
       entry.increment(error)) {
    std::error_code unreadable;
    if (entry->is_directory(unreadable) && identity(entry->path()) == skipped) entry.disable_recursion_pending();
    if (is_gltf(entry->path()) && entry->is_regular_file(unreadable)) found.push_back(entry->path());
  }
  if (error) return Ending{kExitBadInput, fmt::format("{}: cannot be read: {}", folder.string(), error.message())};

  std::sort(found.begin(), found.end());
  std::vector<BatchFile> files;
  files.reserve(found.size());
  for (const fs::path& input : found) files.push_back({input, to / input.lexically_relative(folder)});
  if (files.empty()) return Ending{kExitBadInput, folder.string() + ": holds no .glb and no .gltf"};
  return files;
}

Plan files_of_list(std::istream& list, const std::string& name, const fs::path& to) {
  std::vector<BatchFile> files;
  for (std::string line; std::getline(list, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) continue;
    const fs::path path = fs::path(line).lexically_normal();
    const bool elsewhere = path.is_absolute() || *path.begin() == "..";
    files.push_back({line, to / (elsewhere ? path.filename() : path)});
  }
  if (list.bad()) return Ending{kExitBadInput, name + ": cannot be read"};
  if (files.empty()) return Ending{kExitBadInput, name + ": names no file"};
  return files;
}

Plan files_of_list(const std::string& name, const fs::path& to) {
  if (is_gltf(name)) return Ending{kExitUsage, fmt::format("--batch: {} is no folder and no list", name)};
  std::ifstream list(name);
  if (!list) return Ending{kExitBadInput, name + ": cannot be read"};
  return files_of_list(list, name, to);
}

/// Two inputs with one output, or an output that is an input.
std::optional<Ending> collision(const std::vector<BatchFile>& files) {
  std::map<fs::path, std::string> input_of;
  std::set<fs::path> inputs;
  for (const BatchFile& file : files) inputs.insert(identity(file.input));
  for (const BatchFile& file : files) {
    const fs::path output = identity(file.output);
    if (inputs.contains(output)) {
      return Ending{kExitUsage, fmt::format("--batch: {} would be replaced: it is an input", file.output)};
    }
    const auto [other, is_new] = input_of.emplace(output, file.input);
    if (is_new) continue;
    return Ending{kExitUsage,
                  fmt::format("--batch: {} and {} would both become {}", other->second, file.input, file.output)};
  }
  return std::nullopt;
}

}  // namespace

Plan plan_batch(const std::string& from, const std::string& to, std::istream& standard_input) {
  std::error_code ignored;
  Plan plan = from == "-"                       ? files_of_list(standard_input, "standard input", to)
              : fs::is_directory(from, ignored) ? files_below(from, to)
                                                : files_of_list(from, to);
  if (const auto* const files = std::get_if<0>(&plan)) {
    if (auto refused = collision(*files)) return std::move(*refused);
  }
  return plan;
}

}  // namespace gltf_radiosity::tools
