// SPDX-License-Identifier: Apache-2.0
// RgbdTracker on rendered hand-held sequences: fast motion, a loss, frames without colours.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "saccade/scene/place_scenes.hpp"
#include "saccade/scene/rendered_sequence.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/tracking/reconstruction.hpp"
#include "saccade/tracking/surfel_surface.hpp"
#include "saccade/tracking/trajectory_error.hpp"

namespace saccade {
namespace {

constexpr int kFrames{14};
constexpr std::size_t kWholePath{120};  ///< frames in which the whole path is fast: 11 cm and 4.5° between two

struct Sequence {
  PinholeCamera camera;
  std::vector<Frame> frames;
  std::vector<Pose> truth;

  /// Renders the views of a sensor, with its noise.
  Sequence(const Scene& scene, const std::vector<Pose>& poses, RenderedSequenceConfig config, int width) {
    config.pose_noise.reset();
    const double scale = static_cast<double>(width) / config.camera.width;
    camera = config.camera;
    camera = {width,
              3 * width / 4,
              camera.fx * scale,
              camera.fy * scale,
              (width - 1) / 2.0,
              (3 * width / 4 - 1) / 2.0,
              camera.min_range_m,
              camera.max_range_m};
    config.camera = camera;
    auto source =
        RenderedSequence::create(RayScene::build(scene).value(), poses, config, Executor::with_threads(2)).value();
    while (auto frame = source.next().value()) {
      frames.push_back(std::move(*frame));
      truth.push_back(source.truth().T_world_camera);
    }
  }
};

/// The first frames of a fast path around the desk. Rendered once.
const Sequence& sequence() {
  static const Sequence rendered = [] {
    const SurfelScene scene = surfel_scene("desk").value();
    RenderedSequenceConfig config = surfel_sensor(scene.sensor).value();
    config.color = scene.color;
    std::vector<Pose> poses = hand_held_poses(scene.path, kWholePath);
    poses.resize(kFrames);
    return Sequence{scene.scene, poses, config, 160};
  }();
  return rendered;
}

struct Tracked {
  std::vector<FrameReport> reports;
  std::vector<Pose> poses, truth;  ///< those of frames that were not lost
  [[nodiscard]] std::size_t lost() const { return reports.size() - poses.size(); }
  [[nodiscard]] double error_m() const { return trajectory_error(poses, truth).value().aligned_rmse_m; }
};

Tracked track(Reconstruction& reconstruction, TrackingMode mode, const std::vector<Frame>& frames,
              const Executor& executor = Executor::with_threads(2)) {
  Tracked tracked;
  for (const Frame& frame : frames) {
    const Pose& truth = sequence().truth[frame.index];
    const FrameReport report = reconstruction.process(frame, sequence().camera, mode, truth, executor).value();
    tracked.reports.push_back(report);
    if (report.status != FrameReport::Status::fused) continue;
    tracked.poses.push_back(report.T_world_camera);
    tracked.truth.push_back(truth);
  }
  return tracked;
}

Tracked track(TrackingMode mode, const std::vector<Frame>& frames,
              const Executor& executor = Executor::with_threads(2)) {
  Reconstruction reconstruction = Reconstruction::create({}).value();
  return track(reconstruction, mode, frames, executor);
}

TEST(RgbdTracker, FollowsFastMotionThatIcpDoesNot) {
  const Tracked rgbd = track(TrackingMode::rgbd, sequence().frames);
  const Tracked icp = track(TrackingMode::icp, sequence().frames);
  EXPECT_EQ(rgbd.lost(), 0U);
  EXPECT_LT(rgbd.error_m(), 0.004);
  EXPECT_GT(icp.error_m(), 2.0 * rgbd.error_m());
  for (std::size_t i = 1; i < rgbd.reports.size(); ++i) {
    EXPECT_TRUE(rgbd.reports[i].used_color);
    EXPECT_GT(rgbd.reports[i].color_agreement, 0.6);
    ASSERT_TRUE(rgbd.reports[i].confidence);
    EXPECT_GT(*rgbd.reports[i].confidence, 0.3);
  }
}

TEST(RgbdTracker, IsNotDrawnAlongARowOfEqualBays) {
  const PlaceScene bays = place_scene("alike:7").value();
  std::vector<Pose> poses = carried_poses(bays.path, bays.frames);
  poses.resize(25);
  const Sequence passing{bays.scene, poses, surfel_sensor("xtion").value(), 120};
  const auto last_error_m = [&](const RgbdTrackerConfig& rgbd) {
    ReconstructionConfig config;
    config.map.voxel_size_m = 0.02;
    config.rgbd = rgbd;
    Reconstruction reconstruction = Reconstruction::create(config).value();
    Pose found{Pose::Identity()};
    for (std::size_t i = 0; i < poses.size(); ++i) {
      found = reconstruction
                  .process(passing.frames[i], passing.camera, TrackingMode::rgbd, passing.truth[i],
                           Executor::with_threads(2))
                  .value()
                  .T_world_camera;
    }
    return (found.translation() - passing.truth.back().translation()).norm();
  };
  RgbdTrackerConfig without_doubt;
  without_doubt.least_doubt = without_doubt.most_doubt = 1.0;
  EXPECT_LT(last_error_m({}), 0.03);
  EXPECT_GT(last_error_m(without_doubt), 0.1) << "pairs far apart lead to the next bay";
}

TEST(RgbdTracker, ThreadsNeverChangeABit) {
  std::vector<Frame> some{sequence().frames.begin(), sequence().frames.begin() + 4};
  const Tracked one = track(TrackingMode::rgbd, some, Executor{});
  const Tracked seven = track(TrackingMode::rgbd, some, Executor::with_threads(7));
  ASSERT_EQ(one.lost() + seven.lost(), 0U);
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_TRUE(one.poses[i].matrix() == seven.poses[i].matrix()) << i;
}

TEST(RgbdTracker, FramesWithoutColoursAreTrackedByDepthAlone) {
  std::vector<Frame> grey = sequence().frames;
  for (Frame& frame : grey) frame.color.reset();
  const Tracked tracked = track(TrackingMode::rgbd, grey);
  EXPECT_EQ(tracked.lost(), 0U);
  EXPECT_LT(tracked.error_m(), 0.03);
  for (const FrameReport& report : tracked.reports) EXPECT_FALSE(report.used_color);
}

TEST(RgbdTracker, IsFoundAgainAfterAJumpBack) {
  Reconstruction reconstruction = Reconstruction::create({}).value();
  ASSERT_EQ(track(reconstruction, TrackingMode::rgbd, sequence().frames).lost(), 0U);
  std::vector<Frame> after(1);
  after[0].depth = DepthImage{160, 120};  // the lens is covered
  const Tracked covered = track(reconstruction, TrackingMode::rgbd, after);
  EXPECT_EQ(covered.lost(), 1U);
  EXPECT_EQ(covered.reports[0].confidence, 0.0);

  after[0] = sequence().frames[1];  // and then the camera is back near the start, half a metre away
  ASSERT_GT((sequence().truth[1].translation() - sequence().truth.back().translation()).norm(), 0.3);
  const Tracked back = track(reconstruction, TrackingMode::rgbd, after);
  ASSERT_EQ(back.lost(), 0U) << back.reports[0].why;
  EXPECT_TRUE(back.reports[0].relocalised);
  EXPECT_LT((back.poses[0].translation() - back.truth[0].translation()).norm(), 0.01);
}

TEST(RgbdTracker, FollowsBeforeSurfels) {
  SurfelFusion fusion = SurfelFusion::create().value();
  RgbdTracker tracker;
  const Executor executor = Executor::with_threads(2);
  std::vector<Pose> poses;
  for (Frame frame : sequence().frames) {
    frame.T_world_camera = sequence().truth[0];
    if (!poses.empty()) {
      const SurfaceAt surface = surface_of_surfels(fusion.map(), sequence().camera, executor);
      const FrameReport report = tracker.track(surface, frame, sequence().camera, executor).value();
      ASSERT_EQ(report.status, FrameReport::Status::fused) << frame.name << ": " << report.why;
      frame.T_world_camera = report.T_world_camera;
    }
    ASSERT_TRUE(fusion.add_frame(frame, sequence().camera, executor).ok());
    tracker.fused(frame, sequence().camera, *frame.T_world_camera, executor);
    poses.push_back(*frame.T_world_camera);
  }
  EXPECT_LT(trajectory_error(poses, sequence().truth).value().aligned_rmse_m, 0.01);
}

TEST(RgbdTracker, RefusesImagesOfOtherSizes) {
  Frame frame = sequence().frames[0];
  frame.color = ColorImage{8, 8};
  RgbdTracker tracker;
  const TsdfMap map = TsdfMap::create({}).value();
  const auto report =
      tracker.track(surface_of_map(map.content(), sequence().camera, Executor{}), frame, sequence().camera, Executor{});
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().code, Errc::size_mismatch);
}

TEST(TrackingConfidence, IsTheLeastOfItsParts) {
  const IcpConfig config;
  IcpResult found;
  found.converged = true;
  found.agreement = 0.88;  // halfway from 0.78 to 0.98
  found.inlier_share = 0.9;
  found.constraint = 1.0;
  EXPECT_NEAR(tracking_confidence(found, config), 0.5, 1e-9);
  found.constraint = 2e-5;
  EXPECT_NEAR(tracking_confidence(found, config), std::log(2.0) / std::log(100.0), 1e-9);
  found.converged = false;
  EXPECT_EQ(tracking_confidence(found, config), 0.0);
}

}  // namespace
}  // namespace saccade
