#include "plugin/content_name.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <string>
#include <string_view>

namespace gltf_radiosity {
namespace {

constexpr std::size_t kDigits = 16;

}  // namespace

std::filesystem::path name_by_content(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::filesystem::path name = path;
  return name.replace_filename(fmt::format("{}-{:016x}{}", path.stem().string(),
                                           ::XXH3_64bits(bytes.data(), bytes.size()), path.extension().string()));
}

bool is_name_by_content(const std::filesystem::path& name, const std::filesystem::path& original) {
  const std::string stem = name.stem().string(), start = original.stem().string() + "-";
  return name.extension() == original.extension() && stem.size() == start.size() + kDigits && stem.starts_with(start) &&
         std::string_view(stem).substr(start.size()).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace gltf_radiosity
