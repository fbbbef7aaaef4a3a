#include "plugin/meshopt_decode.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plugin/accessor_view.h"
#include "plugin/append_accessor.h"
#include "plugin/check_document.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

/// Both extensions describe streams in the same way.
constexpr std::array kMeshoptExtensions = {kMeshoptExtension, "KHR_meshopt_compression"};

/// No stream holds more: an empty byte plane of 256 vertices takes 4 bytes, a triangle at least one.
constexpr std::uint64_t kMaxRatio = 64;
constexpr std::uint64_t kMaxStride = 256;

const char* extension_on(const Json& object) {
  for (const char* name : kMeshoptExtensions) {
    if (extension_of(object, name) != nullptr) return name;
  }
  return nullptr;
}

/// Where compressed bytes lie and what they decode to.
struct Stream {
  std::size_t view = 0;
  std::size_t buffer = 0, offset = 0, length = 0;
  std::size_t count = 0, stride = 0;
  std::string mode, filter;
};

/// Reads and checks the extension of each bufferView.
class StreamReader : private JsonChecker {
 public:
  using JsonChecker::JsonChecker;

  Result<std::vector<Stream>> run(const std::vector<Bytes>& buffers) {
    std::vector<Stream> streams;
    for (std::size_t i = 0; i < size("bufferViews") && !error_; ++i) {
      const Json& view = root_["bufferViews"][i];
      const std::string place = place_of("bufferViews", i);
      if (const char* extension = extension_on(view)) {
        streams.push_back(read(*extension_of(view, extension), i, place));
        check(streams.back(), view, buffers, place);
      } else if (is_placeholder(root_["buffers"][view["buffer"].get<std::size_t>()])) {
        fail(place, fmt::format("lies in buffers[{}], which has no data but of compressed bufferViews",
                                view["buffer"].get<std::size_t>()));
      }
    }
    check_total(streams, buffers);
    if (error_) return *error_;
    return streams;
  }

 private:
  Stream read(const Json& extension, std::size_t view, const std::string& place) {
    Stream stream;
    stream.view = view;
    stream.buffer = index(extension, "buffer", "buffers", place, true).value_or(0);
    stream.offset = number(extension, "byteOffset", 0, place);
    stream.length = number(extension, "byteLength", std::nullopt, place);
    stream.count = number(extension, "count", std::nullopt, place);
    stream.stride = number(extension, "byteStride", std::nullopt, place);
    string_if_present(extension, "mode", place);
    string_if_present(extension, "filter", place);
    if (!error_) stream.mode = extension.value("mode", "");
    if (!error_) stream.filter = extension.value("filter", "NONE");
    return stream;
  }

  void check(const Stream& stream, const Json& view, const std::vector<Bytes>& buffers, const std::string& place) {
    if (error_) return;
    if (stream.offset + stream.length > buffers[stream.buffer].size()) {
      return fail(place, fmt::format("its compressed bytes reach beyond buffers[{}]", stream.buffer));
    }
    if (!fits_mode(stream)) {
      return fail(place, fmt::format("no meshopt stream of mode \"{}\" has {} elements of {} bytes", stream.mode,
                                     stream.count, stream.stride));
    }
    if (!fits_filter(stream)) {
      return fail(place, fmt::format("meshopt filter \"{}\" is not supported for elements of {} bytes in mode {}",
                                     stream.filter, stream.stride, stream.mode));
    }
    const std::uint64_t bytes = stream.count * stream.stride;  // 2^40 * 2^8 at most
    if (number(view, "byteLength", 0, place) != bytes) {
      return fail(place,
                  fmt::format("its byteLength is not that of {} elements of {} bytes", stream.count, stream.stride));
    }
    if (bytes > kMaxRatio * stream.length) {
      fail(place, fmt::format("{} compressed bytes cannot hold {}", stream.length, bytes));
    }
  }

  /// Streams may overlap, but not to make much of little.
  void check_total(const std::vector<Stream>& streams, const std::vector<Bytes>& buffers) {
    std::uint64_t decoded = 0, stored = 0;
    for (const Stream& stream : streams) decoded += stream.count * stream.stride;
    for (const Bytes& buffer : buffers) stored += buffer.size();
    if (decoded > kMaxRatio * stored) {
      fail("bufferViews", fmt::format("{} bytes in all cannot hold {} compressed ones", stored, decoded));
    }
  }

  static bool fits_mode(const Stream& stream) {
    if (stream.mode == "ATTRIBUTES") {
      return stream.stride > 0 && stream.stride % 4 == 0 && stream.stride <= kMaxStride;
    }
    const bool indices = stream.stride == 2 || stream.stride == 4;
    return indices && (stream.mode == "INDICES" || (stream.mode == "TRIANGLES" && stream.count % 3 == 0));
  }

