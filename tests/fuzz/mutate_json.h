// One change to a glTF's tree that keeps it a tree: numbers, words, members and whole branches.
#pragma once

#include <cstddef>
#include <random>

#include "tests/fuzz/gltf_parts.h"

namespace gltf_radiosity::fuzz {

using Random = std::minstd_rand;

/// One of [0, count). REQUIRES: count > 0.
inline std::size_t choose(Random& random, std::size_t count) { return random() % count; }

/// Changes one value somewhere in `root`, which stays an object.
void mutate_json(Json& root, Random& random);

/// Puts a branch of `other` in the place of one of `root`.
void graft(Json& root, Json& other, Random& random);

}  // namespace gltf_radiosity::fuzz
