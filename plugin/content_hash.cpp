#include "plugin/content_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

namespace gltf_radiosity {

void ContentHash::Release::operator()(XXH3_state_s* state) const { ::XXH3_freeState(state); }

ContentHash::ContentHash() : state_(::XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  ::XXH3_128bits_reset(state_.get());
}

void ContentHash::add_bytes(const void* bytes, std::size_t size) {
  if (size > 0) ::XXH3_128bits_update(state_.get(), bytes, size);
}

std::string ContentHash::digits() const {
  const XXH128_hash_t hash = ::XXH3_128bits_digest(state_.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace gltf_radiosity