  static bool fits_filter(const Stream& stream) {
    if (stream.filter == "NONE") return true;
    if (stream.mode != "ATTRIBUTES") return false;
    if (stream.filter == "OCTAHEDRAL") return stream.stride == 4 || stream.stride == 8;
    if (stream.filter == "QUATERNION") return stream.stride == 8;
    return stream.filter == "EXPONENTIAL";
  }
};

/// The decoded bytes, [count * stride].
Result<Bytes> decode(const Stream& stream, const Bytes& buffer) {
  const std::string place = place_of("bufferViews", stream.view);
  Bytes bytes(stream.count * stream.stride);
  if (stream.count == 0) return bytes;
  const std::uint8_t* from = buffer.data() + stream.offset;
  const auto code = stream.mode == "ATTRIBUTES"
                        ? meshopt_decodeVertexBuffer(bytes.data(), stream.count, stream.stride, from, stream.length)
                    : stream.mode == "TRIANGLES"
                        ? meshopt_decodeIndexBuffer(bytes.data(), stream.count, stream.stride, from, stream.length)
                        : meshopt_decodeIndexSequence(bytes.data(), stream.count, stream.stride, from, stream.length);
  if (code != 0) {
    const bool newer = stream.mode == "ATTRIBUTES" && stream.length > 0 && *from == 0xa1;
    return bad_input(
        place, newer ? "version 1 of meshopt's vertex codec is not supported, 0 is" : "meshoptimizer cannot decode it");
  }
  if (stream.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), stream.count, stream.stride);
  if (stream.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), stream.count, stream.stride);
  if (stream.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), stream.count, stream.stride);
  return bytes;
}

/// Half open.
struct ByteRange {
  std::size_t begin = 0, end = 0;
};

/// Calls `visit(object)` for every bufferView, and every extension of one, that names `buffer`.
template <typename Visit>
void for_references(Json& root, std::size_t buffer, const Visit& visit) {
  const auto is_one = [buffer](const Json& object) {
    return object.is_object() && object.contains("buffer") && whole_number(object["buffer"]) == buffer;
  };
  if (!root.contains("bufferViews")) return;
  for (Json& view : root["bufferViews"]) {
    if (is_one(view)) visit(view);
    if (!view.contains("extensions")) continue;
    for (Json& extension : view["extensions"]) {
      if (is_one(extension)) visit(extension);
    }
  }
}

/// What is referred to in `buffer`.
std::vector<ByteRange> used_ranges(Json& root, std::size_t buffer) {
  std::vector<ByteRange> used;
  for_references(root, buffer, [&](const Json& object) {
    const std::size_t begin = object.value("byteOffset", std::size_t{0});
    used.push_back({begin, begin + object.value("byteLength", std::size_t{0})});
  });
  return used;
}

/// Takes compressed bytes that nothing refers to any more out of `buffer`, four by four, so that all others stay
/// aligned.
void cut_streams(Document& document, std::size_t buffer, std::vector<ByteRange> streams) {
  const std::vector<ByteRange> used = used_ranges(document.json, buffer);
  std::sort(streams.begin(), streams.end(), [](const ByteRange& a, const ByteRange& b) { return a.begin < b.begin; });
  Bytes& bytes = document.buffers[buffer];
  std::size_t from = 0, removed = 0, kept = 0;
  std::vector<std::pair<std::size_t, std::size_t>> shifts;  // from this offset on, so many bytes less
  for (const ByteRange& stream : streams) {
    const bool free = stream.begin >= from && std::none_of(used.begin(), used.end(), [&](const ByteRange& range) {
                        return range.begin < stream.end && stream.begin < range.end;
                      });
    const std::size_t length = (stream.end - stream.begin) / 4 * 4;
    if (!free || length == 0) continue;
    std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(from),
              bytes.begin() + static_cast<std::ptrdiff_t>(stream.begin),
              bytes.begin() + static_cast<std::ptrdiff_t>(kept));
    kept += stream.begin - from;
    from = stream.begin + length;
    removed += length;
    shifts.emplace_back(from, removed);
  }
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end(),
            bytes.begin() + static_cast<std::ptrdiff_t>(kept));
  bytes.resize(bytes.size() - removed);

  Json& length = document.json["buffers"][buffer]["byteLength"];
  length = std::min(bytes.size(), length.get<std::size_t>());
  for_references(document.json, buffer, [&](Json& object) {
    const std::size_t offset = object.value("byteOffset", std::size_t{0});
    const auto after = std::upper_bound(shifts.begin(), shifts.end(), std::pair(offset, bytes.max_size()));
    if (after != shifts.begin()) object["byteOffset"] = offset - std::prev(after)->second;
  });
}

