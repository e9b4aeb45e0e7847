// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/loop_closer.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "../../support/carried_camera.hpp"
#include "saccade/loops/background_loops.hpp"

namespace saccade {
namespace {

TsdfConfig coarse_map() {
  TsdfConfig map;
  map.voxel_size_m = 0.015;
  map.color = false;
  return map;
}

/// A camera that turns once and a little more. Its poses drift by some centimetres.
const tests::CarriedCamera& returning() {
  static const tests::CarriedCamera camera{"loop:2", 120, 0.04, 1.0_deg};
  return camera;
}

/// A camera that never comes back, in a room of four equal walls.
const tests::CarriedCamera& among_equal_walls() {
  static const tests::CarriedCamera camera{"alike:2", 90, 0.03, 0.7_deg};
  return camera;
}

ReadFrame reader(const tests::CarriedCamera& carried) {
  return [&carried](std::size_t index) -> Result<Frame> { return carried.frames.at(index); };
}

LoopCloser closed(const tests::CarriedCamera& carried, const LoopConfig& config, std::size_t threads = 1) {
  const Executor executor = Executor::with_threads(threads);
  LoopCloser closer = LoopCloser::create(carried.camera, coarse_map(), reader(carried), config).value();
  for (std::size_t i = 0; i < carried.frames.size(); ++i) {
    EXPECT_TRUE(closer.add({i, carried.T_world_drifted[i]}, executor));
  }
  EXPECT_TRUE(closer.finish(executor));
  return closer;
}

class LoopClosing : public testing::Test {
  void SetUp() override {
    if (pose_graph_solver().empty()) GTEST_SKIP() << "this build lacks libceres-dev";
  }
};

TEST_F(LoopClosing, AWayThatReturnsEndsNearTheTruth) {
  const tests::CarriedCamera& carried = returning();
  const LoopCloser closer = closed(carried, {});
  EXPECT_GE(closer.counts().closed, 3U);
  EXPECT_EQ(closer.closures().size(), closer.counts().closed);
  const double before = carried.end_error_m(carried.T_world_drifted);
  const double after = carried.end_error_m(closer.poses());
  EXPECT_GT(before, 0.02);
  EXPECT_LT(after, 0.005) << "before: " << before;
  for (const Closure& closure : closer.closures()) {
    const Pose T_true = carried.T_world_true[closure.from].inverse() * carried.T_world_true[closure.to];
    EXPECT_LT((T_true.inverse() * closure.T_from_to).translation().norm(), 0.01) << closure.from << ' ' << closure.to;
    EXPECT_LT(closure.from, closure.to);
  }
  ASSERT_EQ(closer.poses().size(), carried.frames.size());
  EXPECT_TRUE(closer.poses().front().isApprox(carried.T_world_drifted.front(), 1e-12));
}

TEST_F(LoopClosing, PlacesThatLookAlikeAreNotTakenForOneAnother) {
  const LoopCloser closer = closed(among_equal_walls(), {});
  EXPECT_GT(closer.counts().rejected_by_odometry, 3U);  // ICP is content with these
  EXPECT_EQ(closer.counts().closed, 0U);
  const std::vector<Pose> poses = closer.poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((poses[i].translation() - among_equal_walls().T_world_drifted[i].translation()).norm(), 1e-9);
  }
  LoopConfig credulous;  // without the drift model it is the pose graph that has to tell
  credulous.max_sigmas = 1e6;
  const LoopCounts fooled = closed(among_equal_walls(), credulous).counts();
  EXPECT_EQ(fooled.rejected_by_odometry, 0U);
  EXPECT_GT(fooled.closed + fooled.dropped, 3U);
}

TEST_F(LoopClosing, OneClosureAloneIsNotBelieved) {
  LoopConfig strict;
  strict.confirm_m = 1e-7;
  strict.confirm_rad = 1e-9;
  const LoopCloser closer = closed(returning(), strict);
  EXPECT_EQ(closer.counts().closed, 0U);
  EXPECT_GT(closer.counts().rejected_alone, 0U);
}

TEST_F(LoopClosing, ThreadsChangeNoBit) {
  const std::vector<Pose> one = closed(returning(), {}, 1).poses();
  const std::vector<Pose> two = closed(returning(), {}, 2).poses();
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].matrix(), two[i].matrix()) << i;
}

