// Which call into the system or into malloc is to fail, and how. Set by fault_loop.cpp, carried out by faults.cpp.
#pragma once

#include <atomic>
#include <cstdint>

namespace faults {

enum class Kind {
  kNone,
  kAllocation,      ///< the Nth allocation finds no memory
  kAllAllocations,  ///< nor does any after it
  kWrite,           ///< the disk is full from the Nth write on, after half of it was written
  kFlush,           ///< the Nth fsync fails
  kOpen,            ///< the Nth open for writing is not permitted
  kRename,          ///< the Nth rename is not permitted
  kRead,            ///< every read is short, every other one interrupted
  kKill,            ///< the process is killed at the Nth open, write, fsync or rename of a file
};

/// From here on the `nth` call, counted from 1 in `counter`, fails.
void arm(Kind kind, std::uint64_t nth, std::atomic<std::uint64_t>& counter);

}  // namespace faults
