// SPDX-License-Identifier: Apache-2.0
// The largest that the kernels are asked to do, run on the host, against the CPU: to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ordered_device.hpp"
#include "saccade/cuda/internal/gpu_alignment.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/views/view_gain.hpp"
#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

Executor both_threads() { return Executor::with_threads(2, test::kParallelBackend); }

/// Waves, half a metre away.
DepthImage surf(const PinholeCamera& camera) {
  DepthImage depth{camera.width, camera.height};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double x = camera.ray(u, v).x();
      const double y = camera.ray(u, v).y();
      depth(u, v) = static_cast<float>(0.5 + 0.03 * std::sin(9.0 * x + 5.0 * y) + 0.03 * std::cos(8.0 * y));
    }
  }
  return depth;
}

/// @return pixels that show a surface
std::size_t expect_same_views(const SurfaceView& got, const SurfaceView& wanted) {
  EXPECT_EQ(got.depth.size(), wanted.depth.size());
  EXPECT_EQ(std::memcmp(got.depth.data(), wanted.depth.data(), got.depth.size() * sizeof(float)), 0);
  EXPECT_TRUE(std::equal(got.normals.data(), got.normals.data() + got.normals.size(), wanted.normals.data()));
  const float* const depths_m = wanted.depth.data();
  return static_cast<std::size_t>(
      std::count_if(depths_m, depths_m + wanted.depth.size(), [](float z) { return z > 0.0F; }));
}

/// No image may be wider or taller.
TEST(LargeSurface, TheWidestAndTheTallestImageAreDoneToTheBit) {
  constexpr int kMost{1 << 14};
  constexpr int kLeast{12};
  for (const auto& [width, height] : {std::pair{kMost, kLeast}, {kLeast, kMost}}) {
    SCOPED_TRACE(width);
    const PinholeCamera camera{width, height, 1.0 * width, 1.0 * height, 0.5 * (width - 1), 0.5 * (height - 1),
                               0.1,   0.9};
    PinholeCamera beyond = camera;
    beyond.width = width + (width == kMost ? 1 : 0);
    beyond.height = height + (height == kMost ? 1 : 0);
    ASSERT_FALSE(beyond.validate().ok());
    TsdfConfig config;
    config.voxel_size_m = 0.01;
    TsdfMap cpu = TsdfMap::create(config).value();
    GpuMap gpu = test::ordered_map(config, both_threads(), 2);
    const DepthImage depth = surf(camera);
    ASSERT_TRUE(cpu.integrate(camera, depth, Pose::Identity(), {}).ok());
    ASSERT_TRUE(gpu.integrate(camera, depth, Pose::Identity()).ok());
    EXPECT_TRUE(gpu.snapshot().value().grid == cpu.content().grid);
    const SurfaceView view = raycast(cpu.content(), camera, Pose::Identity(), {}).value();
    const std::size_t seen = expect_same_views(gpu.raycast(camera, Pose::Identity()).value(), view);
    EXPECT_GT(seen, std::size_t{kMost} * kLeast / 2);
    const Region region{Sphere{{0.0, 0.0, 0.55}, 0.1}};
    GainConfig gain;
    gain.sensor = camera;
    gain.unknown_outside = UnknownOutside::transparent;
    const std::vector<Pose> views{Pose::Identity()};
    ASSERT_TRUE(cpu.forget(region).ok());
    ASSERT_TRUE(gpu.assign(cpu.content()).ok());
    const GainResult gains = evaluate_views(cpu.content(), region, views, gain, {}).value();
    EXPECT_EQ(gpu.evaluate_views(region, views, gain, {}).value().gains, gains.gains);
    EXPECT_GT(gains.gains.front(), 1000U);
    const PointImage model = to_points(view, {});
    const PointImage measured = to_points(depth, camera, {});
    const auto device = test::ordered_device(both_threads(), 2);
    internal::cuda::GpuAlignment alignment{*device};
    const IcpResult aligned = alignment.align(measured, model, camera, Pose::Identity(), {}).value();
    const IcpResult wanted = align(measured, model, camera, Pose::Identity(), {});
    EXPECT_EQ(aligned.T_model_camera.matrix(), wanted.T_model_camera.matrix());
    EXPECT_EQ(aligned.inlier_share, wanted.inlier_share);
    EXPECT_GT(aligned.inlier_share, 0.2);
  }
}

/// A map may span 2^27 bricks, whatever it holds: here two corners of a cube of 41 m.
TEST(LargeSurface, TheLargestTableIsReadAtBothEnds) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  TsdfMap cpu = TsdfMap::create(config).value();
  const PinholeCamera camera{48, 36, 60.0, 60.0, 23.5, 17.5, 0.1, 0.58};
  constexpr double kSectorEdge_m{kSectorEdge * kBrickEdge * 0.01};
  constexpr int kMostSectors{64};
  std::vector<Pose> views;
  for (const int sector : {0, kMostSectors - 1}) {  // the camera and all that it sees lie in one sector
    Pose T_world_camera = Pose::Identity();
    T_world_camera.translation() =
        Eigen::Vector3d{0.32, 0.32, 0.02} + Eigen::Vector3d::Constant(sector * kSectorEdge_m);
    ASSERT_TRUE(cpu.integrate(camera, surf(camera), T_world_camera, {}).ok());
    views.push_back(T_world_camera);
  }
  ASSERT_EQ(cpu.content().grid.sector_bounds().count() * kSectorBricks, 1 << 27);
  std::vector<Region> regions;
  for (const Pose& T_world_camera : views) {
    regions.push_back(Sphere{T_world_camera * Eigen::Vector3d{0.0, 0.0, 0.45}, 0.08});
    ASSERT_TRUE(cpu.forget(regions.back()).ok());
  }
  GpuMap gpu = test::ordered_map(config, both_threads(), 0);
  ASSERT_TRUE(gpu.assign(cpu.content()).ok());
  GainConfig gain;
  gain.sensor = camera;
  gain.unknown_outside = UnknownOutside::transparent;
  for (const Region& region : regions) {
    const GainResult gains = evaluate_views(cpu.content(), region, views, gain, {}).value();
    EXPECT_EQ(gpu.evaluate_views(region, views, gain, {}).value().gains, gains.gains);
    EXPECT_GT(*std::max_element(gains.gains.begin(), gains.gains.end()), 10U);
  }
  EXPECT_FALSE(gpu.is_paged()) << "all of it is on the device";
}

}  // namespace
}  // namespace saccade
