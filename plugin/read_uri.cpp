// URIs -> bytes: data URIs, and files of the glTF's folder.
#include <string_view>

#include "plugin/base64.h"
#include "plugin/check_document.h"
#include "plugin/document.h"

namespace gltf_radiosity {

Result<Bytes> read_uri(const std::string& uri, const InputFolder& folder, const std::string& place) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) {
      return bad_input(place, "the data URI is not base64");
    }
    auto bytes = decode_base64(std::string_view(uri).substr(comma + 1));
    if (!bytes) return bad_input(place, "the data URI is broken base64");
    return std::move(*bytes);
  }
  return read_file_of_uri(uri, folder, place);
}

Result<Bytes> image_bytes(const Document& document, std::size_t image) {
  const Json& json = document.json["images"][image];
  if (!json.contains("bufferView")) {
    return read_uri(json["uri"].get<std::string>(), document.folder, place_of("images", image));
  }
  const Json& view = document.json["bufferViews"][json["bufferView"].get<std::size_t>()];
  const Bytes& buffer = document.buffers[view["buffer"].get<std::size_t>()];
  const auto first = buffer.begin() + static_cast<std::ptrdiff_t>(view.value("byteOffset", std::size_t{0}));
  return Bytes(first, first + static_cast<std::ptrdiff_t>(view["byteLength"].get<std::size_t>()));
}

}  // namespace gltf_radiosity
