// A bound on the memory of the whole process that the system enforces.
#pragma once

#include <cstdint>

namespace gltf_radiosity::tools {

/// From here on whoever asks for more than `bytes` of memory in all gets std::bad_alloc: the bake estimates what it
/// needs, and this is for where it is wrong. What `threads` threads and libraries reserve without using it comes on
/// top, so the bound on what is used is looser by 192 MiB and 16 MiB a thread. Does nothing where a lower limit holds
/// already, or where the system cannot.
void limit_memory(std::uint64_t bytes, int threads);

}  // namespace gltf_radiosity::tools
