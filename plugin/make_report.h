// What each part of a bake says about itself -> the caller's report.
#pragma once

#include <vector>

#include "core/bake.h"
#include "plugin/export_scene.h"
#include "plugin/gltf_radiosity.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

void add_figures(const ImportedScene& scene, Report& report);
void add_figures(const radiosity::BakeReport& bake, Report& report);
void add_figures(const ExportReport& exported, Report& report);
void add_figures(const Options& options, Report& report);

/// What the user should know about the light.
void add_warnings(const radiosity::BakeReport& bake, std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
