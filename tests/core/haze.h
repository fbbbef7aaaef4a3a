// Surfaces that let a share of the light through, the same everywhere.
#pragma once

#include "core/scene.h"

namespace radiosity::test {

/// 30 % opaque.
class Haze : public SurfaceDetail {
 public:
  Rgb reflectance(std::uint32_t, const SubTriangle&) const override { return Rgb(0.5F); }
  Rgb emission(std::uint32_t, const SubTriangle&) const override { return Rgb(0.0F); }
  float opacity(std::uint32_t, Barycentrics) const override { return 0.3F; }
};

}  // namespace radiosity::test
