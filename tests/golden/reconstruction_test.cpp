// SPDX-License-Identifier: Apache-2.0
// Tracking on the analytic table-top: where the camera is known exactly.

#include <gtest/gtest.h>

#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/noise.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade {
namespace {

PinholeCamera camera() { return {320, 240, 262.5, 262.5, 159.5, 119.5, 0.2, 3.0}; }

Frame frame_at(const Pose& T_world_camera) {
  auto rendered = render(sample_tabletop(), camera(), T_world_camera, Executor::with_threads(2));
  EXPECT_TRUE(rendered.ok());
  Frame frame;
  frame.depth = std::move(rendered->depth);
  return frame;
}

Result<Reconstruction> reconstruction() {
  ReconstructionConfig config;
  config.map.voxel_size_m = 0.008;
  return Reconstruction::create(config);
}

/// Fuses the first `count` of `poses` in mode icp; the largest translation error on the way.
double track(Reconstruction& r, const std::vector<Pose>& poses, std::size_t count, const Executor& executor) {
  double worst{0.0};
  for (std::size_t i = 0; i < count; ++i) {
    const auto report = r.process(frame_at(poses[i]), camera(), TrackingMode::icp, poses[0], executor);
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(report->status, FrameReport::Status::fused) << "frame " << i << ": " << report->why;
    worst = std::max(worst, (report->T_world_camera.translation() - poses[i].translation()).norm());
  }
  return worst;
}

TEST(Tracking, FollowsTheCameraAroundTheTable) {
  auto r = reconstruction();
  ASSERT_TRUE(r.ok());
  const std::vector<Pose> poses = sample_trajectory(120);
  EXPECT_LT(track(*r, poses, 40, Executor::with_threads(2)), 0.004);
}

TEST(Tracking, ThreadsNeverChangeABit) {
  const std::vector<Pose> poses = sample_trajectory(120);
  auto one = reconstruction();
  auto seven = reconstruction();
  ASSERT_TRUE(one.ok() && seven.ok());
  track(*one, poses, 4, Executor{});
  track(*seven, poses, 4, Executor::with_threads(7));
  EXPECT_TRUE(one->last_pose()->matrix() == seven->last_pose()->matrix());
  EXPECT_TRUE(one->map().content().grid == seven->map().content().grid);
}

TEST(Tracking, ALostFrameLeavesTheMapUntouched) {
  const Executor executor = Executor::with_threads(2);
  auto r = reconstruction();
  ASSERT_TRUE(r.ok());
  const std::vector<Pose> poses = sample_trajectory(120);
  track(*r, poses, 3, executor);
  const TsdfSnapshot before = r->map().snapshot();
  const Pose last = *r->last_pose();

  Frame zeros;
  zeros.depth = DepthImage{camera().width, camera().height};
  const auto blind = r->process(zeros, camera(), TrackingMode::icp, std::nullopt, executor);
  ASSERT_TRUE(blind.ok());
  EXPECT_EQ(blind->status, FrameReport::Status::lost);
  EXPECT_FALSE(blind->why.empty());

  Pose far = poses[2];
  far.translation() += Eigen::Vector3d{0.0, 0.0, 0.30};
  const auto jumped = r->process(frame_at(far), camera(), TrackingMode::icp, std::nullopt, executor);
  ASSERT_TRUE(jumped.ok());
  EXPECT_EQ(jumped->status, FrameReport::Status::lost) << jumped->why;
  EXPECT_TRUE(before.grid == r->map().content().grid);
  EXPECT_TRUE(last.matrix() == r->last_pose()->matrix());

  // A hint near the truth recovers.
  Pose hint = far;
  hint.translation() += Eigen::Vector3d{0.01, -0.01, 0.01};
  const auto recovered = r->process(frame_at(far), camera(), TrackingMode::hint, hint, executor);
  ASSERT_TRUE(recovered.ok());
  ASSERT_EQ(recovered->status, FrameReport::Status::fused) << recovered->why;
  EXPECT_LT((recovered->T_world_camera.translation() - far.translation()).norm(), 0.004);
}

TEST(Tracking, SuspendedFusionResumesFromAnotherPose) {
  const Executor executor = Executor::with_threads(2);
  auto r = reconstruction();
  ASSERT_TRUE(r.ok());
  const std::vector<Pose> poses = sample_trajectory(60);
  for (int i = 0; i < 20; i += 4) {
    ASSERT_TRUE(r->process(frame_at(poses[static_cast<std::size_t>(i)]), camera(), TrackingMode::forced,
                           poses[static_cast<std::size_t>(i)], executor)
                    .ok());
  }
  const TsdfSnapshot before = r->map().snapshot();
  r->suspend();
  const auto ignored = r->process(frame_at(poses[2]), camera(), TrackingMode::forced, poses[2], executor);
  ASSERT_TRUE(ignored.ok());
  EXPECT_EQ(ignored->status, FrameReport::Status::suspended);
  EXPECT_TRUE(before.grid == r->map().content().grid);

  Pose hint = poses[6];  // far from the last fused pose, near where the camera really is
  hint.translation() += Eigen::Vector3d{0.008, 0.008, -0.008};
  r->resume(hint);
  const auto resumed = r->process(frame_at(poses[6]), camera(), TrackingMode::icp, std::nullopt, executor);
  ASSERT_TRUE(resumed.ok());
  ASSERT_EQ(resumed->status, FrameReport::Status::fused) << resumed->why;
  EXPECT_LT((resumed->T_world_camera.translation() - poses[6].translation()).norm(), 0.004);
}

TEST(Tracking, ForcedPosesAreTakenAsTheyAreAndMustBeThere) {
  auto r = reconstruction();
  ASSERT_TRUE(r.ok());
  const Pose T_world_camera = sample_trajectory(5)[2];
  const auto report = r->process(frame_at(T_world_camera), camera(), TrackingMode::forced, T_world_camera, Executor{});
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->T_world_camera.matrix() == T_world_camera.matrix());
  const auto missing = r->process(frame_at(T_world_camera), camera(), TrackingMode::forced, std::nullopt, Executor{});
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
