// SPDX-License-Identifier: Apache-2.0
// An arm in the loop: what it plans with is what it has seen, and it touches nothing that is really there.
#include <gtest/gtest.h>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/explore/explorer.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/metrics.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

struct Explored {
  RunRecord result;
  ScanRecord scan;
  std::vector<Trajectory> motions;
  TsdfSnapshot map;
};

Explored explore_with_arm(const RayScene& rays, std::uint64_t seed, std::size_t threads, int max_views = 4,
                          double good_enough = 1.0) {
  SimulatedRunConfig config;
  config.voxel_size_m = 0.01;
  config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.5, 2.0};
  config.strategy = builtin_planners().find("sphere").value();
  config.gain_width_px = 80;
  config.sphere.roll_step_rad = 1.5707963267948966;
  config.planner.min_gain = 20;
  config.exploration.max_views = max_views;
  config.exploration.oscillation_frames = 3;
  config.exploration.good_enough = good_enough;
  config.seed = seed;
  TsdfConfig map_config = config.map();
  map_config.workspace = rays.scene().workspace;
  TsdfMap map = TsdfMap::create(map_config).value();
  SimulatedCamera camera = simulated_camera(rays, config).value();
  PlannedArmConfig arm;
  arm.planner.seed = seed;
  PlannedArm robot = planned_arm(find_robot("comau").value().arm, rays.scene(), config, arm).value();
  const Executor executor = Executor::with_threads(threads);
  FunctionCamera sensor{config.camera,
                        [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose, executor); }};
  Explorer explorer{{map, sensor, robot, executor}, config.exploration};
  Explored explored;
  explored.scan = explorer.scan(rays.scene().scan).value();
  ViewPlanner planner = make_planner(config, config.camera, regions_of(rays.scene(), config.strategy));
  explored.result = explorer.explore(planner).value();
  explored.motions = robot.motions();
  explored.map = map.content();
  return explored;
}

double coverage_of(const Explored& explored, const RayScene& rays) {
  const Executor executor = Executor::with_threads(2);
  return measure_map(GroundTruth::build(rays, 0.008, executor).value(), explored.map, executor).coverage.value();
}

const RayScene& clutter() {
  static const RayScene rays = RayScene::build(random_clutter(5, 4)).value();
  return rays;
}

/// Instants of the motions at which the arm touches something of the scene.
std::size_t contacts_of(const std::vector<Trajectory>& motions, const RayScene& rays) {
  static const ArmCollision collision = ArmCollision::create(find_robot("comau").value().arm).value();
  const Solids solids = Solids::build(rays, [](const SceneObject&) { return true; }).value();
  return count_contacts(collision, solids, motions, Executor::with_threads(2));
}

TEST(ArmExploration, TouchesNothingThatIsThere) {
  for (int seed = 1; seed <= (test::kSanitized ? 1 : 2); ++seed) {
    const RayScene rays = RayScene::build(random_clutter(static_cast<std::uint64_t>(4 + seed), 4)).value();
    const Explored explored = explore_with_arm(rays, static_cast<std::uint64_t>(seed), 2);
    ASSERT_GE(explored.result.views.size(), 3U);
    EXPECT_GE(coverage_of(explored, rays), 0.7);
    EXPECT_EQ(contacts_of(explored.motions, rays), 0U);
  }
}

TEST(ArmExploration, AnArmThatReachesIntoTheTableTouchesIt) {
  const ArmModel arm = find_robot("comau").value().arm;
  const Pose above = look_at(Eigen::Vector3d{-0.1, -0.1, 0.5}, Eigen::Vector3d{-0.1, -0.1, 0.0});
  const Pose below = Eigen::Translation3d{0.0, 0.0, -0.54} * above;
  const InverseKinematics ik = InverseKinematics::create(arm).value();
  const std::vector<Configuration> from = ik.solve(above);
  ASSERT_FALSE(from.empty());
  const std::vector<Configuration> to = ik.solve(below, from.front());
  ASSERT_FALSE(to.empty());
  EXPECT_GT(contacts_of({parametrise(arm, {from.front(), to.front()})}, clutter()), 0U);
}

// The volume swept during a scan is taken to be empty, so the scan itself must keep clear of the objects.
TEST(ArmExploration, TheScanBeforeATaskShowsTheTableAndTouchesNothing) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  for (const char* name : {"bottle-before", "jug-before"}) {
    const RayScene rays = RayScene::build(find_scene(name).value()).value();
    for (std::uint64_t seed = 1; seed <= (test::kSanitized ? 1 : 2); ++seed) {
      const Explored explored = explore_with_arm(rays, seed, 2, 0);
      EXPECT_EQ(explored.scan.views, rays.scene().scan.size()) << name << ", seed " << seed;
      EXPECT_GE(coverage_of(explored, rays), 0.9) << name;
      EXPECT_EQ(contacts_of(explored.motions, rays), 0U) << name << ", seed " << seed;
    }
  }
}

TEST(ArmExploration, SaysWhatItRefusedAndHowItMoved) {
  const Explored explored = explore_with_arm(clutter(), 1, 2);
  EXPECT_EQ(explored.scan.views + explored.scan.refused.total(), clutter().scene().scan.size());
  for (const ViewRecord& view : explored.result.views) {
    EXPECT_EQ(view.candidates, 480U);
    EXPECT_GT(view.refused.of(Refusal::no_ik) + view.refused.of(Refusal::outside_limits), 0U);
    EXPECT_LT(view.refused.total(), view.candidates);
    EXPECT_EQ(view.frames, 3U);
    EXPECT_GE(view.tilt.greatest_rad - view.tilt.least_rad, ExplorerConfig{}.oscillation_rad);
    ASSERT_TRUE(view.q);
    EXPECT_LT((camera_pose(find_robot("comau").value().arm, *view.q).matrix() - view.T_world_camera.matrix()).norm(),
              1e-6);
    EXPECT_GT(view.motion_s, 0.0);
    ASSERT_GE(view.path.size(), 2U);
    EXPECT_LT((view.path.back() - view.T_world_camera.translation()).norm(), 1e-6);
  }
}

TEST(ArmExploration, IsTheSameForEveryThreadCount) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  const Explored one = explore_with_arm(clutter(), 3, 1);
  const Explored two = explore_with_arm(clutter(), 3, 2);
  ASSERT_EQ(one.motions.size(), two.motions.size());
  for (std::size_t i = 0; i < one.motions.size(); ++i) {
    EXPECT_EQ(one.motions[i].duration_s(), two.motions[i].duration_s());
    EXPECT_EQ(one.motions[i].end(), two.motions[i].end());
  }
  for (const Region& region : clutter().scene().regions) {
    EXPECT_EQ(count_unknown(one.map, region), count_unknown(two.map, region));
  }
}

TEST(ArmExploration, AmongViewsThatAreAsGoodTheSoonestIsTaken) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  const Explored best = explore_with_arm(clutter(), 1, 2, 1);
  const Explored near = explore_with_arm(clutter(), 1, 2, 1, 0.7);
  ASSERT_FALSE(best.result.views.empty());
  ASSERT_FALSE(near.result.views.empty());
  EXPECT_GE(near.result.views[0].gain_predicted, 0.7 * best.result.views[0].gain_predicted);
  EXPECT_LE(near.motions.front().duration_s(), best.motions.front().duration_s() + 1e-9);
  EXPECT_LE(near.result.views[0].motion_s, best.result.views[0].motion_s + 1.0);
}

}  // namespace
}  // namespace saccade
