// SPDX-License-Identifier: Apache-2.0
#include "embree_views.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "saccade/views/internal/cast_window.hpp"
#include "saccade/views/internal/stop_grid.hpp"
#include "thesis/stop_volume.hpp"

namespace saccade::bench {
namespace {

using thesis::Stop;
using thesis::StopVolume;

constexpr int kPacketEdge{4};  // pixels
constexpr int kPacketRays{kPacketEdge * kPacketEdge};

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, Release>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, Release>;

Error embree_failed(RTCDevice device) {
  return {Errc::unavailable, "Embree failed with its error " + std::to_string(rtcGetDeviceError(device)), "benchmark"};
}

/// A side of a voxel that stops rays; the corners in lattice coordinates relative to the middle of the box.
struct Face {
  std::array<std::array<float, 3>, 4> corners;
  bool scores;
};

Face face_of(const Index3& voxel, int axis, bool upper, bool scores) {
  const std::array<std::int32_t, 3> lo{voxel.x, voxel.y, voxel.z};
  Face face{{}, scores};
  constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    std::array<int, 3> offset{};
    offset[static_cast<std::size_t>(axis)] = upper ? 1 : 0;
    offset[static_cast<std::size_t>((axis + 1) % 3)] = kAround[corner][0];
    offset[static_cast<std::size_t>((axis + 2) % 3)] = kAround[corner][1];
    for (std::size_t i = 0; i < 3; ++i) face.corners[corner][i] = static_cast<float>(lo[i] + offset[i]);
  }
  return face;
}

std::vector<Face> boundary_faces(const StopVolume& voxels, const Executor& executor) {
  const IndexBox& box = voxels.box();
  const std::array<Index3, 3> steps{Index3{1, 0, 0}, Index3{0, 1, 0}, Index3{0, 0, 1}};
  std::vector<std::vector<Face>> slices(static_cast<std::size_t>(box.hi.z - box.lo.z));
  executor.parallel_for(slices.size(), 1, [&](std::size_t slice, std::size_t) {
    const std::int32_t z = box.lo.z + static_cast<std::int32_t>(slice);
    for (std::int32_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int32_t x = box.lo.x; x < box.hi.x; ++x) {
        const Index3 voxel{x, y, z};
        const Stop stop = voxels.at(voxel);
        if (stop == Stop::no) continue;
        for (int side = 0; side < 6; ++side) {
          const Index3& step = steps[static_cast<std::size_t>(side / 2)];
          const bool upper = side % 2 == 1;
          const Index3 neighbour = upper ? voxel + step : voxel - step;
          if (!box.contains(neighbour) || voxels.at(neighbour) != Stop::no) continue;
          slices[slice].push_back(face_of(voxel - voxels.middle(), side / 2, upper, stop == Stop::scores));
        }
      }
    }
  });
  std::vector<Face> faces;
  for (const auto& slice : slices) faces.insert(faces.end(), slice.begin(), slice.end());
  return faces;
}

/// False without memory.
bool attach_quads(RTCDevice device, RTCScene scene, const std::vector<Face>& faces) {
  RTCGeometry quads = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), 4 * faces.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                                                      4 * sizeof(std::uint32_t), faces.size()));
  const bool allocated = vertices != nullptr && indices != nullptr;
  if (allocated) {
    for (const Face& face : faces) {
      for (const auto& corner : face.corners) vertices = std::copy(corner.begin(), corner.end(), vertices);
    }
    for (std::uint32_t i = 0; i < 4 * faces.size(); ++i) indices[i] = i;
    rtcCommitGeometry(quads);
    rtcAttachGeometry(scene, quads);
  }
  rtcReleaseGeometry(quads);
  return allocated;
}

}  // namespace

struct EmbreeViews::Impl {
  double voxel_size_m;
  Region region;
  StopVolume voxels;
  std::vector<std::uint8_t> scores;  // per face
  EmbreeDevice device;               // released after
  EmbreeScene scene;                 // its faces

  /// Behind the region, metres along the camera's z.
  [[nodiscard]] double region_end_m(const Pose& T_world_camera) const {
    const Box box = bounds(region);
    const Eigen::Vector3d half = 0.5 * (box.max - box.min);
    const double reach_m = std::holds_alternative<Sphere>(region) ? half.x() : half.norm();
    return (T_world_camera.inverse() * (0.5 * (box.min + box.max))).z() + reach_m + 2.0 * voxel_size_m;
  }
  [[nodiscard]] std::uint64_t gain(const Pose& T_world_camera, const PinholeCamera& sensor,
                                   const std::array<PixelAxes, 4>& axes) const;
};

