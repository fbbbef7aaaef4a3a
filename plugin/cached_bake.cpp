#include "plugin/cached_bake.h"

#include <algorithm>
#include <utility>

#include "plugin/bake_archive.h"
#include "plugin/cache_folder.h"
#include "plugin/cache_keys.h"
#include "plugin/rows_archive.h"

namespace gltf_radiosity {
namespace {

/// Finds rows in the cache and puts them there.
class CachedRows final : public radiosity::RowKeeper {
 public:
  CachedRows(CacheFolder& cache, const Document& document, const ImportedScene& scene)
      : cache_(cache), document_(document), scene_(scene) {}

  std::unique_ptr<radiosity::RowSource> recall(const radiosity::RowInputs& inputs) override {
    auto rows = cache_.load(kRowsArchive, key_of(inputs),
                            [&](const Archive& archive) { return read_rows(archive, inputs.patches.patch_count()); });
    found_ = rows.has_value();
    return found_ ? std::move(*rows) : nullptr;
  }

  void keep(const radiosity::RowInputs& inputs, const radiosity::RowCache& rows) override {
    ArchiveWriter archive(kRowsArchive);
    add_rows(archive, rows);
    cache_.store(kRowsArchive, key_of(inputs), archive);
  }

  bool found() const { return found_; }

 private:
  const std::string& key_of(const radiosity::RowInputs& inputs) {
    if (key_.empty()) key_ = rows_key(document_, scene_, inputs);
    return key_;
  }

  CacheFolder& cache_;
  const Document& document_;
  const ImportedScene& scene_;
  std::string key_;
  bool found_ = false;
};

/// What memory allows of elements and of tiles.
struct CountLimits {
  std::uint64_t elements, tiles;
};

/// A mesh a quarter as large as both limits has met neither: no step of subdivision adds three times what there is.
bool is_same_under_limit(std::size_t count, std::uint64_t limit_then, std::uint64_t limit_now) {
  return limit_then == limit_now || count <= std::min(limit_then, limit_now) / 4;
}

/// The bake that an entry holds; empty if other limits could have made it another.
Result<std::optional<radiosity::Bake>> read_entry(const Archive& archive, const ImportedScene& scene,
                                                  const CountLimits& now) {
  const auto then = archive.read_value<CountLimits>("limits");
  if (!then) return then.error();
  Result<radiosity::Bake> bake = read_bake(archive, scene.scene.positions.size(), scene.scene.triangles.size());
  if (!bake) return bake.error();
  const bool is_same = is_same_under_limit(bake->mesh.elements.size(), then->elements, now.elements) &&
                       is_same_under_limit(bake->report.tile_count, then->tiles, now.tiles);
  return is_same ? std::optional(std::move(*bake)) : std::nullopt;
}

}  // namespace

const char* name_of(Spared spared) {
  switch (spared) {
    case Spared::kNoCache:
      return "";
    case Spared::kNothing:
      return "nothing";
    case Spared::kFormFactors:
      return "form-factors";
    case Spared::kBake:
      return "bake";
  }
  return "";
}

Result<CachedBake> bake_through_cache(const Document& document, const ImportedScene& scene, const Options& options,
                                      radiosity::BakeOptions bake_options, std::vector<Warning>& warnings,
                                      const radiosity::Progress& progress) {
  if (options.cache.empty()) return CachedBake{radiosity::bake(scene.scene, bake_options, progress), Spared::kNoCache};
  progress.update("cache", 0.0);
  Result<CacheFolder> cache = CacheFolder::open(options.cache, options.cache_size, warnings);
  if (!cache) return cache.error();

  // A bake that was finished. The light of groups, and what follows from it, is not kept with it.
  const Result<std::string> key = bake_key(document, options, bake_options);
  if (!key) return key.error();
  const CountLimits limits{bake_options.subdivide.max_elements, bake_options.max_tiles};
  const bool whole = !bake_options.light_groups;
  if (whole) {
    auto found =
        cache->load(kBakeArchive, *key, [&](const Archive& archive) { return read_entry(archive, scene, limits); });
    progress.update("cache", 1.0);
    if (found && *found) return CachedBake{std::move(**found), Spared::kBake};
  }

  // Form factors, if these are there.
  CachedRows rows(*cache, document, scene);
  bake_options.row_keeper = &rows;
  CachedBake result{radiosity::bake(scene.scene, bake_options, progress), Spared::kNothing};
  if (rows.found()) result.spared = Spared::kFormFactors;
  if (!whole || result.bake.report.out_of_time) return result;

  progress.update("cache", 0.0);
  ArchiveWriter archive(kBakeArchive);
  archive.add_value("limits", limits);
  add_bake(archive, result.bake);
  cache->store(kBakeArchive, *key, archive);
  progress.update("cache", 1.0);
  return result;
}

}  // namespace gltf_radiosity
