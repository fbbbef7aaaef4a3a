#include "plugin/select_nodes.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <optional>
#include <string>

#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

/// The patterns *, ? and [...] of the shell.
bool fits(const std::string& pattern, const std::string& name) {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

bool fits_any(const std::vector<std::string>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) { return fits(pattern, name); });
}

/// extras.radiosity.ignore; a warning if it is there but makes no sense.
std::optional<bool> ignored_in_extras(const Json& node, std::size_t index, std::vector<Warning>& warnings) {
  const Json* ignore = member_at(node, {"extras", "radiosity", "ignore"});
  if (ignore == nullptr) return std::nullopt;
  if (ignore->is_boolean()) return ignore->get<bool>();
  warnings.push_back({"bad-ignore", place_of("nodes", index),
                      "extras.radiosity.ignore is neither true nor false and was taken for nothing"});
  return std::nullopt;
}

}  // namespace

Result<std::vector<std::uint8_t>> receiving_nodes(const Document& document, std::span<const std::uint32_t> visible,
                                                  const Options& options, std::vector<Warning>& warnings) {
  // Names.
  const Json& nodes = array_of(document.json, "nodes");
  const auto name_of = [&](std::uint32_t node) { return nodes[node].value("name", std::string()); };
  const auto check = [&](const char* option, const std::vector<std::string>& patterns) -> Result<Done> {
    for (const std::string& pattern : patterns) {
      const bool known =
          std::any_of(visible.begin(), visible.end(), [&](std::uint32_t node) { return fits(pattern, name_of(node)); });
      if (known) continue;
      return Error{ErrorCode::kBadOption, option, fmt::format("no node of the scene is called \"{}\"", pattern)};
    }
    return Done{};
  };
  if (const auto checked = check("--select", options.select); !checked) return checked.error();
  if (const auto checked = check("--exclude", options.exclude); !checked) return checked.error();

  // From the roots down.
  std::vector<std::uint8_t> receives(nodes.size(), options.select.empty() ? 1 : 0);
  for (const std::uint32_t node : visible) {
    const auto ignored = ignored_in_extras(nodes[node], node, warnings);
    if (ignored) receives[node] = *ignored ? 0 : 1;
    const std::string name = name_of(node);
    if (fits_any(options.select, name)) receives[node] = 1;
    if (fits_any(options.exclude, name)) receives[node] = 0;
    for (const Json& child : array_of(nodes[node], "children")) receives[child.get<std::size_t>()] = receives[node];
  }
  return receives;
}

}  // namespace gltf_radiosity
