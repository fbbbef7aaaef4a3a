#include "tests/fuzz/geometry_seeds.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>

namespace gltf_radiosity::fuzz {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A grid of n x n squares.
constexpr std::uint32_t kSquares = 4, kSide = kSquares + 1, kVertexCount = kSide * kSide;

std::vector<std::uint32_t> grid_indices() {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t square = 0; square < kSquares * kSquares; ++square) {
    const std::uint32_t a = square / kSquares * kSide + square % kSquares, b = a + 1, c = a + kSide, d = c + 1;
    indices.insert(indices.end(), {a, b, d, a, d, c});
  }
  return indices;
}

/// Smooth numbers in [-1,1], [kVertexCount * width].
std::vector<float> waves(std::size_t width) {
  std::vector<float> values(kVertexCount * width);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::sin(0.3F * static_cast<float>(k));
  return values;
}

void add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type kind, draco::DataType type, std::int8_t width) {
  const std::size_t stride = static_cast<std::size_t>(width) * static_cast<std::size_t>(draco::DataTypeLength(type));
  draco::GeometryAttribute attribute;
  attribute.Init(kind, nullptr, static_cast<std::uint8_t>(width), type, type != draco::DT_FLOAT32,
                 static_cast<std::int64_t>(stride), 0);
  draco::PointAttribute& added = *mesh.attribute(mesh.AddAttribute(attribute, true, kVertexCount));
  const std::vector<float> values = waves(static_cast<std::size_t>(width));
  for (std::uint32_t vertex = 0; vertex < kVertexCount; ++vertex) {
    const float* row = values.data() + std::size_t{vertex} * static_cast<std::size_t>(width);
    std::array<std::uint8_t, 4> small{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
      small[i] = static_cast<std::uint8_t>(127.0F * (1.0F + row[i]));
    }
    const bool is_float = type == draco::DT_FLOAT32;
    added.SetAttributeValue(draco::AttributeValueIndex(vertex),
                            is_float ? static_cast<const void*>(row) : small.data());
  }
}

void fill_grid(draco::Mesh& mesh) {
  mesh.set_num_points(kVertexCount);
  const std::vector<std::uint32_t> indices = grid_indices();
  for (std::size_t k = 0; k < indices.size(); k += 3) {
    mesh.AddFace({draco::PointIndex(indices[k]), draco::PointIndex(indices[k + 1]), draco::PointIndex(indices[k + 2])});
  }
  add_attribute(mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3);
  add_attribute(mesh, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3);
  add_attribute(mesh, draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, 2);
  add_attribute(mesh, draco::GeometryAttribute::COLOR, draco::DT_UINT8, 4);
}

/// Mode, filter, stride, count, stream.
Bytes stream_seed(std::uint8_t mode, std::uint8_t filter, std::size_t stride, std::size_t count, const Bytes& stream) {
  Bytes seed = {mode, filter, static_cast<std::uint8_t>(stride), static_cast<std::uint8_t>(count),
                static_cast<std::uint8_t>(count >> 8U)};
  seed.insert(seed.end(), stream.begin(), stream.end());
  return seed;
}

Bytes vertex_stream(const Bytes& rows, std::size_t stride) {
  Bytes stream(meshopt_encodeVertexBufferBound(kVertexCount, stride));
  stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), rows.data(), kVertexCount, stride));
  return stream;
}

}  // namespace

Seeds draco_seeds() {
  Seeds seeds;
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    for (const int speed : {0, 3, 5, 7, 10}) {
      for (const int bits : {0, 8}) {
        draco::Mesh mesh;
        fill_grid(mesh);
        draco::ExpertEncoder encoder(mesh);
        encoder.SetEncodingMethod(method);
        encoder.SetSpeedOptions(speed, speed);
        for (int attribute = 0; bits != 0 && attribute < 3; ++attribute) {
          encoder.SetAttributeQuantization(attribute, bits + attribute);
        }
        draco::EncoderBuffer blob;
        if (encoder.EncodeToBuffer(&blob).ok()) seeds.emplace_back(blob.data(), blob.data() + blob.size());
      }
    }
  }
  return seeds;
}

Seeds meshopt_seeds() {
  Seeds seeds;

  // Vertices: plain, and through each filter.
  const std::vector<float> units = waves(4);
  for (std::size_t stride = 4; stride <= 16; stride += 4) {
    const Bytes plain(reinterpret_cast<const std::uint8_t*>(units.data()),
                      reinterpret_cast<const std::uint8_t*>(units.data()) + kVertexCount * stride);
    seeds.push_back(stream_seed(0, 0, stride, kVertexCount, vertex_stream(plain, stride)));
  }
  Bytes rows(kVertexCount * std::size_t{8});
  for (const std::size_t stride : {std::size_t{4}, std::size_t{8}}) {
    meshopt_encodeFilterOct(rows.data(), kVertexCount, stride, stride == 4 ? 8 : 12, units.data());
    seeds.push_back(stream_seed(0, 1, stride, kVertexCount, vertex_stream(rows, stride)));
  }
  meshopt_encodeFilterQuat(rows.data(), kVertexCount, 8, 12, units.data());
  seeds.push_back(stream_seed(0, 2, 8, kVertexCount, vertex_stream(rows, 8)));
  meshopt_encodeFilterExp(rows.data(), kVertexCount, 8, 12, units.data());
  seeds.push_back(stream_seed(0, 3, 8, kVertexCount, vertex_stream(rows, 8)));

  // Indices: as triangles and as a sequence, short and long ones.
  const std::vector<std::uint32_t> indices = grid_indices();
  for (const std::size_t stride : {std::size_t{2}, std::size_t{4}}) {
    Bytes stream(meshopt_encodeIndexBufferBound(indices.size(), kVertexCount));
    stream.resize(meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), indices.size()));
    seeds.push_back(stream_seed(1, 0, stride, indices.size(), stream));
    stream.resize(meshopt_encodeIndexSequenceBound(indices.size(), kVertexCount));
    stream.resize(meshopt_encodeIndexSequence(stream.data(), stream.size(), indices.data(), indices.size()));
    seeds.push_back(stream_seed(2, 0, stride, indices.size(), stream));
  }
  return seeds;
}

}  // namespace gltf_radiosity::fuzz
