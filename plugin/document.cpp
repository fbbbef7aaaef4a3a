#include "plugin/document.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <optional>
#include <system_error>

#include "plugin/accessor_view.h"
#include "plugin/check_document.h"
#include "plugin/draco_codec.h"
#include "plugin/meshopt_decode.h"

namespace gltf_radiosity {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr int kMaxDepth = 64;

using ByteSpan = std::span<const std::uint8_t>;

std::uint32_t read_u32(ByteSpan bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// The text of a glTF and, from a GLB, its binary chunk.
struct Container {
  ByteSpan json;
  std::optional<ByteSpan> bin;
};

bool is_glb(ByteSpan bytes) { return bytes.size() >= 4 && read_u32(bytes, 0) == kGlbMagic; }

Result<Container> open_glb(ByteSpan bytes) {
  // Header.
  if (bytes.size() < 20) return bad_input("GLB header", "the file is truncated");
  if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
    return bad_input("GLB header", fmt::format("version {} is not supported, 2 is", version));
  }
  const std::uint32_t length = read_u32(bytes, 8);
  if (length > bytes.size()) {
    return bad_input("GLB header",
                     fmt::format("the file is truncated: it says {} bytes and has {}", length, bytes.size()));
  }
  if (length < 20) return bad_input("GLB header", "the length leaves no room for a chunk");
  bytes = bytes.first(length);

  // Chunks: JSON first, then at most one BIN; unknown ones are ignored.
  Container container;
  std::uint64_t at = 12;
  for (int chunk = 0; at + 8 <= bytes.size(); ++chunk) {
    const std::uint32_t size = read_u32(bytes, at);
    const std::uint32_t type = read_u32(bytes, at + 4);
    if (at + 8 + size > bytes.size())
      return bad_input(fmt::format("GLB chunk {}", chunk), "reaches beyond the end of the file");
    const ByteSpan data = bytes.subspan(at + 8, size);
    if (chunk == 0 && type != kJsonChunk) return bad_input("GLB chunk 0", "is not JSON");
    if (chunk == 0) container.json = data;
    if (type == kBinChunk && !container.bin) container.bin = data;
    at += 8 + std::uint64_t{size};
  }
  return container;
}

/// What a text holds, as far as it shows without parsing it. (nlohmann's parser callback knows the depth too, but it
/// looks at all siblings after each object: 10,000 nodes took a second.)
struct JsonShape {
  bool is_too_deep = false;       ///< brackets are nested deeper than kMaxDepth
  std::uint64_t value_count = 1;  ///< at most
};

JsonShape shape_of(ByteSpan text) {
  JsonShape shape;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size() && !shape.is_too_deep; ++i) {
    const std::uint8_t character = text[i];
    if (in_string) {
      if (character == '\\') ++i;
      in_string = character != '"';
    } else if (character == '"') {
      in_string = true;
    } else if (character == '[' || character == '{') {
      shape.is_too_deep = ++depth > kMaxDepth;
      ++shape.value_count;
    } else if (character == ']' || character == '}') {
      --depth;
    } else if (character == ',' || character == ':') {
      ++shape.value_count;
    }
  }
  return shape;
}

/// What a value costs at most: in the tree, in the copy for tinygltf and in what that makes of it.
constexpr std::uint64_t kBytesPerJsonValue = 256;

Result<Json> parse_json(ByteSpan text, MemoryBudget& memory) {
  // Some writers pad the JSON chunk with zeros, which is not JSON.
  while (!text.empty() && text.back() == 0) text = text.first(text.size() - 1);
  const JsonShape shape = shape_of(text);
  if (shape.is_too_deep) return bad_input("JSON", fmt::format("is nested deeper than {} levels", kMaxDepth));
  if (auto fits = memory.reserve(shape.value_count, kBytesPerJsonValue, "JSON", "values"); !fits) return fits.error();
  if (auto fits = memory.reserve(text.size(), 2, "JSON", "characters"); !fits) return fits.error();
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& error) {
    return bad_input("JSON", fmt::format("is broken at byte {}", error.byte));
  } catch (const nlohmann::json::exception&) {
    return bad_input("JSON", "holds a number that is out of range");
  }
}

