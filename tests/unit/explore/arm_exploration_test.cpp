// SPDX-License-Identifier: Apache-2.0
// An arm in the loop: what it plans with is what it has seen, and it touches nothing that is really there.
#include <gtest/gtest.h>

#include "saccade/explore/exploration.hpp"
#include "saccade/explore/simulated_run.hpp"
#include "saccade/io/scene_yaml.hpp"
#include "saccade/io/urdf.hpp"
#include "saccade/scene/random_clutter.hpp"
#include "saccade/scene/solids.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

/// Hands everything on to an arm, and keeps the motions.
class WatchedRobot final : public Robot {
 public:
  explicit WatchedRobot(SimulatedRobot& arm) : arm_{arm} {}
  [[nodiscard]] std::optional<Configuration> configuration() const override { return arm_.configuration(); }
  [[nodiscard]] Status follow(const TsdfSnapshot& map, const Executor& executor) override {
    return arm_.follow(map, executor);
  }
  [[nodiscard]] Result<std::vector<Box>> swept_by(std::span<const Pose> poses) override { return arm_.swept_by(poses); }
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> poses,
                                                         const Executor& executor) const override {
    return arm_.test(poses, executor);
  }
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> poses, Way way) override {
    return arm_.plan(poses, way);
  }
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& on_way) override {
    motions.push_back(motion.trajectory);
    return arm_.execute(motion, on_way);
  }
  std::vector<Trajectory> motions;

 private:
  SimulatedRobot& arm_;
};

struct Explored {
  ExplorationResult result;
  ScanResult scan;
  std::vector<Trajectory> motions;
  TsdfSnapshot map;
};

Explored explore_with_arm(const RayScene& rays, std::uint64_t seed, std::size_t threads, int max_views = 4,
                          double good_enough = 1.0) {
  SimulatedRunConfig config;
  config.voxel_size_m = 0.01;
  config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.5, 2.0};
  config.gain_width_px = 80;
  config.sphere.roll_step_rad = 1.5707963267948966;
  config.exploration.min_gain = 20;
  config.exploration.max_views = max_views;
  config.exploration.oscillation_frames = 3;
  config.exploration.good_enough = good_enough;
  config.seed = seed;
  TsdfConfig map_config = config.map();
  map_config.workspace = rays.scene().workspace;
  TsdfMap map = TsdfMap::create(map_config).value();
  SimulatedCamera camera = simulated_camera(rays, config).value();
  ArmRobotConfig arm;
  arm.planner.seed = seed;
  SimulatedRobot robot = simulated_arm(find_robot("comau").value().arm, rays.scene(), config, arm).value();
  WatchedRobot watched{robot};
  const Executor executor = Executor::with_threads(threads);
  ExplorationCell cell{config.camera, [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose, executor); },
                       watched};
  Explored explored;
  explored.scan = scan(map, cell, rays.scene().scan, config.exploration, executor).value();
  const std::vector<Region> regions = regions_of(rays.scene());
  explored.result =
      explore(map, cell, regions, *make_strategy(config, config.camera, regions.size()), config.exploration, executor)
          .value();
  explored.motions = std::move(watched.motions);
  explored.map = map.content();
  return explored;
}

double coverage_of(const Explored& explored, const RayScene& rays) {
  const Executor executor = Executor::with_threads(2);
  return measure_map(Truth::build(rays, 0.008, executor).value(), explored.map, executor).metrics.coverage;
}

const RayScene& clutter() {
  static const RayScene rays = RayScene::build(random_clutter(5, 4)).value();
  return rays;
}

/// Expects the arm to be apart from everything in the scene along the motions; how many covers of links were looked at.
std::size_t expect_apart(const std::vector<Trajectory>& motions, const RayScene& rays) {
  static const ArmModel arm = find_robot("comau").value().arm;
  static const ArmCollision collision = ArmCollision::create(arm).value();
  constexpr double kBelieved_m{0.005};  // balls may exceed the links by this
  const Solids solids = Solids::build(rays, [](const SceneObject&) { return true; }).value();
  std::size_t looked_at = 0;
  for (const Trajectory& motion : motions) {
    for (double t_s = 0.0; t_s < motion.duration_s(); t_s += 0.03) {
      const ArmPoses poses = forward_kinematics(arm, motion.at(t_s).q);
      for (int link = 1; link <= arm.dof(); ++link) {
        for (const SphereTree& cover : collision.cover(link)) {
          const bool apart = cover.clear([&](const TreeBall& ball) {
            const Eigen::Vector3d center =
                poses.T_world_link[static_cast<std::size_t>(link)] * ball.center.cast<double>();
            const double radius_m = static_cast<double>(ball.radius_m) - (ball.finest ? kBelieved_m : 0.0);
            return radius_m <= 0.0 ||
                   (solids.distance_m(center, 2.0 * radius_m) >= radius_m && !solids.contain(center));
          });
          EXPECT_TRUE(apart) << "link " << link << " at " << t_s << " s";
          ++looked_at;
        }
      }
    }
  }
  return looked_at;
}

