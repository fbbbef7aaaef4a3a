// The file that --save-transport writes and relight reads: an archive (archive.h) of
//
//   description   JSON: what shines, what it shines on, where its colours lie
//   document      the baked glTF as a GLB, before its geometry is compressed
//   rows.*        what COLOR_0 is made of, vertex by vertex of one primitive after the other
//   light.*       what other lights take (core/light_transport.h)
//   exchange.*    what other reflectances take; absent where it would have taken too much memory
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bake.h"
#include "core/light_transport.h"
#include "plugin/append_accessor.h"
#include "plugin/archive.h"
#include "plugin/document.h"
#include "plugin/export_scene.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// A material of the source, as far as it can be changed.
struct TransportMaterial {
  std::string name;                     ///< in the file, or `materials[3]`
  std::optional<std::uint32_t> source;  ///< index of the document's material
  radiosity::Rgb factor{1.0F};          ///< base colour, linear
  std::optional<std::uint32_t> shines;  ///< which of the sources it is
  bool transmits = false;               ///< then what it reflects is not in proportion to its factor
};

/// A primitive that shows light.
struct TransportPrimitive {
  std::size_t mesh = 0, primitive = 0;  ///< of the document
  std::uint32_t material = 0;           ///< in TransportDescription::materials
  radiosity::Rgb factor{1.0F};          ///< COLOR_0 was divided by it
  std::uint64_t first_row = 0, row_count = 0;
};

struct TransportDescription {
  std::vector<LightSource> sources;
  std::vector<TransportMaterial> materials;
  std::vector<std::uint32_t> material_of_surface;
  std::vector<TransportPrimitive> primitives;
  double exposure = 1.0;
  std::uint64_t geometry = 0;          ///< geometry_hash() of the source
  std::optional<std::uint32_t> scene;  ///< options.scene
  bool tinted = true;                  ///< COLOR_0 holds the base colour factor
  std::string radiance_semantic;       ///< of the attribute that holds light without a limit; empty: none
  radiosity::LightParts parts = radiosity::LightParts::kBoth;
  ColorType color_type = ColorType::kFloat;
  int draco_bits = 0;
  bool meshopt = false;
};

/// What a bake leaves to be saved, after the export and before the compression.
struct SavedBake {
  const Document& document;
  const BufferBuilder& added;
  const ImportedScene& scene;
  const radiosity::Bake& bake;  ///< with its transport
  const ExportReport& exported;
  const Options& options;
};

/// A number for where everything stands, of what and of what materials' surfaces. Lights and colours do not count.
std::uint64_t geometry_hash(const ImportedScene& imported);

/// Writes the file options.save_transport and tells `report` about it.
Result<Done> save_transport(const SavedBake& saved, Report& report);

/// The rows of all primitives. Shapes: [row_count].
struct TransportRows {
  std::span<const std::uint32_t> vertex;     ///< of the baked mesh
  std::span<const radiosity::Rgb> undyed;    ///< as in ColorTerms
  std::span<const radiosity::Rgb> emission;  ///< likewise, before it is dimmed, cd/m2
  std::span<const float> alpha, areas;       ///< likewise
  std::span<const std::uint32_t> places;     ///< likewise
};

/// An open file. The spans stay valid as long as it does.
struct LoadedTransport {
  TransportDescription description;
  Document document;
  TransportRows rows;
  radiosity::LightTransport light;
  bool can_reflect = false;  ///< whether what surfaces reflect can be changed
  std::vector<std::shared_ptr<const void>> owners;
};

/// Reads what other lights take, and what other reflectances take if that is `with_exchange`. Errors say what is wrong
/// with the file: damaged, cut off, of another version, not a transport.
Result<LoadedTransport> load_transport(const std::filesystem::path& path, bool with_exchange);

}  // namespace gltf_radiosity
