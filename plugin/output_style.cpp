#include "plugin/output_style.h"

namespace gltf_radiosity {
namespace {

/// 16 bits are right in every current engine, at half the size of floats. Those that store 8 bits of their own get
/// colours that use all of them; Godot's are linear and cut off, so that here is the place to dither.
OutputStyle style_of(Engine engine) {
  switch (engine) {
    case Engine::kThree:
    case Engine::kBabylon:
    case Engine::kUnity:
      return {ColorType::kU16, false};
    case Engine::kUnreal:
    case Engine::kBlender:
      return {ColorType::kU16, true};
    case Engine::kGodot:
      return {ColorType::kU8, true};
    case Engine::kAny:
      break;
  }
  return {ColorType::kFloat, false};
}

}  // namespace

const char* name_of(ColorType type) {
  return type == ColorType::kFloat ? "float" : type == ColorType::kU16 ? "u16" : "u8";
}

const char* name_of(BakedLight light) {
  return light == BakedLight::kBoth ? "both" : light == BakedLight::kDirect ? "direct" : "indirect";
}

const char* name_of(LightGroupStorage storage) {
  switch (storage) {
    case LightGroupStorage::kMorph:
      return "morph";
    case LightGroupStorage::kAttributes:
      return "attributes";
    case LightGroupStorage::kFiles:
      return "files";
    case LightGroupStorage::kNone:
      break;
  }
  return "none";
}

OutputStyle output_style(const Options& options) {
  OutputStyle style = style_of(options.engine);
  if (options.meshopt && style.color_type == ColorType::kFloat) style.color_type = ColorType::kU16;
  return {options.color_type.value_or(style.color_type), options.scale_to_factor.value_or(style.scale_to_factor)};
}

std::optional<Warning> unreadable_compression(const Options& options) {
  const bool compressed = options.meshopt || options.draco_bits != 0;
  if (options.engine == Engine::kGodot && compressed) {
    return Warning{"engine-cannot-read", "", "Godot reads neither Draco nor meshoptimizer"};
  }
  if (options.engine == Engine::kBlender && options.meshopt) {
    return Warning{"engine-cannot-read", "", "Blender does not read meshoptimizer; it reads Draco"};
  }
  return std::nullopt;
}

}  // namespace gltf_radiosity
