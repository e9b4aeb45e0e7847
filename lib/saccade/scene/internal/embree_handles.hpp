// SPDX-License-Identifier: Apache-2.0
#pragma once
// Owners of Embree's handles, and a triangle mesh as an Embree geometry. Internal to the room.

#include <embree3/rtcore.h>

#include <algorithm>
#include <memory>
#include <string>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

struct EmbreeDeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct EmbreeSceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeDeviceRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, EmbreeSceneRelease>;

[[nodiscard]] inline Error embree_failed(RTCDevice device) {
  return Error{Errc::unavailable, "Embree failed with its error " + std::to_string(rtcGetDeviceError(device)), "scene"};
}

/// Copies the mesh into buffers that Embree owns; the geometry gets the number `id`. Returns false without memory.
[[nodiscard]] inline bool attach_mesh(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, unsigned id) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  const bool allocated = vertices != nullptr && indices != nullptr;
  if (allocated) {
    for (const Eigen::Vector3f& vertex : mesh.vertices) vertices = std::copy_n(vertex.data(), 3, vertices);
    for (const auto& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
  }
  rtcReleaseGeometry(geometry);
  return allocated;
}

}  // namespace saccade
