#include "plugin/merge_buffers.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "plugin/check_document.h"
#include "plugin/meshopt_decode.h"
#include "plugin/our_extras.h"

namespace gltf_radiosity {
namespace {

std::size_t append_aligned(Bytes& bytes, std::span<const std::uint8_t> more) {
  bytes.resize((bytes.size() + 3) / 4 * 4);
  const std::size_t offset = bytes.size();
  bytes.insert(bytes.end(), more.begin(), more.end());
  return offset;
}

/// Where the data of a buffer is after the merge.
struct NewPlace {
  std::size_t buffer = 0, offset = 0;
};

/// Points `view` (a bufferView, or an extension of one that names a buffer) to the merged buffer.
void rebase(Json& view, const std::vector<NewPlace>& places) {
  const NewPlace& place = places[view["buffer"].get<std::size_t>()];
  const std::size_t offset = place.offset + view.value("byteOffset", std::size_t{0});
  view["buffer"] = place.buffer;
  if (offset != 0 || view.contains("byteOffset")) view["byteOffset"] = offset;
}

void rebase_views(Json& root, const std::vector<NewPlace>& places) {
  if (!root.contains("bufferViews")) return;
  for (Json& view : root["bufferViews"]) {
    rebase(view, places);
    if (!view.contains("extensions")) continue;
    for (Json& extension : view["extensions"]) {
      const bool names_buffer = extension.is_object() && extension.contains("buffer") &&
                                extension["buffer"].is_number_unsigned() &&
                                extension["buffer"].get<std::size_t>() < places.size();
      if (names_buffer) rebase(extension, places);
    }
  }
}

}  // namespace

Bytes merge_buffers(Document& document, const BufferBuilder& added) {
  // Reserve once: the data may be most of the memory there is.
  Json& root = document.json;
  std::size_t total = added.bytes().size() + 8;
  for (const Bytes& buffer : document.buffers) total += buffer.size() + 4;
  Bytes merged;
  merged.reserve(total);

  // Bytes.
  std::vector<NewPlace> places;
  for (std::size_t i = 0; i < document.buffers.size(); ++i) {
    const Bytes bytes = std::move(document.buffers[i]);
    const std::size_t length = root["buffers"][i]["byteLength"].get<std::size_t>();
    places.push_back({0, append_aligned(merged, std::span(bytes).first(length))});
  }
  document.buffers.clear();
  places.push_back({0, append_aligned(merged, added.bytes())});
  places.push_back({1, 0});

  // Tree. The first buffer keeps its name and extras, and writes down what the others had.
  rebase_views(root, places);
  Json buffer = root.contains("buffers") && !root["buffers"].empty() ? root["buffers"][0] : Json::object();
  buffer.erase("uri");
  for (std::size_t i = 1; i < array_of(root, "buffers").size(); ++i) {
    Json described = root["buffers"][i];
    for (const char* key : {"uri", "byteLength"}) described.erase(key);
    if (!described.empty()) our_extras(buffer)["merged"].push_back(std::move(described));
  }
  buffer["byteLength"] = merged.size();
  if (merged.empty()) {
    root.erase("buffers");
  } else {
    root["buffers"] = Json::array({std::move(buffer)});
  }
  if (added.decoded_size() > 0) {
    Json decoded = {{"byteLength", added.decoded_size()}};
    decoded["extensions"][kMeshoptExtension] = {{"fallback", true}};
    root["buffers"].push_back(std::move(decoded));
  }
  return merged;
}

Result<Done> embed_images(Document& document, Bytes& merged) {
  Json& root = document.json;
  if (!root.contains("images")) return Done{};
  for (std::size_t i = 0; i < root["images"].size(); ++i) {
    if (!is_external(root["images"][i])) continue;
    const Result<Bytes> bytes = image_bytes(document, i);
    if (!bytes) return bytes.error();

    const std::size_t offset = append_aligned(merged, *bytes);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes->size()}});
    Json& image = root["images"][i];
    image.erase("uri");
    image["bufferView"] = root["bufferViews"].size() - 1;
    if (!image.contains("mimeType")) image["mimeType"] = image_type(*bytes);
  }
  if (!merged.empty()) root["buffers"][0]["byteLength"] = merged.size();
  return Done{};
}

const char* image_type(std::span<const std::uint8_t> bytes) {
  struct Signature {
    std::size_t at;
    std::string_view bytes;
    const char* type;
  };
  static constexpr std::array<Signature, 5> kSignatures = {{{0, "\x89PNG", "image/png"},
                                                            {0, "\xff\xd8\xff", "image/jpeg"},
                                                            {8, "WEBP", "image/webp"},
                                                            {1, "KTX 20", "image/ktx2"},
                                                            {8, "avif", "image/avif"}}};
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto* known = std::find_if(kSignatures.begin(), kSignatures.end(), [&](const Signature& signature) {
    return text.size() > signature.at && text.substr(signature.at).starts_with(signature.bytes);
  });
  return known == kSignatures.end() ? "application/octet-stream" : known->type;
}

bool is_external(const Json& image) {
  return image.contains("uri") && !image.contains("bufferView") &&
         !image["uri"].get_ref<const std::string&>().starts_with("data:");
}

}  // namespace gltf_radiosity
