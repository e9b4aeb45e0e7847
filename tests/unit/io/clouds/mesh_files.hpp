// SPDX-License-Identifier: Apache-2.0
#pragma once
// A made mesh, and its files.

#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>
#include <string>

#include "saccade/map/mesh.hpp"

namespace saccade::test {

/// A ball of `slices` meridians and half as many parallels, without poles: an open band of triangles.
inline TriangleMesh made_ball(int slices) {
  TriangleMesh mesh;
  const int rings = slices / 2 + 1;
  for (int ring = 0; ring < rings; ++ring) {
    const double height = -0.8 + 1.6 * ring / (rings - 1);
    for (int slice = 0; slice < slices; ++slice) {
      const double angle = 2.0 * std::numbers::pi * slice / slices;
      const double radius = std::sqrt(1.0 - height * height);
      mesh.vertices.emplace_back(
          Eigen::Vector3d{radius * std::cos(angle), radius * std::sin(angle), height}.cast<float>());
    }
  }
  const auto at = [&](int ring, int slice) { return static_cast<std::uint32_t>(ring * slices + slice % slices); };
  for (int ring = 0; ring + 1 < rings; ++ring) {
    for (int slice = 0; slice < slices; ++slice) {
      mesh.triangles.push_back({at(ring, slice), at(ring, slice + 1), at(ring + 1, slice)});
      mesh.triangles.push_back({at(ring, slice + 1), at(ring + 1, slice + 1), at(ring + 1, slice)});
    }
  }
  return mesh;
}

inline std::string coordinates(const Eigen::Vector3f& v) {
  std::ostringstream text;
  text.precision(9);
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

inline std::string stl_text(const TriangleMesh& mesh) {
  std::string text{"solid made\n"};
  for (const auto& triangle : mesh.triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t corner : triangle) text += "   vertex " + coordinates(mesh.vertices[corner]) + '\n';
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid made\n";
}

inline std::string stl_binary(const TriangleMesh& mesh, std::string header) {
  header.resize(80, ' ');
  const auto append = [&](const auto& value) { header.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) append(0.0F);
    for (const std::uint32_t corner : triangle) {
      for (int i = 0; i < 3; ++i) append(mesh.vertices[corner][i]);
    }
    append(std::uint16_t{0});
  }
  return header;
}

inline std::string obj_text(const TriangleMesh& mesh) {
  std::string text{"# made\n"};
  for (const Eigen::Vector3f& v : mesh.vertices) text += "v " + coordinates(v) + '\n';
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "f " + std::to_string(a + 1) + ' ' + std::to_string(b + 1) + ' ' + std::to_string(c + 1) + '\n';
  }
  return text;
}

inline std::string off_text(const TriangleMesh& mesh) {
  std::string text =
      "OFF\n" + std::to_string(mesh.vertices.size()) + ' ' + std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Eigen::Vector3f& v : mesh.vertices) text += coordinates(v) + '\n';
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  }
  return text;
}

/// PLY as text, with faces as lists.
inline std::string ply_text(const TriangleMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3f& v : mesh.vertices) text += coordinates(v) + '\n';
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  }
  return text;
}

/// COLLADA of one triangle list, in metres.
inline std::string collada_text(const TriangleMesh& mesh) {
  std::string numbers;
  for (const Eigen::Vector3f& v : mesh.vertices) numbers += coordinates(v) + ' ';
  std::string indices;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) indices += std::to_string(corner) + ' ';
  }
  const std::string vertices = std::to_string(mesh.vertices.size());
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>
<unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="pa" count=")" +
         std::to_string(3 * mesh.vertices.size()) + "\">" + numbers +
         R"(</float_array><technique_common><accessor source="#pa" count=")" + vertices + R"(" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count=")" +
         std::to_string(mesh.triangles.size()) + R"(">
<input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         indices + R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

/// GLB of one primitive: positions as floats, then indices.
inline std::string glb_binary(const TriangleMesh& mesh) {
  std::string buffer;
  const auto append = [](std::string& to, const auto& value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (const Eigen::Vector3f& v : mesh.vertices) {
    for (int i = 0; i < 3; ++i) append(buffer, v[i]);
  }
  const std::size_t positions = buffer.size();
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) append(buffer, corner);
  }
  const auto count = [](std::size_t n) { return std::to_string(n); };
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":)" +
      count(buffer.size()) + R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" + count(positions) +
      R"(},{"buffer":0,"byteOffset":)" + count(positions) + R"(,"byteLength":)" + count(buffer.size() - positions) +
      R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" + count(mesh.vertices.size()) +
      R"(,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]},{"bufferView":1,"componentType":5125,"count":)" +
      count(3 * mesh.triangles.size()) + R"(,"type":"SCALAR"}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string file{"glTF"};
  append(file, std::uint32_t{2});
  append(file, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  append(file, static_cast<std::uint32_t>(json.size()));
  file += "JSON" + json;
  append(file, static_cast<std::uint32_t>(buffer.size()));
  file += std::string{"BIN\0", 4} + buffer;
  return file;
}

}  // namespace saccade::test
