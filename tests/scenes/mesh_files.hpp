#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

// Small meshes as files, written by the tests themselves: a box of 1 x 2 x 3 file units with one corner in the origin.

namespace ensonify::testing {

/// A folder of this test alone, removed at its end.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("ensonify_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

constexpr float box_corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0},
                                     {0, 0, 3}, {1, 0, 3}, {0, 2, 3}, {1, 2, 3}};
constexpr int box_faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

inline std::string corner_text(int corner, float scale) {
  std::string text;
  for (const float x : box_corners[corner]) text += std::to_string(x * scale) + " ";
  return text;
}

template <typename T>
void append_bytes(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline std::string box_obj(float scale = 1) {
  std::string text = "mtllib /etc/passwd\no box\n";
  for (int c = 0; c < 8; ++c) text += "v " + corner_text(c, scale) + "\n";
  for (const auto& f : box_faces) {
    text += "f";
    for (const int c : f) text += ' ' + std::to_string(c + 1);
    text += "\n";
  }
  return text;
}

inline std::string box_ply(float scale = 1) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
  for (int c = 0; c < 8; ++c) text += corner_text(c, scale) + "\n";
  for (const auto& f : box_faces) {
    text += "3";
    for (const int c : f) text += ' ' + std::to_string(c);
    text += "\n";
  }
  return text;
}

inline std::string box_binary_ply() {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& corner : box_corners) {
    for (const float x : corner) append_bytes(bytes, x);
  }
  for (const auto& f : box_faces) {
    append_bytes(bytes, std::uint8_t{3});
    for (const int c : f) append_bytes(bytes, c);
  }
  return bytes;
}

inline std::string box_stl_text(float scale = 1) {
  std::string text = "solid box\n";
  for (const auto& f : box_faces) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int c : f) text += "  vertex " + corner_text(c, scale) + "\n";
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid box\n";
}

inline std::string box_stl_binary(float scale = 1) {
  std::string bytes(80, ' ');
  append_bytes(bytes, std::uint32_t{12});
  for (const auto& f : box_faces) {
    for (int i = 0; i < 3; ++i) append_bytes(bytes, 0.0f);
    for (const int c : f) {
      for (const float x : box_corners[c]) append_bytes(bytes, x * scale);
    }
    append_bytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

/// `asset` goes into <asset>, `transform` into the node, `children` beside the geometry in the node.
inline std::string box_dae(const std::string& asset, const std::string& transform, const std::string& children = "") {
  std::string positions, faces;
  for (int c = 0; c < 8; ++c) positions += corner_text(c, 1);
  for (const auto& f : box_faces) {
    for (const int c : f) faces += std::to_string(c) + " ";
  }
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         asset + R"(</asset>
<library_geometries><geometry id="box"><mesh>
<source id="p"><float_array id="pa" count="24">)" +
         positions + R"(</float_array><technique_common>
<accessor source="#pa" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         faces + R"(</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)" +
         transform + R"(<instance_geometry url="#box"/>)" + children + R"(</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

inline std::string box_gltf(const std::string& buffer_uri, const std::string& nodes = R"([{"mesh":0}])") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"buffers":[{"uri":")" +
         buffer_uri + R"(","byteLength":168}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}],
"accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[1,2,3]},
{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}]})";
}

inline std::string box_gltf_buffer() {
  std::string bytes;
  for (const auto& corner : box_corners) {
    for (const float x : corner) append_bytes(bytes, x);
  }
  for (const auto& f : box_faces) {
    for (const int c : f) append_bytes(bytes, static_cast<std::uint16_t>(c));
  }
  return bytes;
}

}  // namespace ensonify::testing
