#include "plugin/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "plugin/base64.h"
#include "plugin/document.h"
#include "plugin/firewall.h"
#include "plugin/json_checker.h"
#include "plugin/merge_buffers.h"
#include "plugin/page/page_parts.h"
#include "plugin/pending_files.h"
#include "plugin/phases.h"
#include "plugin/write_gltf.h"

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

constexpr const char* kBasisu = "KHR_texture_basisu";

// --- The scene

bool is_baked(const Json& root) {
  const Json& meshes = array_of(root, "meshes");
  return std::ranges::any_of(meshes, [](const Json& mesh) {
    return std::ranges::any_of(array_of(mesh, "primitives"), [](const Json& primitive) {
      return primitive.contains("attributes") && primitive["attributes"].contains("COLOR_0");
    });
  });
}

Result<Done> check_that_it_can_be_shown(const Json& root) {
  if (!is_baked(root)) return bad_input("", "nothing in it is baked: no mesh has a COLOR_0");
  if (std::ranges::count(array_of(root, "extensionsRequired"), Json(kBasisu)) > 0) {
    return bad_input("extensionsRequired", fmt::format("{} cannot be decoded by the page", kBasisu));
  }
  return Done{};
}

Error too_large(std::uint64_t bytes) {
  return {ErrorCode::kLimit, "",
          fmt::format("the scene has {} bytes, and browsers open no pages of more than {}", bytes, kMaxViewedBytes)};
}

/// Whether the bytes of a .glb hold all there is.
bool is_self_contained_glb(std::span<const std::uint8_t> bytes, const Json& root) {
  const std::string_view magic(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 4));
  return magic == "glTF" && std::ranges::none_of(array_of(root, "images"), is_external) &&
         std::ranges::none_of(array_of(root, "buffers"), is_external);
}

/// Whether the first chunk of a GLB, its JSON, names Draco. REQUIRES: it was read before.
bool names_draco(std::span<const std::uint8_t> glb) {
  constexpr std::size_t kHeader = 20;
  const std::string_view text(reinterpret_cast<const char*>(glb.data()), glb.size());
  const std::size_t bin = text.find("BIN\0"sv, kHeader);
  return text.substr(0, bin).find("KHR_draco_mesh_compression") != std::string_view::npos;
}

/// The baked file as one GLB: its own bytes where they are one, so that the page shows what engines get.
struct ViewedScene {
  Bytes glb;
  bool needs_draco = false;
  std::vector<Warning> warnings;
};

Result<ViewedScene> read_scene(const fs::path& baked) {
  Result<Bytes> bytes = read_file(baked, "");
  if (!bytes) return bytes.error();
  Result<Document> document = read_document(*bytes, folder_of(baked));
  if (!document) return document.error();
  if (const auto checked = check_that_it_can_be_shown(document->json); !checked) return checked.error();
  ViewedScene scene;
  scene.warnings = document->warnings;
  if (is_self_contained_glb(*bytes, document->json)) {
    scene.glb = std::move(*bytes);
    scene.needs_draco = names_draco(scene.glb);
    return scene;
  }
  Result<Bytes> glb = to_glb(std::move(*document), {});
  if (!glb) return glb.error();
  scene.glb = std::move(*glb);
  return scene;
}

// --- The page

using Writer = std::function<void(std::string& page)>;

/// `html` with its @NAMES@ filled in. What goes in is not looked through for names.
std::string filled_in(std::string_view html, const std::map<std::string_view, Writer>& writers, std::size_t size) {
  std::string page;
  page.reserve(size);
  while (!html.empty()) {
    const std::size_t start = std::min(html.find('@'), html.size());
    page += html.substr(0, start);
    html.remove_prefix(start);
    const std::size_t end = html.find('@', 1);
    const auto writer = end == std::string_view::npos ? writers.end() : writers.find(html.substr(1, end - 1));
    if (writer == writers.end()) {
      page += html.substr(0, 1);
      html.remove_prefix(std::min<std::size_t>(html.size(), 1));
    } else {
      writer->second(page);
      html.remove_prefix(end + 1);
    }
  }
  return page;
}

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