TEST(ArmExploration, TouchesNothingThatIsThere) {
  for (int seed = 1; seed <= (test::kSanitized ? 1 : 2); ++seed) {
    const RayScene rays = RayScene::build(random_clutter(static_cast<std::uint64_t>(4 + seed), 4)).value();
    const Explored explored = explore_with_arm(rays, static_cast<std::uint64_t>(seed), 2);
    ASSERT_GE(explored.result.views.size(), 3U);
    EXPECT_GE(coverage_of(explored, rays), 0.7);
    EXPECT_GT(expect_apart(explored.motions, rays), 1000U);
  }
}

// What the arm sweeps during a scan is taken to be empty, so the scan itself must keep clear of the objects.
TEST(ArmExploration, TheScanBeforeATaskShowsTheTableAndTouchesNothing) {
  for (const char* name : {"bottle-before", "jug-before"}) {
    const RayScene rays = RayScene::build(find_scene(name).value()).value();
    for (std::uint64_t seed = 1; seed <= (test::kSanitized ? 1 : 2); ++seed) {
      const Explored explored = explore_with_arm(rays, seed, 2, 0);
      EXPECT_EQ(explored.scan.views, rays.scene().scan.size()) << name << ", seed " << seed;
      EXPECT_GE(coverage_of(explored, rays), 0.9) << name;
      EXPECT_GT(expect_apart(explored.motions, rays), 1000U);
    }
  }
}

TEST(ArmExploration, SaysWhatItRefusedAndHowItMoved) {
  const Explored explored = explore_with_arm(clutter(), 1, 2);
  EXPECT_EQ(explored.scan.views + explored.scan.refused.total(), clutter().scene().scan.size());
  for (const ExploredView& view : explored.result.views) {
    EXPECT_EQ(view.candidates, 480U);
    EXPECT_GT(view.refused.of(Refusal::no_ik) + view.refused.of(Refusal::outside_limits), 0U);
    EXPECT_LT(view.refused.total(), view.candidates);
    EXPECT_EQ(view.frames, 3U);
    EXPECT_GE(view.tilt.greatest_rad - view.tilt.least_rad, ExplorationConfig{}.oscillation_rad);
    ASSERT_TRUE(view.q);
    EXPECT_LT((camera_pose(find_robot("comau").value().arm, *view.q).matrix() - view.T_world_camera.matrix()).norm(),
              1e-6);
    EXPECT_GT(view.motion_s, 0.0);
    ASSERT_GE(view.path.size(), 2U);
    EXPECT_LT((view.path.back() - view.T_world_camera.translation()).norm(), 1e-6);
  }
}

TEST(ArmExploration, IsTheSameForEveryThreadCount) {
  const Explored one = explore_with_arm(clutter(), 3, 1);
  const Explored two = explore_with_arm(clutter(), 3, 2);
  ASSERT_EQ(one.motions.size(), two.motions.size());
  for (std::size_t i = 0; i < one.motions.size(); ++i) {
    EXPECT_EQ(one.motions[i].duration_s(), two.motions[i].duration_s());
    EXPECT_EQ(one.motions[i].end(), two.motions[i].end());
  }
  for (const Region& region : regions_of(clutter().scene())) {
    EXPECT_EQ(count_unknown(one.map, region), count_unknown(two.map, region));
  }
}

TEST(ArmExploration, AmongViewsThatAreAsGoodTheSoonestIsTaken) {
  const Explored best = explore_with_arm(clutter(), 1, 2, 1);
  const Explored near = explore_with_arm(clutter(), 1, 2, 1, 0.7);
  ASSERT_FALSE(best.result.views.empty());
  ASSERT_FALSE(near.result.views.empty());
  EXPECT_GE(near.result.views[0].gain, 0.7 * best.result.views[0].gain);
  EXPECT_LE(near.motions.front().duration_s(), best.motions.front().duration_s() + 1e-9);
  EXPECT_LE(near.result.views[0].motion_s, best.result.views[0].motion_s + 1.0);
}

}  // namespace
}  // namespace saccade
