// START HERE, the public API: bakes diffuse global illumination into the vertex colours of a glTF scene.
//
// read -> import -> bake -> export -> write. Nothing here throws; nothing prints; no third-party types.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "result.h"  // by its short name: installed, the two lie side by side

namespace gltf_radiosity {

/// The library's version, "major.minor.patch".
std::string_view version();

enum class Refine { kNone, kUniform, kAdaptive };
enum class ErrorSpace { kDisplay, kLinear };
enum class VisibilityMethod { kAuto, kRaster, kRays };
enum class SolverMethod { kProgressive, kGathering };
enum class FitMethod { kLeastSquares, kInterpolate };
enum class Metals { kDiffuse, kBlack };
enum class LightUnits { kAuto, kSi, kBlender };
enum class ColorType { kFloat, kU16, kU8 };
enum class BakedLight { kBoth, kDirect, kIndirect };
enum class Target { kUnlit, kKeep };
/// Where the light of each light group goes.
enum class LightGroupStorage { kNone, kMorph, kAttributes, kFiles };
enum class TwoSided { kFront, kLit };
enum class Engine { kAny, kThree, kBabylon, kGodot, kUnity, kUnreal, kBlender };

/// The sun: a directional light at infinity.
struct Sun {
  double elevation_degrees = 0.0;  ///< above the horizon
  double azimuth_degrees = 0.0;    ///< the sun stands at (cos el sin az, sin el, cos el cos az), Y up
  double illuminance_lux = 0.0;    ///< on a surface that faces it
};

/// Every option of a bake. The defaults are what the command line's --help prints.
struct Options {
  std::optional<std::uint32_t> scene;  ///< which scene of the file, counted from 0; none: its default one, or the first
  bool allow_outside = false;          ///< buffers and images may lie outside the folder of the file
  // Mesh
  Refine refine = Refine::kAdaptive;
  double patch_size = 0.0;         ///< longest edge of the baked mesh, metres; 0 chooses one that suits the scene
  double max_error = 0.02;         ///< adaptive: cut until the estimated relative RMSE is not above this, > 0
  std::uint64_t max_vertices = 0;  ///< adaptive: or until there are this many; 0: those of the file and 16 000 more
  ErrorSpace error_space = ErrorSpace::kDisplay;       ///< adaptive: in which errors are compared to cut the worst
  std::vector<std::pair<std::string, int>> subdivide;  ///< node name -> times each triangle is cut in four, [0, 8]
  /// Vertices that neither shape, attributes nor light need are left out; the light may change by `max_error` of its
  /// mean.
  bool simplify = false;
  // Nodes, by patterns of their names (*, ?, [...]), with everything below: select_nodes.h
  std::vector<std::string> select;   ///< what receives light; empty: everything
  std::vector<std::string> exclude;  ///< what does not
  // Light
  BakedLight bake = BakedLight::kBoth;       ///< what comes straight from lamps, lights and sky, what surfaces reflect
  std::optional<std::array<double, 3>> sky;  ///< luminance of the open sky, cd/m2, linear Rec. 709
  std::string sky_file;               ///< or a Radiance HDR image of it, equirectangular, cd/m2; +x in its middle
  double sky_rotation_degrees = 0.0;  ///< turns the sky about y, towards larger azimuth
  std::optional<Sun> sun;
  bool default_sky = true;  ///< a scene without any light gets a white sky of 1 cd/m2
  Metals metals = Metals::kDiffuse;
  LightUnits light_units = LightUnits::kAuto;
  // Transport
  int hemicube = 16;  ///< cells along one edge, even, [2, 512]
  VisibilityMethod visibility = VisibilityMethod::kAuto;
  SolverMethod solver = SolverMethod::kGathering;
  double residual = 0.001;  ///< stop at this share of unshot flux, (0, 1)
  int max_patches = 0;      ///< 0: as many as the baked mesh is worth
  FitMethod fit = FitMethod::kLeastSquares;
  /// What the bake may take, bytes, as far as it can be told beforehand: what the file claims is counted, rows of form
  /// factors take half of the rest at most, the mesh stops growing in time; 0 is default_max_memory().
  std::uint64_t max_memory = 0;
  int threads = 0;  ///< 0: every core
  /// Seconds after which the bake ends with the light it has by then; the mesh is refined and the light exchanged no
  /// further. The bytes then depend on the machine. 0: as many as it takes. What cannot be done any faster, as reading
  /// and writing, may take longer; if there is no light by then, the bake fails with ErrorCode::kLimit.
  double time_limit = 0.0;
  // Cache
  std::string cache;  ///< folder where results are kept for bakes of the same content; empty: none
  std::uint64_t cache_size = std::uint64_t{4} << 30U;  ///< bytes it may grow to: what was used longest ago goes first
  // Output
  std::optional<double> exposure;       ///< k, m2/cd; none chooses automatically
  Engine engine = Engine::kAny;         ///< chooses where the next two say nothing
  std::optional<ColorType> color_type;  ///< none: the engine's; kFloat for any, or kU16 with `meshopt`
  /// Colours of a primitive are scaled up to end at 1, its material's base colour factor down by as much. None: the
  /// engine's; false for any.
  std::optional<bool> scale_to_factor;
  /// What doubleSided surfaces show whose front no light can reach and whose back it can.
  TwoSided two_sided = TwoSided::kFront;
  Target target = Target::kUnlit;  ///< kKeep: materials stay lit, and COLOR_0 is light without their base colour
  std::string radiance_attribute;  ///< name of a custom attribute for the light of COLOR_0, not clamped; empty: none
  std::string save_transport;      ///< a file that relight.h changes the light by; empty: none
  /// The light of each group of lamps beside the whole: as morph targets, as attributes, or in a file for each.
  LightGroupStorage light_groups = LightGroupStorage::kNone;
  /// Group name, and a pattern (*, ?, [...]) of names of lights, their nodes and emissive materials: light_groups.h
  std::vector<std::pair<std::string, std::string>> groups;
  bool strip_lights = false;              ///< leaves punctual and image based lights out of the output
  bool force = false;                     ///< the output may replace the input, or a buffer or image of it
  std::vector<std::string> also_written;  ///< what the caller writes himself, as reports: refused if it is the input's
  int draco_bits = 0;                     ///< colours within KHR_draco_mesh_compression, [8, 24]; 0 does not compress
  bool meshopt = false;                   ///< EXT_meshopt_compression; not together with Draco
};

/// Called from one thread at a time.
struct Callbacks {
  /// `phase` is one of "read", "import", "cache", "subdivide", "patches", "direct", "sky", "solve", "gather", "fit",
  /// "refine", "simplify", "export", "transport", "compress", "write"; `done` in [0,1].
  std::function<void(std::string_view phase, double done)> progress;
  /// Answer true to stop: the bake ends with ErrorCode::kCancelled within a second and writes nothing.
  std::function<bool()> cancelled;
};

/// Something the user should know although the bake succeeded.
struct Warning {
  std::string code;     ///< stable, kebab-case: "default-sky", "degenerate-triangles", ...
  std::string place;    ///< `nodes[3]`, or empty
  std::string message;  ///< one sentence
};

struct PhaseReport {
  std::string name;
  double seconds = 0.0;
  std::uint64_t peak_memory_bytes = 0;  ///< highest resident size of the process by the end of the phase
};

/// What a bake did.
struct Report {
  std::uint64_t input_triangles = 0;
  std::uint64_t input_vertices = 0;
  std::uint64_t output_triangles = 0;
  std::uint64_t output_vertices = 0;
  std::uint64_t removed_vertices = 0;  ///< left out because nothing needs them
  std::uint64_t patches = 0;
  std::uint64_t lights = 0;  ///< punctual ones
  std::uint64_t emissive_triangles = 0;
  std::uint64_t steps = 0;
  std::uint64_t buried_elements = 0;
  double patch_size = 0.0;  ///< metres, the one used; 0 with Refine::kNone
  double residual = 0.0;
  double estimated_error = 0.0;  ///< of the baked light: root mean square over mean luminance
  std::uint64_t refine_rounds = 0;
  std::string refine_end;  ///< why refinement ended: "error", "limit", "floor", "time"; empty where it was not adaptive
  bool time_limit_reached = false;        ///< the light is what there was when time was up
  double emitted_flux = 0.0;              ///< lm
  double absorbed_flux = 0.0;             ///< lm
  double escaped_flux = 0.0;              ///< lm
  double closure_error = 0.0;             ///< largest difference of a row of form factors from 1
  double reciprocity_error = 0.0;         ///< mean |A_i F_ij - A_j F_ji| over mean A_i F_ij
  std::uint64_t lamps = 0;                ///< parts of emissive triangles that get shadow rays
  double glow_share = 0.0;                ///< of the emitted light: what gets none, [0,1]
  double exposure = 1.0;                  ///< k, m2/cd
  double clipped_share = 0.0;             ///< of the baked area
  std::uint64_t baked_triangles = 0;      ///< of output_triangles: those that received light
  std::string light;                      ///< "both", "direct" or "indirect"
  std::string color_type;                 ///< "float", "u16" or "u8"
  std::string compression;                ///< "draco", "meshopt" or empty
  std::string visibility;                 ///< "raster" or "rays"
  std::string cache;                      ///< what was spared: "nothing", "form-factors" or "bake"; empty without one
  std::uint64_t transport_bytes = 0;      ///< of the file for relighting; 0 without one
  std::uint64_t transport_sources = 0;    ///< lights, emissive materials and skies that it can change
  bool transport_reflectance = false;     ///< whether it can change what surfaces reflect
  std::vector<std::string> light_groups;  ///< their names; empty unless they were kept apart
  std::vector<PhaseReport> phases;
  std::vector<Warning> warnings;
};

/// Bakes `input` (.glb or .gltf) and writes `output`: .glb, .gltf with a .bin beside it, or .embedded.gltf with
/// everything in one JSON file. With LightGroupStorage::kFiles there is an output.NAME.glb for each group besides. All
/// of it appears whole or not at all.
Result<Report> bake_file(const std::string& input, const std::string& output, const Options& options,
                         const Callbacks& callbacks = {});

struct BakedGlb {
  std::vector<std::byte> glb;
  Report report;
};

/// Bakes a glTF held in memory (GLB, or JSON whose buffers and images are data URIs) into a GLB.
Result<BakedGlb> bake_memory(std::span<const std::byte> input, const Options& options, const Callbacks& callbacks = {});

/// What Options::max_memory stands for when it is 0, bytes: three quarters of what the machine has, or of what the
/// control groups of this process may have.
std::uint64_t default_max_memory();

/// The report as JSON, indented by two spaces.
std::string to_json(const Report& report);

}  // namespace gltf_radiosity
