#include "plugin/write_gltf.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cstring>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "plugin/base64.h"
#include "plugin/content_name.h"
#include "plugin/merge_buffers.h"
#include "plugin/old_bins.h"
#include "plugin/pending_files.h"

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr std::string_view kEmbeddedEnding = ".embedded.gltf";

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string text_of(const Json& root, int indent) {
  return root.dump(indent, ' ', false, Json::error_handler_t::replace);
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

// --- GLB

constexpr std::uint64_t padded(std::uint64_t size) { return (size + 3) / 4 * 4; }

void append_u32(Bytes& bytes, std::uint64_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(Bytes& bytes, std::uint32_t type, std::span<const std::uint8_t> data, std::uint8_t padding) {
  append_u32(bytes, padded(data.size()));
  append_u32(bytes, type);
  bytes.insert(bytes.end(), data.begin(), data.end());
  bytes.insert(bytes.end(), padded(data.size()) - data.size(), padding);
}

// --- URIs

std::string data_uri(const char* type, std::span<const std::uint8_t> bytes) {
  return fmt::format("data:{};base64,{}", type, encode_base64(bytes));
}

/// A relative path as a URI.
std::string uri_of(const fs::path& path) {
  std::string uri;
  for (const char c : path.generic_string()) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-._~/", c) != nullptr;
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

// --- .gltf

void embed_images_as_uris(Json& root, std::size_t image, const Bytes& bytes) {
  Json& json = root["images"][image];
  const std::string type = json.value("mimeType", std::string(image_type(bytes)));
  json["uri"] = data_uri(type.c_str(), bytes);
}

/// Whether a file may be put at `target`: 1 yes, 0 it is there already, -1 there is another.
int room_for(const fs::path& target, const Bytes& bytes) {
  std::error_code error;
  if (!fs::exists(target, error)) return 1;
  const Result<Bytes> there = read_file(target, "");
  return there && *there == bytes ? 0 : -1;
}

/// Copies an image that lies elsewhere to the same relative path below the output's folder. `carried` are those that
/// went before.
Result<Done> carry_image(Document& document, std::size_t image, const fs::path& folder, std::set<fs::path>& carried,
                         PendingFiles& files) {
  // What it is.
  Json& json = document.json["images"][image];
  const Result<fs::path> file = resolve_uri(json["uri"].get<std::string>(), document.folder, place_of("images", image));
  if (!file) return file.error();
  const Result<Bytes> bytes = image_bytes(document, image);
  if (!bytes) return bytes.error();

  // Where it goes.
  std::error_code error;
  fs::path name = file->lexically_relative(fs::weakly_canonical(document.folder.path, error));
  const bool from_outside = name.empty() || *name.begin() == "..";
  if (from_outside) name = name_by_content(file->filename(), *bytes);
  int room = room_for(folder / name, *bytes);
  if (room < 0) {
    name = name_by_content(name, *bytes);
    room = room_for(folder / name, *bytes);
  }
  if (room < 0) return Error{ErrorCode::kCannotWrite, (folder / name).string(), "is another file"};
  json["uri"] = uri_of(name);
  if (!carried.insert(name).second) return Done{};
  return room == 0 ? Result<Done>(Done{}) : files.add(folder / name, *bytes, Replace::kNo);
}

/// Takes care of the images that lie in files of their own.
Result<Done> carry_images(Document& document, FileKind kind, const fs::path& folder, PendingFiles& files) {
  if (!document.json.contains("images")) return Done{};
  const bool stay = kind == FileKind::kGltf && is_same_file(document.folder.path, folder);
  std::set<fs::path> carried;
  for (std::size_t i = 0; i < document.json["images"].size(); ++i) {
    if (stay || !is_external(document.json["images"][i])) continue;
    if (kind == FileKind::kGltf) {
      if (auto done = carry_image(document, i, folder, carried, files); !done) return done;
      continue;
    }
    const Result<Bytes> bytes = image_bytes(document, i);
    if (!bytes) return bytes.error();
    embed_images_as_uris(document.json, i, *bytes);
  }
  return Done{};
}

/// The .bin beside the output.
fs::path bin_file(const fs::path& output, const Bytes& bytes) {
  fs::path bin = output;
  return name_by_content(bin.replace_extension(".bin"), bytes);
}

Result<Done> write_json(Document& document, const BufferBuilder& added, FileKind kind, const fs::path& output,
                        PendingFiles& files) {
  if (auto carried = carry_images(document, kind, folder_of(output), files); !carried) return carried;
  Json& root = document.json;
  {
    const Bytes merged = merge_buffers(document, added);
    if (!merged.empty() && kind == FileKind::kEmbedded) {
      root["buffers"][0]["uri"] = data_uri("application/octet-stream", merged);
    } else if (!merged.empty()) {
      const fs::path bin = bin_file(output, merged);
      root["buffers"][0]["uri"] = uri_of(bin.filename());
      if (auto written = files.add(bin, merged); !written) return written;
    }
  }
  return files.add(output, text_of(root, 2) + "\n");
}

}  // namespace

std::optional<FileKind> file_kind(const std::filesystem::path& output) {
  const std::string name = lower_case(output.filename().string());
  if (name.ends_with(kEmbeddedEnding)) return FileKind::kEmbedded;
  if (name.ends_with(".gltf")) return FileKind::kGltf;
  if (name.ends_with(".glb")) return FileKind::kGlb;
  return std::nullopt;
}

Result<Bytes> to_glb(Document document, const BufferBuilder& added, std::uint64_t max_bytes) {
  // Everything into one buffer.
  Bytes bin = merge_buffers(document, added);
  if (auto embedded = embed_images(document, bin); !embedded) return embedded.error();
  const std::string text = text_of(document.json, -1);

  // Header and chunks.
  const std::uint64_t size = 20 + padded(text.size()) + (bin.empty() ? 0 : 8 + padded(bin.size()));
  if (size > max_bytes) {
    return Error{ErrorCode::kCannotWrite, "",
                 fmt::format("the GLB would have {} bytes, more than its format can hold: write a .gltf", size)};
  }
  Bytes glb;
  glb.reserve(size);
  append_u32(glb, kGlbMagic);
  append_u32(glb, 2);
  append_u32(glb, size);
  append_chunk(glb, kJsonChunk, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, ' ');
  if (!bin.empty()) append_chunk(glb, kBinChunk, bin, 0);
  return glb;
}

Result<Done> check_output(const std::filesystem::path& output) {
  const auto refuse = [&](ErrorCode code, const char* why) { return Error{code, output.string(), why}; };
  std::error_code error;
  const fs::path folder = folder_of(output);
  if (!file_kind(output)) return refuse(ErrorCode::kBadOption, "the output's name must end in .glb or .gltf");
  if (!fs::is_directory(folder, error)) return refuse(ErrorCode::kCannotWrite, "the output's folder does not exist");
  if (fs::exists(output, error) && !fs::is_regular_file(output, error)) {
    return refuse(ErrorCode::kCannotWrite, "exists and is not a file");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    return refuse(ErrorCode::kCannotWrite, "the output's folder cannot be written to");
  }
  return Done{};
}

Result<Done> add_gltf(Document document, const BufferBuilder& added, const std::filesystem::path& output,
                      PendingFiles& files) {
  const std::optional<FileKind> kind = file_kind(output);
  if (!kind) return Error{ErrorCode::kBadOption, output.string(), "the output's name must end in .glb or .gltf"};
  if (kind != FileKind::kGlb) return write_json(document, added, *kind, output, files);
  const Result<Bytes> glb = to_glb(std::move(document), added);
  if (!glb) return glb.error();
  return files.add(output, *glb);
}

Result<Done> commit_gltfs(PendingFiles& files, std::span<const std::filesystem::path> outputs) {
  {
    const FolderLock lock(folder_of(outputs.front()), FolderLock::Kind::kShared);
    if (auto committed = files.commit(); !committed) return committed;
  }
  for (const fs::path& output : outputs) {
    if (file_kind(output) == FileKind::kGltf) remove_old_bins(output);
  }
  return Done{};
}

Result<Done> write_gltf(Document document, const BufferBuilder& added, const std::filesystem::path& output) {
  PendingFiles files(output);
  if (auto written = add_gltf(std::move(document), added, output, files); !written) return written;
  return commit_gltfs(files, {&output, 1});
}

}  // namespace gltf_radiosity
