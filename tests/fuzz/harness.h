// What libFuzzer calls, and what it offers: see https://llvm.org/docs/LibFuzzer.html.
#pragma once

#include <cstddef>
#include <cstdint>

/// One input; 0 keeps it, -1 leaves it out of the corpus. A finding is a crash, a report of a sanitizer, or a limit of
/// time or memory that is passed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Changes `data` in place and answers its new size.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
