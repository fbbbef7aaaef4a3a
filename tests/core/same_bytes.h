// Whether two bakes are the same to the last bit.
#pragma once

#include <cstring>
#include <vector>

#include "core/scene.h"

namespace radiosity::test {

inline bool same_bytes(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb)) == 0;
}

}  // namespace radiosity::test