Result<Done> load_buffers(Document& document, std::optional<ByteSpan> bin) {
  const Json& buffers = array_of(document.json, "buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string place = place_of("buffers", i);
    const std::uint64_t length = *whole_number(buffers[i]["byteLength"]);
    Bytes bytes;
    if (is_placeholder(buffers[i])) {
      document.buffers.emplace_back();
      continue;
    }
    if (buffers[i].contains("uri")) {
      document.folder.max_bytes = document.memory->left();
      Result<Bytes> read = read_uri(buffers[i]["uri"].get<std::string>(), document.folder, place);
      if (!read) return read.error();
      bytes = std::move(*read);
    } else if (i == 0 && bin) {
      if (auto fits = document.memory->check(bin->size(), 1, place, "bytes"); !fits) return fits;
      bytes.assign(bin->begin(), bin->end());
    } else if (length > 0) {
      return bad_input(place, "has neither a uri nor a binary chunk");
    }
    if (bytes.size() < length) return bad_input(place, fmt::format("says {} bytes but has {}", length, bytes.size()));
    if (auto fits = document.memory->reserve(bytes.size(), 1, place, "bytes"); !fits) return fits;
    document.buffers.push_back(std::move(bytes));
  }
  return Done{};
}

/// Accessors without data take nothing in the file. Each must fit; what a scene makes of them is counted as it is read.
Result<Done> check_empty_accessors(const Document& document) {
  const Json& accessors = array_of(document.json, "accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    if (accessors[i].contains("bufferView")) continue;
    const auto layout =
        element_layout(accessors[i]["type"].get<std::string>(), accessors[i]["componentType"].get<std::uint64_t>());
    const auto count = accessors[i]["count"].get<std::uint64_t>();
    if (auto fits = document.memory->check(count, 2 * layout->size, place_of("accessors", i), "elements"); !fits) {
      return fits;
    }
  }
  return Done{};
}

Result<Done> check_image_files(const Document& document) {
  const Json& images = array_of(document.json, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (!images[i].contains("uri") || images[i].contains("bufferView")) continue;
    const auto uri = images[i]["uri"].get<std::string>();
    if (uri.starts_with("data:")) continue;
    if (auto file = resolve_uri(uri, document.folder, place_of("images", i)); !file) return file.error();
  }
  return Done{};
}

/// The files that the tree names, as far as they are there.
std::vector<std::filesystem::path> named_files(const Document& document) {
  std::vector<std::filesystem::path> files;
  for (const char* array : {"buffers", "images"}) {
    for (const Json& owner : array_of(document.json, array)) {
      if (!owner.contains("uri")) continue;
      if (const auto file = resolve_uri(owner["uri"].get<std::string>(), document.folder, "")) files.push_back(*file);
    }
  }
  return files;
}

Result<Document> make_document(ByteSpan bytes, const InputFolder& folder, const ReadOptions& options) {
  // Container.
  Container container{bytes, std::nullopt};
  if (is_glb(bytes)) {
    Result<Container> opened = open_glb(bytes);
    if (!opened) return opened.error();
    container = *opened;
  }

  // Tree.
  Document document;
  document.memory = std::make_shared<MemoryBudget>(options.max_memory);
  if (auto fits = document.memory->reserve(bytes.size(), 1, "", "bytes of the file"); !fits) return fits.error();
  Result<Json> json = parse_json(container.json, *document.memory);
  if (!json) return json.error();
  document.json = std::move(*json);
  document.folder = folder;
  if (auto checked = check_structure(document.json); !checked) return checked.error();

  if (auto spared = check_that_inputs_are_spared(named_files(document), options.spared_by); !spared) {
    return spared.error();
  }

  // Data.
  if (auto loaded = load_buffers(document, container.bin); !loaded) return loaded.error();
  if (auto fits = check_empty_accessors(document); !fits) return fits.error();
  if (auto decoded = decode_meshopt(document); !decoded) return decoded.error();
  if (auto checked = check_sparse_indices(document); !checked) return checked.error();
  if (auto checked = check_image_files(document); !checked) return checked.error();
  if (auto decoded = decode_draco(document); !decoded) return decoded.error();
  return document;
}

}  // namespace

Result<Document> read_document(const std::filesystem::path& file, const ReadOptions& options) {
  if (auto spared = check_that_inputs_are_spared(std::array{file}, options.spared_by); !spared) return spared.error();
  const Result<Bytes> bytes = read_file(file, "", options.max_memory);
  if (!bytes) return bytes.error();
  std::error_code error;
  const InputFolder folder(std::filesystem::absolute(file, error).parent_path(), options.allow_outside);
  return make_document(*bytes, folder, options);
}

Result<Document> read_document(std::span<const std::uint8_t> bytes, const InputFolder& folder,
                               const ReadOptions& options) {
  return make_document(bytes, folder, options);
}

std::string place_of(std::string_view array, std::size_t index) { return fmt::format("{}[{}]", array, index); }

std::string place_of_primitive(std::size_t mesh, std::size_t primitive) {
  return fmt::format("meshes[{}].primitives[{}]", mesh, primitive);
}

}  // namespace gltf_radiosity
