// SPDX-License-Identifier: Apache-2.0
// The kernels of the GPU on the host, where the blocks of a launch run on several threads: a whole step from frames to
// views, with every kernel there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "saccade/cuda/internal/all_kernels.hpp"
#include "saccade/cuda/internal/gpu_alignment.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/views/expected_surface.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/checked_compute.hpp"
#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

using Names = std::set<std::string>;

/// Device on four threads that remembers the kernels whose blocks it shared out among them.
class SharingDevice final : public test::CheckedCompute {
 public:
  explicit SharingDevice(std::shared_ptr<Names> shared)
      : CheckedCompute{~std::size_t{0}, Executor::with_threads(4, test::kParallelBackend), 5},
        shared_{std::move(shared)} {}

 private:
  [[nodiscard]] Status check() override { return {}; }
  void watch(const internal::cuda::KernelEntry& kernel, std::size_t blocks) override {
    constexpr std::size_t kMostOfAThread{16};  // blocks at a time
    if (blocks > kMostOfAThread) shared_->insert(kernel.name);
  }
  std::shared_ptr<Names> shared_;
};

Names all_kernels() {
#define SACCADE_NAME(name, Kernel) #name,
  return {SACCADE_ALL_KERNELS(SACCADE_NAME)};
#undef SACCADE_NAME
}

const PinholeCamera kCamera{128, 96, 105.0, 105.0, 63.5, 47.5, 0.2, 1.4};

const Box kWorkspace{{-0.4, -0.4, -0.1}, {0.4, 0.4, 0.4}};

DepthImage depth_at(const PinholeCamera& camera, const Pose& T_world_camera) {
  return render(sample_tabletop(), camera, T_world_camera).value().depth;
}

/// Fuses frames into both.
void fuse(TsdfMap& cpu, GpuMap& gpu) {
  ASSERT_TRUE(cpu.free(Box{{-0.9, -0.9, -0.3}, {0.9, 0.9, 0.9}}).ok());  // cameras stand in free space
  ASSERT_TRUE(cpu.forget(kWorkspace).ok());
  ASSERT_TRUE(gpu.follow(cpu.snapshot(), {}).ok());
  for (const Pose& T_world_camera : sample_trajectory(3)) {
    const DepthImage depth = depth_at(kCamera, T_world_camera);
    ASSERT_TRUE(cpu.integrate(kCamera, depth, T_world_camera, {}).ok());
    ASSERT_TRUE(gpu.integrate(kCamera, depth, T_world_camera).ok());
  }
  EXPECT_TRUE(gpu.snapshot().value().grid == cpu.snapshot().grid);
}

void cast(const TsdfSnapshot& map, GpuMap& gpu) {
  const Pose T_world_camera = sample_trajectory(5)[1];
  const SurfaceView expected = raycast(map, kCamera, T_world_camera, {}).value();
  const SurfaceView view = gpu.raycast(kCamera, T_world_camera).value();
  EXPECT_EQ(std::memcmp(view.depth.data(), expected.depth.data(), view.depth.size() * sizeof(float)), 0);
  EXPECT_GT(std::count_if(view.depth.data(), view.depth.data() + view.depth.size(), [](float z) { return z > 0.0F; }),
            2000);
}

void gains(const TsdfSnapshot& map, const Region& region, GpuMap& gpu) {
  ViewSphereConfig sphere;
  sphere.radii_m = {0.6};
  const std::vector<Pose> poses = poses_of(view_sphere({0.0, 0.0, 0.05}, sphere).value());
  GainConfig config;
  config.sensor = {48, 36, 39.0, 39.0, 23.5, 17.5, 0.2, 3.0};
  const GainResult expected = evaluate_views(map, region, poses, config, {}).value();
  EXPECT_EQ(gpu.evaluate_views(region, poses, config, Executor::with_threads(4, test::kParallelBackend)).value().gains,
            expected.gains);
  EXPECT_GT(*std::max_element(expected.gains.begin(), expected.gains.end()), 0U);
}

/// The surface expected on the table, and lines of sight from each of its points to some cameras.
void expect(TsdfSnapshot map, GpuMap& gpu) {
  map.config.workspace = kWorkspace;
  const ExpectedSurface wanted = expected_surface(map, {}, {}).value();
  const ExpectedSurface got = expected_surface(map, {}, {}, &gpu).value();
  EXPECT_EQ(got.completed, wanted.completed);
  ASSERT_EQ(got.points.size(), wanted.points.size());
  ASSERT_GT(got.points.size(), 100U);
  ASSERT_NE(got.volume->ticket(), 0U) << "the device did the work";
  std::vector<Eigen::Vector3d> cameras_m;
  for (const Pose& T_world_camera : sample_trajectory(20)) cameras_m.push_back(T_world_camera.translation());
  std::vector<LineOfSight> lines;
  std::vector<std::uint8_t> visible;
  for (std::uint32_t camera = 0; camera < cameras_m.size(); ++camera) {
    for (const ExpectedPoint& point : got.points) {
      EXPECT_EQ(point.voxel, wanted.points[lines.size() % wanted.points.size()].voxel);
      lines.push_back({point.voxel, camera});
      visible.push_back(wanted.volume->is_visible(point.voxel, cameras_m[camera], 0.05) ? 1 : 0);
    }
  }
  EXPECT_EQ(gpu.in_sight(got.volume->ticket(), lines, cameras_m, 0.05).value(), visible);
  EXPECT_GT(std::count(visible.begin(), visible.end(), 1), 10);
}

/// A tall image, so that there are many chunks of rows to sum.
void align_tall_images(internal::cuda::Compute& device) {
  const PinholeCamera camera{24, 600, 24.0, 600.0, 11.5, 299.5, 0.2, 3.0};
  const std::vector<Pose> poses = sample_trajectory(60);
  const PointImage model = to_points(depth_at(camera, poses[30]), camera, {});
  const PointImage measured = to_points(depth_at(camera, poses[31]), camera, {});
  internal::cuda::GpuAlignment alignment{device};
  const IcpResult expected = align(measured, model, camera, Pose::Identity(), {});
  const IcpResult result = alignment.align(measured, model, camera, Pose::Identity(), {}).value();
  EXPECT_EQ(result.T_model_camera.matrix(), expected.T_model_camera.matrix());
  EXPECT_EQ(result.inlier_share, expected.inlier_share);
  EXPECT_EQ(result.iterations, expected.iterations);
  EXPECT_GT(result.iterations, 2);
}

TEST(GpuKernels, BlocksOnFourThreadsDoWhatTheCpuDoes) {
  const auto shared = std::make_shared<Names>();
  TsdfConfig config;
  config.voxel_size_m = 0.015;
  const Region region{Sphere{{0.0, 0.0, 0.05}, 0.15}};
  TsdfMap cpu = TsdfMap::create(config).value();
  GpuMap gpu = internal::cuda::GpuMapMaker::make(config, std::make_unique<SharingDevice>(shared));
  fuse(cpu, gpu);
  expect(cpu.snapshot(), gpu);
  ASSERT_TRUE(cpu.forget(region).ok());
  ASSERT_TRUE(cpu.free(Box{{5.5, 5.5, 5.5}, {5.6, 5.6, 5.6}}).ok());  // a table of many blocks
  const TsdfSnapshot map = cpu.snapshot();
  ASSERT_TRUE(gpu.follow(map, {}).ok());
  cast(map, gpu);
  gains(map, region, gpu);
  SharingDevice device{shared};
  align_tall_images(device);
  EXPECT_EQ(*shared, all_kernels());
}

}  // namespace
}  // namespace saccade
