#include "tests/fuzz/gltf_parts.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace gltf_radiosity::fuzz {
namespace {

constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;
constexpr int kMaxDepth = 60;

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// The chunk that starts at `at`, cut short where the bytes end; empty beyond them.
std::span<const std::uint8_t> chunk_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  if (at + kChunkHeaderSize > bytes.size()) return {};
  const std::size_t left = bytes.size() - at - kChunkHeaderSize;
  return bytes.subspan(at + kChunkHeaderSize, std::min<std::size_t>(number_at(bytes, at), left));
}

void append_number(Bytes& bytes, std::size_t number) {
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

void append_chunk(Bytes& bytes, const char (&type)[5], std::span<const std::uint8_t> data) {
  append_number(bytes, data.size());
  bytes.insert(bytes.end(), type, type + 4);
  bytes.insert(bytes.end(), data.begin(), data.end());
}

}  // namespace

std::optional<GltfParts> take_apart(std::span<const std::uint8_t> bytes) {
  GltfParts parts;
  std::span<const std::uint8_t> text = bytes;
  if (bytes.size() > kHeaderSize && std::memcmp(bytes.data(), "glTF", 4) == 0) {
    parts.is_glb = true;
    text = chunk_at(bytes, kHeaderSize);
    const auto binary = chunk_at(bytes, kHeaderSize + kChunkHeaderSize + text.size());
    parts.binary.assign(binary.begin(), binary.end());
  }
  const auto not_too_deep = [](int depth, Json::parse_event_t, const Json&) { return depth < kMaxDepth; };
  parts.json = Json::parse(text.begin(), text.end(), not_too_deep, false);
  if (!parts.json.is_object()) return std::nullopt;
  return parts;
}

Bytes put_together(GltfParts parts) {
  // Text.
  parts.binary.resize((parts.binary.size() + 3) / 4 * 4);
  const auto buffers = parts.json.find("buffers");
  if (parts.is_glb && buffers != parts.json.end() && buffers->is_array() && !buffers->empty()) {
    Json& first = buffers->front();
    if (first.is_object() && !first.contains("uri")) first["byteLength"] = parts.binary.size();
  }
  std::string text = parts.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!parts.is_glb) return {text.begin(), text.end()};

  // Container.
  text.resize((text.size() + 3) / 4 * 4, ' ');
  Bytes bytes{'g', 'l', 'T', 'F'};
  append_number(bytes, 2);
  const std::size_t chunks = parts.binary.empty() ? 1 : 2;
  append_number(bytes, kHeaderSize + chunks * kChunkHeaderSize + text.size() + parts.binary.size());
  append_chunk(bytes, "JSON", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (!parts.binary.empty()) append_chunk(bytes, "BIN\0", parts.binary);
  return bytes;
}

}  // namespace gltf_radiosity::fuzz