/// Takes a buffer out of the document; the first one stays for its name and is emptied. REQUIRES: nothing refers to it.
void drop_buffer(Document& document, std::size_t buffer) {
  if (buffer == 0) {
    document.buffers[0].clear();
    document.json["buffers"][0]["byteLength"] = 0;
    return;
  }
  for (std::size_t above = buffer + 1; above < document.buffers.size(); ++above) {
    for_references(document.json, above, [above](Json& object) { object["buffer"] = above - 1; });
  }
  document.json["buffers"].erase(buffer);
  document.buffers.erase(document.buffers.begin() + static_cast<std::ptrdiff_t>(buffer));
}

/// The room that compressed data and its fallbacks took.
void drop_remains(Document& document, const std::vector<Stream>& streams) {
  for (std::size_t buffer = document.buffers.size(); buffer-- > 0;) {
    std::vector<ByteRange> compressed;
    for (const Stream& stream : streams) {
      if (stream.buffer == buffer) compressed.push_back({stream.offset, stream.offset + stream.length});
    }
    const bool spare = !compressed.empty() || extension_on(document.json["buffers"][buffer]) != nullptr;
    if (spare && used_ranges(document.json, buffer).empty()) {
      drop_buffer(document, buffer);
    } else if (spare) {
      cut_streams(document, buffer, std::move(compressed));
    }
  }
}

/// Whether two arrays hold the same numbers as floats.
bool same_floats(const Json& a, const Json& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const Json& x, const Json& y) {
           return x.is_number() && y.is_number() && x.get<float>() == y.get<float>();
         });
}

/// Bounds may be those of the values before a lossy filter. (Sparse values are not compressed with the rest.)
void correct_bounds(Document& document, const std::vector<Stream>& streams) {
  std::set<std::size_t> decoded;
  for (const Stream& stream : streams) decoded.insert(stream.view);
  for (std::size_t i = 0; i < array_of(document.json, "accessors").size(); ++i) {
    Json& accessor = document.json["accessors"][i];
    const bool bounded = accessor.contains("min") || accessor.contains("max");
    if (!bounded || !accessor.contains("bufferView") || accessor.contains("sparse") || accessor["count"] == 0) continue;
    if (!decoded.contains(accessor["bufferView"].get<std::size_t>())) continue;
    Json corrected = accessor;
    set_bounds(read_accessor(document, i), corrected);
    for (const char* key : {"min", "max"}) {
      if (accessor.contains(key) && !same_floats(accessor[key], corrected[key])) accessor[key] = corrected[key];
    }
  }
}

}  // namespace

bool is_placeholder(const Json& buffer) {
  return std::any_of(kMeshoptExtensions.begin(), kMeshoptExtensions.end(), [&buffer](const char* name) {
    const Json* extension = extension_of(buffer, name);
    return extension != nullptr && extension->value("fallback", Json()) == Json(true);
  });
}

Result<Done> decode_meshopt(Document& document) {
  // What there is.
  Json& root = document.json;
  const Result<std::vector<Stream>> streams = StreamReader(root).run(document.buffers);
  if (!streams) return streams.error();

  // Data.
  for (const Stream& stream : *streams) {
    auto fits =
        document.memory->reserve(stream.count, 2 * stream.stride, place_of("bufferViews", stream.view), "elements");
    if (!fits) return fits;
  }
  Bytes decoded;
  std::vector<std::size_t> offsets;
  for (const Stream& stream : *streams) {
    const Result<Bytes> bytes = decode(stream, document.buffers[stream.buffer]);
    if (!bytes) return bytes.error();
    offsets.push_back(decoded.size());
    decoded.insert(decoded.end(), bytes->begin(), bytes->end());
    decoded.resize((decoded.size() + 3) / 4 * 4);
  }

  // Tree.
  for (std::size_t i = 0; i < streams->size(); ++i) {
    Json& view = root["bufferViews"][(*streams)[i].view];
    view["buffer"] = document.buffers.size();
    view["byteOffset"] = offsets[i];
    for (const char* name : kMeshoptExtensions) remove_extension(view, name);
  }
  if (!streams->empty()) {
    root["buffers"].push_back({{"byteLength", decoded.size()}});
    document.buffers.push_back(std::move(decoded));
  }
  drop_remains(document, *streams);
  correct_bounds(document, *streams);
  for (const char* name : kMeshoptExtensions) {
    forget_extension(root, name);
    if (!root.contains("buffers")) continue;
    for (Json& buffer : root["buffers"]) remove_extension(buffer, name);
  }
  return Done{};
}

}  // namespace gltf_radiosity
