// Bytes as text, as data URIs and the page of `gltf-radiosity view` hold them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Four digits for each three bytes, padded with '='.
std::string encode_base64(std::span<const std::uint8_t> bytes);

/// The digits of both alphabets, padded or not; none if there is anything else.
std::optional<Bytes> decode_base64(std::string_view text);

}  // namespace gltf_radiosity
