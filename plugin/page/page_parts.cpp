// The assembler takes whole files in; C++ learns that with #embed.
#include "plugin/page/page_parts.h"

// NOLINTBEGIN(cppcoreguidelines-macro-usage,hicpp-no-assembler,modernize-avoid-c-arrays)
#define GLTF_RADIOSITY_PART(name, file)                                                             \
  asm(".section .rodata\n.hidden gltf_radiosity_page_" #name "\n.global gltf_radiosity_page_" #name \
      "\ngltf_radiosity_page_" #name ":\n.incbin \"" file "\"\n.hidden gltf_radiosity_page_" #name  \
      "_end\n.global gltf_radiosity_page_" #name                                                    \
      "_end\n"                                                                                      \
      "gltf_radiosity_page_" #name "_end:\n.byte 0\n.previous\n");                                  \
  extern "C" const std::uint8_t gltf_radiosity_page_##name[];                                       \
  extern "C" const std::uint8_t gltf_radiosity_page_##name##_end[];

GLTF_RADIOSITY_PART(html, PAGE_SOURCES "/page.html")
GLTF_RADIOSITY_PART(style, PAGE_SOURCES "/page.css")
GLTF_RADIOSITY_PART(script, PAGE_BUNDLE)
GLTF_RADIOSITY_PART(notices, PAGE_SOURCES "/notices.txt")
GLTF_RADIOSITY_PART(three_licence, PAGE_THREE "/LICENSE")
GLTF_RADIOSITY_PART(draco_js, PAGE_DRACO "/draco_wasm_wrapper.js")
GLTF_RADIOSITY_PART(draco_wasm, PAGE_DRACO "/draco_decoder.wasm")

#define GLTF_RADIOSITY_SPAN(name) std::span(gltf_radiosity_page_##name, gltf_radiosity_page_##name##_end)
// NOLINTEND(cppcoreguidelines-macro-usage,hicpp-no-assembler,modernize-avoid-c-arrays)

namespace gltf_radiosity {
namespace {

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::optional<PageParts> page_parts() {
  return PageParts{text_of(GLTF_RADIOSITY_SPAN(html)),
                   text_of(GLTF_RADIOSITY_SPAN(style)),
                   text_of(GLTF_RADIOSITY_SPAN(script)),
                   text_of(GLTF_RADIOSITY_SPAN(notices)),
                   text_of(GLTF_RADIOSITY_SPAN(three_licence)),
                   GLTF_RADIOSITY_SPAN(draco_js),
                   GLTF_RADIOSITY_SPAN(draco_wasm)};
}

}  // namespace gltf_radiosity
