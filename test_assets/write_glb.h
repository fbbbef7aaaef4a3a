// A glTF's tree and its binary chunk -> a .glb file, for the makers of scenes that are written in C++.
#pragma once

#include <cstddef>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace test_assets {

/// Appends a number as four little-endian bytes.
inline void append_u32(std::string& bytes, std::size_t number) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((number >> shift) & 0xffU));
}

/// Whether the file could be written.
inline bool write_glb(const char* file, const nlohmann::ordered_json& json, std::string binary) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string glb = "glTF";
  append_u32(glb, 2);
  append_u32(glb, 12 + 8 + text.size() + 8 + binary.size());
  append_u32(glb, text.size());
  glb += "JSON" + text;
  append_u32(glb, binary.size());
  glb += std::string("BIN\0", 4) + binary;
  std::ofstream stream(file, std::ios::binary);
  stream.write(glb.data(), static_cast<std::streamsize>(glb.size()));
  return stream.good();
}

}  // namespace test_assets
