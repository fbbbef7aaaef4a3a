#include "plugin/morph_weights.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

/// What the targets before were called: numbers where nobody named them.
Json names_before(const Json& mesh, std::size_t count) {
  Json names = Json::array();
  const Json* known = member_at(mesh, {"extras", "targetNames"});
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_named = known != nullptr && known->is_array() && i < known->size() && (*known)[i].is_string();
    names.push_back(is_named ? (*known)[i] : Json(fmt::format("target {}", i)));
  }
  return names;
}

/// `weights`, as many as there were targets, and a one for each new target.
Json extended(const Json& weights, const AddedTargets& added) {
  Json result = Json::array();
  for (std::size_t i = 0; i < added.old_count; ++i) {
    result.push_back(weights.is_array() && i < weights.size() ? weights[i] : Json(0.0));
  }
  for (std::size_t i = 0; i < added.names.size(); ++i) result.push_back(1.0);
  return result;
}

/// A whole number that is not negative, or none.
std::optional<std::size_t> whole_number(const Json* value) {
  if (value == nullptr || !value->is_number_integer() || *value < 0) return std::nullopt;
  return value->get<std::size_t>();
}

/// Follows the animations of the weights of a mesh.
class WeightAnimations {
 public:
  WeightAnimations(Document& document, BufferBuilder& buffer, const AddedTargets& added, std::set<std::string> pointers,
                   std::set<std::size_t> nodes)
      : document_(document), buffer_(buffer), added_(added), pointers_(std::move(pointers)), nodes_(std::move(nodes)) {}

  void run(std::vector<Warning>& warnings) {
    const std::size_t count = array_of(document_.json, "animations").size();
    for (std::size_t i = 0; i < count; ++i) {
      for (const std::size_t sampler : samplers_of(document_.json["animations"][i])) {
        Json& animation = document_.json["animations"][i];
        if (animation.contains("samplers") && extend(animation["samplers"], sampler)) continue;
        warnings.push_back({"animation-left", place_of("animations", i),
                            "what it does with the weights of a baked mesh makes no sense; it was left as it is"});
      }
    }
  }

 private:
  bool animates(const Json& channel) const {
    const Json* path = member_at(channel, {"target", "path"});
    const Json* node = member_at(channel, {"target", "node"});
    const Json* pointer = member_at(channel, {"target", "extensions", "KHR_animation_pointer", "pointer"});
    if (pointer != nullptr) return pointer->is_string() && pointers_.contains(pointer->get<std::string>());
    const auto number = whole_number(node);
    return path != nullptr && *path == "weights" && number && nodes_.contains(*number);
  }

  std::set<std::size_t> samplers_of(const Json& animation) const {
    std::set<std::size_t> samplers;
    for (const Json& channel : array_of(animation, "channels")) {
      const auto sampler = whole_number(member_at(channel, {"sampler"}));
      if (animates(channel) && sampler) samplers.insert(*sampler);
    }
    return samplers;
  }

  std::optional<std::size_t> accessor_of(const Json& sampler, const char* key) const {
    const auto accessor = whole_number(member_at(sampler, {key}));
    const Json& accessors = array_of(document_.json, "accessors");
    return accessor && *accessor < accessors.size() && is_of_the_file(accessors[*accessor]) ? accessor : std::nullopt;
  }

  /// Whether an accessor's data can be read: what was appended cannot be yet.
  bool is_of_the_file(const Json& accessor) const {
    if (!accessor.contains("bufferView")) return true;
    const Json& view = document_.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    return view["buffer"].get<std::size_t>() < document_.buffers.size();
  }

  /// False if the sampler makes no sense.
  bool extend(Json& samplers, std::size_t number) {
    if (!samplers.is_array() || number >= samplers.size()) return false;
    const auto input = accessor_of(samplers[number], "input"), output = accessor_of(samplers[number], "output");
    if (!input || !output) return false;
    const bool is_cubic = samplers[number].value("interpolation", Json()) == "CUBICSPLINE";
    const std::size_t keys = document_.json["accessors"][*input]["count"].get<std::size_t>();
    const std::size_t parts = is_cubic ? 3 : 1;
    const RawAccessor raw = read_accessor(document_, *output);
    if (raw.components != 1 || raw.count != keys * parts * added_.old_count || keys == 0) return false;
    const auto [known, is_new] = extended_.try_emplace({*output, is_cubic}, 0);
    if (is_new) known->second = append(with_ones(as_floats(raw), keys * parts, is_cubic), *output);
    samplers[number]["output"] = known->second;
    return true;
  }

  /// Each row of weights with a one for each new target; tangents, before and behind them, with zeros.
  std::vector<float> with_ones(const std::vector<float>& rows, std::size_t row_count, bool is_cubic) const {
    std::vector<float> result;
    for (std::size_t row = 0; row < row_count; ++row) {
      const auto first = rows.begin() + static_cast<std::ptrdiff_t>(row * added_.old_count);
      result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(added_.old_count));
      result.insert(result.end(), added_.names.size(), !is_cubic || row % 3 == 1 ? 1.0F : 0.0F);
    }
    return result;
  }

  std::size_t append(const std::vector<float>& values, std::size_t like) {
    const RawAccessor raw{ComponentType::kF32, 1, false, values.size(),
                          encode_floats(values, ComponentType::kF32, false)};
    const std::size_t index =
        append_accessor(document_, buffer_, raw, BufferTarget::kIndices, document_.json["accessors"][like]);
    document_.json["bufferViews"].back().erase("target");  // neither vertices nor indices
    return index;
  }

  Document& document_;
  BufferBuilder& buffer_;
  const AddedTargets& added_;
  std::set<std::string> pointers_;
  std::set<std::size_t> nodes_;
  std::map<std::pair<std::size_t, bool>, std::size_t> extended_;
};

}  // namespace

void add_morph_weights(Document& document, BufferBuilder& buffer, std::size_t mesh, const AddedTargets& added,
                       std::vector<Warning>& warnings) {
  // The mesh.
  Json& json = document.json["meshes"][mesh];
  Json names = names_before(json, added.old_count);
  for (const std::string& name : added.names) names.push_back(name);
  if (json.contains("extras") && !json["extras"].is_object()) {
    Json original = std::move(json["extras"]);
    json["extras"] = {{"original", std::move(original)}};
  }
  json["extras"]["targetNames"] = std::move(names);
  json["weights"] = extended(json.value("weights", Json()), added);

  // Its nodes, and what moves them.
  std::set<std::size_t> nodes;
  std::set<std::string> pointers = {fmt::format("/meshes/{}/weights", mesh)};
  for (std::size_t node = 0; node < array_of(document.json, "nodes").size(); ++node) {
    Json& shown = document.json["nodes"][node];
    if (!shown.contains("mesh") || shown["mesh"] != mesh) continue;
    nodes.insert(node);
    pointers.insert(fmt::format("/nodes/{}/weights", node));
    if (shown.contains("weights")) shown["weights"] = extended(shown["weights"], added);
  }
  if (added.old_count > 0)
    WeightAnimations(document, buffer, added, std::move(pointers), std::move(nodes)).run(warnings);
}

}  // namespace gltf_radiosity
