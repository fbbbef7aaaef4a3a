// What the page of `gltf-radiosity view` is put together from; it lies in the library.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace gltf_radiosity {

/// The texts as they are in this folder, and three.js.
struct PageParts {
  std::string_view html;                   ///< with @NAMES@ where the others go (plugin/view.cpp)
  std::string_view style;                  ///< page.css
  std::string_view script;                 ///< main.js and all it imports, in one; holds no "</script"
  std::string_view notices;                ///< whose work is in it, and under which terms
  std::string_view three_licence;          ///< belongs to them
  std::span<const std::uint8_t> draco_js;  ///< Draco's decoder, for scenes that need it
  std::span<const std::uint8_t> draco_wasm;
};

/// None if the library was built without the page (-D GLTF_RADIOSITY_VIEW=OFF).
std::optional<PageParts> page_parts();

}  // namespace gltf_radiosity