TEST_F(LoopClosing, AMissingFrameIsAnError) {
  LoopCloser closer = LoopCloser::create(returning().camera, coarse_map(), [](std::size_t) -> Result<Frame> {
                        return Error{Errc::not_found, "gone", "frame 0"};
                      }).value();
  EXPECT_EQ(closer.add({0, Pose::Identity()}, {}).error().message, "gone");
  LoopConfig bad;
  bad.drift.floor_m = 0.0;
  EXPECT_EQ(LoopCloser::create(returning().camera, coarse_map(), reader(returning()), bad).error().code,
            Errc::invalid_argument);
}

TEST_F(LoopClosing, InTheBackgroundTheMapIsExchanged) {
  const tests::CarriedCamera& carried = returning();
  const ReadFrame read = reader(carried);
  BackgroundLoops loops{LoopCloser::create(carried.camera, coarse_map(), read).value(), coarse_map(), carried.camera,
                        read};
  Reconstruction reconstruction = Reconstruction::create({coarse_map(), {}}).value();
  const Executor executor;
  bool exchanged{false};
  const auto fuse = [&](std::size_t i) {
    exchanged = loops.correct(reconstruction) || exchanged;
    const Pose T_step =
        i == 0 ? carried.T_world_drifted[0] : carried.T_world_drifted[i - 1].inverse() * carried.T_world_drifted[i];
    const Pose T_world_camera = reconstruction.last_pose().value_or(Pose::Identity()) * T_step;
    const Frame& frame = carried.frames[i];
    ASSERT_TRUE(reconstruction.process(frame, carried.camera, TrackingMode::forced, T_world_camera, executor));
    loops.fused(T_world_camera, frame);
  };
  for (std::size_t i = 0; i < carried.frames.size(); ++i) fuse(i);
  for (int wait = 0; wait < 6000 && !exchanged; ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
    exchanged = loops.correct(reconstruction);
  }
  ASSERT_TRUE(exchanged);
  EXPECT_LT((reconstruction.last_pose()->translation() - carried.T_world_true.back().translation()).norm(), 0.01);
  EXPECT_GT(reconstruction.map().content().grid.usage().bricks(), 100U);
  const std::vector<Pose> in_map = loops.poses_in_map();  // along which the frames give this map
  ASSERT_EQ(in_map.size(), carried.frames.size());
  EXPECT_EQ(in_map.back().matrix(), reconstruction.last_pose()->matrix());
  TsdfMap again = TsdfMap::create(coarse_map()).value();
  for (std::size_t i = 0; i < in_map.size(); ++i) {
    ASSERT_TRUE(again.integrate(carried.camera, carried.frames[i].depth, in_map[i], executor));
  }
  EXPECT_EQ(again.content().grid.usage().dense_bricks, reconstruction.map().content().grid.usage().dense_bricks);
  const Status finished = loops.finish();
  ASSERT_TRUE(finished) << finished.error().to_string();
  EXPECT_LT(carried.end_error_m(loops.poses()), 0.005);
  EXPECT_GE(loops.counts().closed, 3U);
}

TEST_F(LoopClosing, TheBackgroundTellsWhatWentWrong) {
  const ReadFrame read = [](std::size_t) -> Result<Frame> { return Error{Errc::not_found, "gone", {}}; };
  BackgroundLoops loops{LoopCloser::create(returning().camera, coarse_map(), read).value(), coarse_map(),
                        returning().camera, read};
  loops.fused(Pose::Identity(), returning().frames[0]);
  EXPECT_EQ(loops.finish().error().message, "gone");
}

TEST(LoopClosingWithoutSolver, IsUnavailable) {
  if (!pose_graph_solver().empty()) GTEST_SKIP() << "this build has Ceres";
  const auto closer = LoopCloser::create(PinholeCamera{}, coarse_map(), {});
  EXPECT_EQ(closer.error().code, Errc::unavailable);
}

}  // namespace
}  // namespace saccade
