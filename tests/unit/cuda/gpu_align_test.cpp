// SPDX-License-Identifier: Apache-2.0
// ICP by the kernels of the GPU, run on the host, against that of the CPU: to the bit.
#include "saccade/cuda/gpu_align.hpp"

#include <gtest/gtest.h>

#include <random>

#include "ordered_device.hpp"
#include "saccade/cuda/internal/gpu_alignment.hpp"
#include "saccade/tracking/internal/icp_kernels.hpp"
#include "saccade/tracking/internal/pair_math.hpp"
#include "support/parallel_backend.hpp"
#include "things_on_a_table.hpp"

namespace saccade {
namespace {

PinholeCamera camera_of(int width, int height) {
  return {width, height, 0.9 * width, 0.9 * width, 0.5 * (width - 1), 0.5 * (height - 1), 0.3, 3.0};
}

PointImage points_at(const PinholeCamera& camera, const Pose& T_world_camera) {
  return to_points(render(test::things_on_a_table(), camera, T_world_camera, {}).value().depth, camera, {});
}

void expect_equal(const Result<IcpResult>& result, const IcpResult& expected) {
  ASSERT_TRUE(result.ok()) << result.error().to_string();
  EXPECT_EQ(result->T_model_camera.matrix(), expected.T_model_camera.matrix());
  EXPECT_EQ(result->iterations, expected.iterations);
  EXPECT_EQ(result->rmse_m, expected.rmse_m);
  EXPECT_EQ(result->inlier_share, expected.inlier_share);
  EXPECT_EQ(result->why, expected.why);
}

TEST(GpuAligner, AlignsToTheBit) {
  const Executor two_workers = Executor::with_threads(2, test::kParallelBackend);
  GpuAligner aligner = GpuAligner::create_emulated(two_workers).value();
  const Pose T_world_model = look_at({0.5, -0.4, 0.5}, {0.0, 0.0, 0.05}, Eigen::Vector3d::UnitZ());
  std::mt19937 random{7};
  std::uniform_real_distribution<double> small{-0.02, 0.02};
  int converged{0};
  for (const auto& [width, height] : {std::pair{161, 123}, {64, 48}, {17, 9}, {200, 150}}) {
    SCOPED_TRACE(width);
    const PinholeCamera camera = camera_of(width, height);
    const PointImage model = points_at(camera, T_world_model);
    for (std::uint32_t order = 0; order < 4; ++order) {
      SCOPED_TRACE("order " + std::to_string(order));
      Pose moved = Pose::Identity();
      moved.linear() = Eigen::AngleAxisd{small(random), Eigen::Vector3d{1.0, small(random), 0.5}.normalized()}.matrix();
      moved.translation() = Eigen::Vector3d::NullaryExpr([&] { return small(random); });
      const PointImage measured = points_at(camera, T_world_model * moved);
      const IcpResult expected = align(measured, model, camera, Pose::Identity(), {});
      const auto device = test::ordered_device(two_workers, order);
      internal::cuda::GpuAlignment in_order{*device};
      expect_equal(in_order.align(measured, model, camera, Pose::Identity(), {}), expected);
      expect_equal(aligner.align(measured, model, camera, Pose::Identity()), expected);
      converged += expected.converged ? 1 : 0;
    }
  }
  EXPECT_GT(converged, 6);
}

TEST(GpuAligner, AnImageWithoutReturnsIsLostNotAnError) {
  GpuAligner aligner = GpuAligner::create_emulated({}).value();
  const PinholeCamera camera = camera_of(32, 24);
  const PointImage nothing = to_points(DepthImage{32, 24}, camera, {});
  const IcpResult result = aligner.align(nothing, nothing, camera, Pose::Identity()).value();
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.why, align(nothing, nothing, camera, Pose::Identity(), {}).why);
  IcpConfig bad;
  bad.strides[0] = 0;
  EXPECT_EQ(aligner.align(nothing, nothing, camera, Pose::Identity(), bad).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