/// A part for unpack.js, in pieces: no text in a browser may be longer than half a gigabyte.
void append_part(std::string& page, std::string_view name, std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kPiece = std::size_t{12} << 20U;  // a multiple of 3
  static_assert(kPiece % 3 == 0);
  while (!bytes.empty()) {
    const auto piece = bytes.first(std::min(bytes.size(), kPiece));
    page += fmt::format(R"(<script type="application/octet-stream" data-part="{}">)", name);
    page += encode_base64(piece);
    page += "</script>\n";
    bytes = bytes.subspan(piece.size());
  }
}

std::string page_of(const PageParts& parts, const ViewedScene& scene, const std::string& title) {
  const auto text = [](std::string_view value) { return [value](std::string& page) { page += value; }; };
  const std::string escaped_title = escaped(title);
  const std::string notices = escaped(parts.notices) + escaped(parts.three_licence);
  const std::size_t size = parts.html.size() + parts.style.size() + parts.script.size() + notices.size() +
                           scene.glb.size() / 3 * 4 + parts.draco_js.size() * 4 + parts.draco_wasm.size() * 4 + 4096;
  return filled_in(parts.html,
                   {{"VERSION", text(version())},
                    {"TITLE", text(escaped_title)},
                    {"STYLE", text(parts.style)},
                    {"NOTICES", text(notices)},
                    {"MODEL", [&](std::string& page) { append_part(page, "model", scene.glb); }},
                    {"DECODERS",
                     [&](std::string& page) {
                       if (!scene.needs_draco) return;
                       append_part(page, "draco_js", parts.draco_js);
                       append_part(page, "draco_wasm", parts.draco_wasm);
                     }},
                    {"SCRIPT", text(parts.script)}},
                   size);
}

Result<ViewReport> write_page(const std::string& baked, const std::string& html, const ViewOptions& options,
                              const radiosity::Progress& progress) {
  // What can be said beforehand.
  std::error_code error;
  const std::optional<PageParts> parts = page_parts();
  if (!parts) return Error{ErrorCode::kBadOption, "", "this program was built without the page (GLTF_RADIOSITY_VIEW)"};
  if (fs::equivalent(baked, html, error))
    return Error{ErrorCode::kBadOption, html, "the page is the baked file itself"};
  const std::uintmax_t baked_size = fs::file_size(baked, error);
  if (!error && baked_size > kMaxViewedBytes) return too_large(baked_size);

  // Read.
  progress.update("read", 0.0);
  Result<ViewedScene> scene = read_scene(baked);
  if (!scene) return scene.error();
  if (scene->glb.size() > kMaxViewedBytes) return too_large(scene->glb.size());

  // Write.
  progress.update("write", 0.0);
  const std::string title = options.title.empty() ? fs::path(baked).filename().string() : options.title;
  const std::string page = page_of(*parts, *scene, title);
  PendingFiles files(html);
  if (const auto written = files.add(html, page); !written) return written.error();
  if (const auto written = files.commit(); !written) return written.error();
  return ViewReport{scene->glb.size(), page.size(), std::move(scene->warnings)};
}

}  // namespace

Result<ViewReport> view_file(const std::string& baked, const std::string& html, const ViewOptions& options,
                             const Callbacks& callbacks) {
  return behind_firewall([&]() -> Result<ViewReport> {
    Phases phases(callbacks);
    Result<ViewReport> report = write_page(baked, html, options, phases.progress());
    if (!report && report.error().place != baked && report.error().code == ErrorCode::kBadInput) {
      Error error = report.error();
      error.place = error.place.empty() ? baked : baked + ": " + error.place;
      return error;
    }
    return report;
  });
}

}  // namespace gltf_radiosity
