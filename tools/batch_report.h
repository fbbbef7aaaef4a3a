// What a batch did: lines and a table for people, a report for programs, one exit code.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/batch_plan.h"

namespace gltf_radiosity::tools {

/// How one file fared.
struct BatchResult {
  std::optional<int> exit_code;  ///< 128 and the signal's number if it crashed; none if it was not started
  double seconds = 0.0;
  std::uint64_t peak_memory_bytes = 0;
  std::string outcome;  ///< one line: what was made of it, or the error
  std::string report;   ///< JSON; empty if there is none
};

struct BatchSummary {
  std::span<const BatchFile> files;
  std::span<const BatchResult> results;  ///< [files.size()]
  int exit_code = 0;                     ///< of the whole
  int jobs = 1;
  double seconds = 0.0;
};

/// The exit code of a batch: 0 if all is done; the signal's if it was `interrupted`; else the worst of its files: 70
/// for a bug or a crash, then 3, 4, 1 and 2.
int batch_exit_code(std::span<const BatchResult> results, int interrupted_by);

/// gltf-radiosity: [3/20] house/a.glb: 12345 triangles, 6789 vertices, 2 warnings, 3.21 s
std::string batch_line(const BatchFile& file, const BatchResult& result, std::size_t ended, std::size_t all);

/// A row for each file, and a line with the totals.
std::string batch_table(const BatchSummary& summary);

/// As docs/report.schema.json has it, indented by two spaces.
std::string to_json(const BatchSummary& summary);

}  // namespace gltf_radiosity::tools