std::uint64_t EmbreeViews::Impl::gain(const Pose& T_world_camera, const PinholeCamera& sensor,
                                      const std::array<PixelAxes, 4>& axes) const {
  const SensorRays rays = sensor_rays(T_world_camera, voxel_size_m);
  SACCADE_EXPECTS(voxels.box().contains(rays.origin.voxel));
  if (voxels.at(rays.origin.voxel) != Stop::no) return 0;
  CastWindow window = window_of(rays, axes[static_cast<std::size_t>(rays.quarter_turns)],
                                voxels_around(region, voxel_size_m), region, voxel_size_m);
  if (window.empty()) return 0;
  window.columns = column_ranges(window, region, voxel_size_m);
  // Multiples of 2⁻¹⁶ of magnitude below 2⁸: exact in single precision.
  const Index3 origin_voxel = rays.origin.voxel - voxels.middle();
  const float origin_x = static_cast<float>(origin_voxel.x) + rays.origin.fraction[0];
  const float origin_y = static_cast<float>(origin_voxel.y) + rays.origin.fraction[1];
  const float origin_z = static_cast<float>(origin_voxel.z) + rays.origin.fraction[2];
  const auto min_t = static_cast<float>(sensor.min_range_m);
  const auto max_t = static_cast<float>(std::min(sensor.max_range_m, region_end_m(T_world_camera)));
  const auto width = static_cast<int>(window.a.size());
  const auto height = static_cast<int>(window.b.size());

  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::uint64_t scored{0};
  for (int row = 0; row < height; row += kPacketEdge) {
    ColumnRange any{width, 0};
    for (int j = row; j < std::min(row + kPacketEdge, height); ++j) {
      const ColumnRange range = window.columns_of(j);
      if (range.begin < range.end) any = {std::min(any.begin, range.begin), std::max(any.end, range.end)};
    }
    for (int column = any.begin; column < any.end; column += kPacketEdge) {
      alignas(64) std::array<int, kPacketRays> valid;
      alignas(64) RTCRayHit16 packet;
      for (int k = 0; k < kPacketRays; ++k) {
        const int i = column + k % kPacketEdge;
        const int j = row + k / kPacketEdge;
        const float a = window.a[static_cast<std::size_t>(std::min(i, width - 1))];
        const float b = window.b[static_cast<std::size_t>(std::min(j, height - 1))];
        const ColumnRange range = j < height ? window.columns_of(j) : ColumnRange{};
        valid[static_cast<std::size_t>(k)] = i >= range.begin && i < range.end ? -1 : 0;
        packet.ray.org_x[k] = origin_x;
        packet.ray.org_y[k] = origin_y;
        packet.ray.org_z[k] = origin_z;
        packet.ray.dir_x[k] = rays.x[0] * a + (rays.y[0] * b + rays.z[0]);
        packet.ray.dir_y[k] = rays.x[1] * a + (rays.y[1] * b + rays.z[1]);
        packet.ray.dir_z[k] = rays.x[2] * a + (rays.y[2] * b + rays.z[2]);
        packet.ray.tnear[k] = 0.0F;
        packet.ray.tfar[k] = max_t;
        packet.ray.time[k] = 0.0F;
        packet.ray.mask[k] = ~0U;
        packet.ray.flags[k] = 0;
        packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(valid.data(), scene.get(), &context, &packet);
      for (int k = 0; k < kPacketRays; ++k) {
        const bool hit = valid[static_cast<std::size_t>(k)] != 0 && packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
        if (hit && packet.ray.tfar[k] >= min_t) scored += scores[packet.hit.primID[k]];
      }
    }
  }
  return scored;
}

EmbreeViews::EmbreeViews(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
EmbreeViews::EmbreeViews(EmbreeViews&& other) noexcept = default;
EmbreeViews::~EmbreeViews() = default;
std::size_t EmbreeViews::faces() const { return impl_->scores.size(); }

Result<EmbreeViews> EmbreeViews::prepare(const TsdfSnapshot& map, const Region& region,
                                         std::span<const Pose> T_world_camera, const Executor& executor) {
  IndexBox box = voxels_around(region, map.config.voxel_size_m);
  for (const Pose& pose : T_world_camera) {
    const Index3 voxel = sensor_rays(pose, map.config.voxel_size_m).origin.voxel;
    box.lo = {std::min(box.lo.x, voxel.x), std::min(box.lo.y, voxel.y), std::min(box.lo.z, voxel.z)};
    box.hi = {std::max(box.hi.x, voxel.x + 1), std::max(box.hi.y, voxel.y + 1), std::max(box.hi.z, voxel.z + 1)};
  }
  const Index3 one{1, 1, 1};
  const IndexBox bricks{parent(box.lo - one), parent(box.hi) + one};

  auto impl = std::make_unique<Impl>(
      Impl{map.config.voxel_size_m, region, StopVolume::fill(map, region, bricks, executor), {}, {}, {}});
  const std::vector<Face> faces = boundary_faces(impl->voxels, executor);
  for (const Face& face : faces) impl->scores.push_back(face.scores ? 1 : 0);
  impl->device.reset(rtcNewDevice(("threads=" + std::to_string(executor.threads())).c_str()));
  if (!impl->device) return embree_failed(nullptr);
  impl->scene.reset(rtcNewScene(impl->device.get()));
  if (!impl->scene) return embree_failed(impl->device.get());
  rtcSetSceneBuildQuality(impl->scene.get(), RTC_BUILD_QUALITY_HIGH);
  if (!attach_quads(impl->device.get(), impl->scene.get(), faces)) return embree_failed(impl->device.get());
  rtcCommitScene(impl->scene.get());
  if (rtcGetDeviceError(impl->device.get()) != RTC_ERROR_NONE) return embree_failed(impl->device.get());
  return EmbreeViews{std::move(impl)};
}

std::vector<std::uint64_t> EmbreeViews::gains(std::span<const Pose> T_world_camera, const PinholeCamera& sensor,
                                              const Executor& executor) const {
  const std::array<PixelAxes, 4> axes{pixel_axes(sensor, 0), pixel_axes(sensor, 1), pixel_axes(sensor, 2),
                                      pixel_axes(sensor, 3)};
  std::vector<std::uint64_t> gains(T_world_camera.size());
  executor.parallel_for(gains.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) gains[i] = impl_->gain(T_world_camera[i], sensor, axes);
  });
  return gains;
}

}  // namespace saccade::bench
