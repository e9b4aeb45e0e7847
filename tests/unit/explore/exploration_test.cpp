// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/exploration.hpp"

#include <gtest/gtest.h>

#include "saccade/explore/metrics.hpp"
#include "saccade/scene/random_clutter.hpp"
#include "saccade/scene/simulated_camera.hpp"

namespace saccade {
namespace {

constexpr double kVoxel_m{0.012};

/// A clutter of four objects, seen by a small noisy camera.
class Explore : public ::testing::Test {
 protected:
  Explore() {
    SimulatedCameraConfig config;
    config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 3.0};
    camera_.emplace(*SimulatedCamera::create(rays(), config));
    exploration_.sphere.longitude_step_rad = 1.0471975511965976;
    exploration_.sphere.latitude_step_rad = 0.52359877559829887;
    exploration_.sphere.roll_step_rad = 1.5707963267948966;
    exploration_.sphere.radii_m = {1.0};
    exploration_.gain.sensor = config.camera;
    exploration_.min_gain = 20;
    exploration_.max_views = 6;
    exploration_.oscillation_frames = 3;
  }

  static const RayScene& rays() {
    static const RayScene built = *RayScene::build(random_clutter(5, 4));
    return built;
  }
  static const Truth& truth() {
    static const Truth made = *Truth::build(rays(), 0.006, Executor::with_threads(2));
    return made;
  }
  static TsdfMap empty_map() {
    TsdfConfig config;
    config.voxel_size_m = kVoxel_m;
    config.workspace = rays().scene().workspace;
    return *TsdfMap::create(config);
  }
  static double coverage(const TsdfMap& map) {
    return measure(truth(), map.content(), extract_mesh(map.content(), Executor{}), Executor{}).coverage;
  }

  ExplorationCell cell(Robot& robot) {
    return {camera_->camera(), [this](const Pose& pose) -> Result<Frame> { return camera_->capture(pose); }, robot};
  }
  /// Scans, then explores the whole workspace.
  ExplorationResult run(TsdfMap& map, Robot& robot, const std::function<bool(const ExploredView&)>& on_view = {}) {
    ExplorationCell here = cell(robot);
    EXPECT_TRUE(scan(map, here, {rays().scene().scan.front()}, exploration_, Executor{}));
    auto result = explore(map, here, {rays().scene().workspace}, exploration_, Executor{}, on_view);
    EXPECT_TRUE(result) << result.error().to_string();
    return *result;
  }

  ExplorationConfig exploration_;
  std::optional<SimulatedCamera> camera_;
};

TEST_F(Explore, EveryViewLeavesLessUnknownAndTheObjectsGetCovered) {
  FreeRobot robot;
  TsdfMap map = empty_map();
  std::size_t unknown = count_unknown(map.content(), rays().scene().workspace);
  const auto check = [&](const ExploredView& view) {
    const std::size_t left = count_unknown(map.content(), rays().scene().workspace);
    EXPECT_LT(left, unknown);
    EXPECT_GE(view.gain, exploration_.min_gain);
    EXPECT_GT(view.candidates, 50U);
    unknown = left;
    return true;
  };
  const ExplorationResult result = run(map, robot, check);
  EXPECT_GE(result.views.size(), 3U);
  TsdfMap scanned = empty_map();
  ExplorationCell here = cell(robot);
  ASSERT_TRUE(scan(scanned, here, {rays().scene().scan.front()}, exploration_, Executor{}));
  EXPECT_LT(coverage(scanned), 0.75);
  EXPECT_GT(coverage(map), 0.9);
}

TEST_F(Explore, ChoosingBeatsChance) {
  exploration_.max_views = 2;
  FreeRobot robot;
  TsdfMap chosen = empty_map();
  run(chosen, robot);
  const std::size_t left_by_choice = count_unknown(chosen.content(), rays().scene().workspace);
  exploration_.strategy = Strategy::random;
  double left_by_chance = 0.0;
  for (exploration_.seed = 1; exploration_.seed <= 5; ++exploration_.seed) {
    TsdfMap random = empty_map();
    EXPECT_EQ(run(random, robot).views.size(), 2U);
    left_by_chance += static_cast<double>(count_unknown(random.content(), rays().scene().workspace)) / 5.0;
  }
  EXPECT_LT(static_cast<double>(left_by_choice), left_by_chance);
}

TEST_F(Explore, SaysWhyItStops) {
  FreeRobot robot;
  exploration_.max_views = 1;
  TsdfMap used_up = empty_map();
  EXPECT_EQ(run(used_up, robot).stopped_because, StopReason::views_used_up);
  TsdfMap stopped = empty_map();
  exploration_.max_views = 6;
  const ExplorationResult cancelled = run(stopped, robot, [](const ExploredView&) { return false; });
  EXPECT_EQ(cancelled.stopped_because, StopReason::cancelled);
  EXPECT_EQ(cancelled.views.size(), 1U);
  exploration_.min_gain = 1'000'000'000;
  TsdfMap done = empty_map();
  const ExplorationResult nothing = run(done, robot);
  EXPECT_EQ(nothing.stopped_because, StopReason::regions_done);
  EXPECT_TRUE(nothing.views.empty());
}

/// Reaches nothing beyond a plane.
class FencedRobot final : public Robot {
 public:
  explicit FencedRobot(double max_y_m) : max_y_m_{max_y_m} {}
  [[nodiscard]] Result<bool> move_to(const Pose& T_world_camera) override {
    if (T_world_camera.translation().y() > max_y_m_) return false;
    positions.push_back(T_world_camera.translation());
    return true;
  }
  std::vector<Eigen::Vector3d> positions;

 private:
  double max_y_m_;
};

TEST_F(Explore, PosesOutOfReachArePassedOver) {
  FencedRobot front{-0.2};
  TsdfMap map = empty_map();
  const ExplorationResult result = run(map, front);
  EXPECT_GE(result.views.size(), 1U);
  for (const Eigen::Vector3d& p : front.positions) EXPECT_LE(p.y(), -0.2);
  FencedRobot nowhere{-100.0};
  TsdfMap untouched = empty_map();
  const ExplorationResult none = run(untouched, nowhere);
  EXPECT_TRUE(none.views.empty());
  EXPECT_EQ(none.stopped_because, StopReason::no_candidate);
}

TEST_F(Explore, RefusesNonsense) {
  FreeRobot robot;
  TsdfMap map = empty_map();
  ExplorationCell here = cell(robot);
  exploration_.oscillation_frames = 0;
  EXPECT_FALSE(explore(map, here, {rays().scene().workspace}, exploration_, Executor{}));
}

}  // namespace
}  // namespace saccade
