// What the shell learns about a bake or its verification. Scripts depend on these numbers: docs/command-line.md
// promises them.
#pragma once

#include <csignal>

#include "plugin/result.h"

namespace gltf_radiosity::tools {

inline constexpr int kExitDone = 0;
inline constexpr int kExitBadInput = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitCannotWrite = 3;
inline constexpr int kExitLimit = 4;
inline constexpr int kExitTooInexact = 5;  ///< verified, but worse than --max-error
inline constexpr int kExitInternal = 70;   ///< EX_SOFTWARE of sysexits.h

/// `signal` is the one that interrupted the bake, or 0: shells expect 128 plus its number.
constexpr int exit_code_of(ErrorCode code, int signal) {
  switch (code) {
    case ErrorCode::kBadInput:
      return kExitBadInput;
    case ErrorCode::kBadOption:
      return kExitUsage;
    case ErrorCode::kCannotWrite:
      return kExitCannotWrite;
    case ErrorCode::kLimit:
      return kExitLimit;
    case ErrorCode::kCancelled:
      return 128 + (signal == 0 ? SIGINT : signal);
    case ErrorCode::kInternal:
      return kExitInternal;
  }
  return kExitInternal;
}

}  // namespace gltf_radiosity::tools
