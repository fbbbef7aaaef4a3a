#include "plugin/memory_budget.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// "1.5 GiB"
std::string readable(double bytes) {
  constexpr const char* kUnits[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  std::size_t unit = 0;
  for (; bytes >= 1024.0 && unit + 1 < std::size(kUnits); ++unit) bytes /= 1024.0;
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

/// The number in a file; unlimited if there is none, as where it says "max".
std::uint64_t number_in(const fs::path& file) {
  std::ifstream stream(file);
  std::uint64_t number = 0;
  return stream >> number ? number : kUnlimited;
}

/// The lowest limit of a control group and of those that it lies in.
std::uint64_t lowest_limit(const fs::path& mount, fs::path group, const char* file) {
  std::uint64_t lowest = number_in(mount / file);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path()) {
    lowest = std::min(lowest, number_in(mount / group / file));
  }
  return lowest;
}

/// Of the control groups of this process, versions 1 and 2. A container may see its own as the root.
std::uint64_t control_group_limit(const fs::path& system) {
  std::uint64_t limit = kUnlimited;
  std::ifstream groups(system / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // 4:memory:/path, or 0::/path
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    if (controllers.empty()) limit = std::min(limit, lowest_limit(system / "sys/fs/cgroup", path, "memory.max"));
    if (controllers == "memory") {
      limit = std::min(limit, lowest_limit(system / "sys/fs/cgroup/memory", path, "memory.limit_in_bytes"));
    }
  }
  return limit;
}

std::uint64_t physical_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page_bytes = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page_bytes <= 0) return kUnlimited;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes);
}

}  // namespace

Result<Done> MemoryBudget::check(std::uint64_t count, std::uint64_t bytes_each, const std::string& place,
                                 std::string_view things) const {
  if (bytes_each == 0 || count <= left() / bytes_each) return Done{};
  return Error{ErrorCode::kLimit, place,
               fmt::format("{} {} need about {}, and of --max-memory, {}, {} are left", count, things,
                           readable(static_cast<double>(count) * static_cast<double>(bytes_each)),
                           readable(static_cast<double>(limit_)), readable(static_cast<double>(left())))};
}

Result<Done> MemoryBudget::reserve(std::uint64_t count, std::uint64_t bytes_each, const std::string& place,
                                   std::string_view things) {
  auto fits = check(count, bytes_each, place, things);
  if (fits) reserved_ += count * bytes_each;
  return fits;
}

std::uint64_t allowed_memory(const fs::path& system) {
  const std::uint64_t memory = std::min(physical_memory(), control_group_limit(system));
  return memory == kUnlimited ? std::uint64_t{2} << 30U : memory / 4 * 3;
}

}  // namespace gltf_radiosity
