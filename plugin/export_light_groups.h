// The light of each group beside the whole: as morph targets of COLOR_0, as attributes, or for files of their own.
//
//   morph:       COLOR_0 is black, and one morph target for each group adds its colours; mesh.weights are the dimmers.
//                Targets hold POSITIONs of zeros, because three.js takes the base's where a target has none; accessors
//                without a bufferView hold zeros for nothing. What moved the mesh before comes first, as it was.
//   attributes:  COLOR_0 stays the whole, `_LIGHT_NAME` holds the share of the group NAME.
//   files:       OUT stays the whole; each group's file differs from it in the bytes of COLOR_0 and its signature.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "plugin/append_accessor.h"
#include "plugin/document.h"
#include "plugin/export_colors.h"
#include "plugin/output_style.h"

namespace gltf_radiosity {

/// How a group is called in what is written.
struct GroupNames {
  std::string name;       ///< as in light_groups.h
  std::string attribute;  ///< "_LIGHT_CEILING": letters, digits and underscores only, each once
  std::string target;     ///< the morph target's: `name`, or "NAME light" where a target of the file is called so
  std::string in_file;    ///< the part of a file's name: letters, digits, '-' and '_', each once in any case
};
std::vector<GroupNames> group_names(const Json& root, std::span<const std::string> names);

/// The bytes of COLOR_0 in the file of one group: at each offset of the added buffer.
struct ColorBytes {
  std::size_t offset = 0;
  Bytes bytes;
};
using GroupBytes = std::vector<std::vector<ColorBytes>>;  ///< [group_count]

/// What the functions below write to and with.
struct GroupExport {
  Document& document;
  BufferBuilder& buffer;
  LightGroupStorage storage;
  ColorType color_type;
  std::vector<GroupNames> names;  ///< [group_count]
  GroupBytes bytes{};             ///< for LightGroupStorage::kFiles
  std::set<std::size_t> morphed_meshes{};
};

/// Adds the colours of each group, [group_count], to a primitive whose COLOR_0 was exported from `whole` at exposure
/// `k`. `mesh` is where it will be. REQUIRES: COLOR_0 lies in the added buffer.
void export_group_colors(GroupExport& groups, const VertexColors& whole, std::span<const VertexColors> of_group,
                         std::span<const std::uint32_t> kept, const radiosity::Rgb& k, std::size_t mesh,
                         Json& primitive);

/// Once all primitives are in their places: gives the others of their meshes as many targets, and makes names, weights
/// and animations know the new ones. Notes in asset.extras.radiosity what was done. Animations that cannot be followed
/// are left, with a warning.
void finish_groups(GroupExport& groups, std::vector<Warning>& warnings);

/// An error if the file has an attribute of a group's name already.
Result<Done> check_group_attributes_are_free(const Document& document, const Options& options,
                                             std::span<const std::string> names);

}  // namespace gltf_radiosity
