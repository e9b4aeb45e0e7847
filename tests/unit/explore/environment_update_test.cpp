// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/environment_update.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr double kVoxelOfUpdate_m{0.012};

std::vector<RegionOfInterest> spheres(const std::vector<Eigen::Vector3d>& centers, double radius_m = 0.15) {
  std::vector<HandAction> actions;
  for (const Eigen::Vector3d& center : centers) actions.push_back({center, 0.0, 1.0, "a test"});
  return regions_of_interest(actions, radius_m).value();
}

/// Reaches what lies on one side alone.
class OneSidedRobot final : public Robot {
 public:
  explicit OneSidedRobot(double least_x_m) : least_x_m_{least_x_m} {}
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, MotionKind /*way*/) override {
    for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
      if (T_world_camera[i].translation().x() < least_x_m_) continue;
      return PlannedMotion{Motion{i, T_world_camera[i], {}}, {}, ""};
    }
    return PlannedMotion{{}, Refusal::no_path, "the other side"};
  }
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion,
                                                       const MotionObserver& /*on_way*/) override {
    return std::optional{Arrival{motion.T_world_camera, 0.0}};
  }

 private:
  double least_x_m_;
};

/// A clutter of four objects that a small camera has seen from above, before something may have changed.
class EnvironmentUpdate : public ::testing::Test {
 protected:
  EnvironmentUpdate() {
    SimulatedCameraConfig config;
    config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 3.0};
    camera_.emplace(*SimulatedCamera::create(rays(), config));
    sphere_.longitude_step_rad = 1.0471975511965976;
    sphere_.latitude_step_rad = 0.52359877559829887;
    sphere_.roll_step_rad = 1.5707963267948966;
    gain_.sensor = config.camera;
    planner_.min_gain = 30;
    exploration_.max_views = 12;
    exploration_.oscillation_frames = 3;
  }

  static const RayScene& rays() {
    static const RayScene built = *RayScene::build(random_clutter(5, 4));
    return built;
  }
  static TsdfConfig map_config() {
    TsdfConfig config;
    config.voxel_size_m = kVoxelOfUpdate_m;
    config.workspace = rays().scene().workspace;
    return config;
  }

  FunctionCamera camera() {
    return FunctionCamera{camera_->camera(), [this](const Pose& pose) -> Result<Frame> {
                            seen_from_.push_back(pose);
                            return camera_->capture(pose);
                          }};
  }
  ViewPlanner planner() const {
    PlannerSetup setup;
    setup.sphere = sphere_;
    setup.gain = gain_;
    setup.planner = planner_;
    return ViewPlanner{builtin_planners().find("sphere")->make(setup)};
  }

  TsdfMap scanned() {
    TsdfMap map = *TsdfMap::create(map_config());
    FreeRobot robot;
    std::vector<Pose> around;
    for (const double x : {-0.8, 0.0, 0.8}) {
      for (const double y : {-0.7, 0.7})
        around.push_back(look_at(Eigen::Vector3d{x, y, 0.9}, Eigen::Vector3d{0, 0, 0}));
    }
    FunctionCamera camera = this->camera();
    const Executor executor;
    EXPECT_TRUE((Explorer{{map, camera, robot, executor}, exploration_}.scan(around)->complete));
    seen_from_.clear();
    return map;
  }

  /// Explorer::update, with what is unknown of the regions.
  struct Updated {
    RunRecord run;
    UnknownOfRegions unknown_after_task;
    std::vector<UnknownOfRegions> unknown_after_view;
  };
  Updated update(TsdfMap& map, Robot& robot, std::span<const RegionOfInterest> regions, Recorder* also = nullptr,
                 const Progress* progress = nullptr) {
    FunctionCamera camera = this->camera();
    const Executor executor;
    RegionMeter meter{regions};
    Recorder silent;
    Recorders recorders{&meter, also != nullptr ? also : &silent};
    Explorer explorer{{map, camera, robot, executor, &recorders, nullptr, {}, progress}, exploration_};
    TsdfMap forgotten{map.snapshot()};
    for (const RegionOfInterest& region : regions) EXPECT_TRUE(forgotten.forget(region.bounds).ok());
    auto run = explorer.update(regions, planner());
    EXPECT_TRUE(run) << run.error().to_string();
    run->regions.resize(regions.size());
    return {*run, count_unknown(forgotten.content(), regions), meter.unknown()};
  }

  /// Tells whether some frame could have said something about a point.
  bool in_some_view(const Eigen::Vector3d& p) const {
    const PinholeCamera& camera = camera_->camera();
    return std::any_of(seen_from_.begin(), seen_from_.end(), [&](const Pose& T_world_camera) {
      const Eigen::Vector3d q = T_world_camera.inverse() * p;
      if (q.z() <= 0.0) return false;
      const double u = camera.fx * q.x() / q.z() + camera.cx;
      const double v = camera.fy * q.y() / q.z() + camera.cy;
      return u >= -1.0 && u <= camera.width && v >= -1.0 && v <= camera.height;
    });
  }

  ViewSphereConfig sphere_;
  GainConfig gain_;
  ViewPlannerConfig planner_;
  ExplorerConfig exploration_;
  std::optional<SimulatedCamera> camera_;
  std::vector<Pose> seen_from_;
};

TEST_F(EnvironmentUpdate, EveryRegionIsForgottenAndLookedAtUntilItIsKnown) {
  TsdfMap map = scanned();
  FreeRobot robot;
  const std::vector<RegionOfInterest> regions = spheres({{-0.3, 0.0, 0.1}, {0.3, 0.1, 0.1}});
  const UnknownOfRegions before = count_unknown(map.content(), regions);
  const Updated result = update(map, robot, regions);
  ASSERT_EQ(result.run.regions.size(), 2U);
  EXPECT_EQ(result.run.stopped_because, StopReason::regions_done);
  ASSERT_EQ(result.unknown_after_view.size(), result.run.views.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    EXPECT_LT(result.run.regions[i].gain_left, planner_.min_gain);
    EXPECT_GT(result.unknown_after_task[i], 4 * before[i]);
    EXPECT_LT(result.unknown_after_view.back()[i], result.unknown_after_task[i] / 4);
  }
  for (std::size_t i = 1; i < result.unknown_after_view.size(); ++i) {
    EXPECT_LE(result.unknown_after_view[i][0], result.unknown_after_view[i - 1][0]);
  }
}

TEST_F(EnvironmentUpdate, ARegionThatWasSeenOnTheWayIsNotLookedAtAgain) {
  TsdfMap map = scanned();
  FreeRobot robot;
  const Updated result = update(map, robot, spheres({{0.3, 0.1, 0.1}, {0.31, 0.11, 0.1}}));
  EXPECT_EQ(result.run.regions[1].status, RegionStatus::done);
  const auto& views = result.run.views;
  EXPECT_GT(std::count_if(views.begin(), views.end(), [](const ViewRecord& view) { return view.region == 0; }),
            std::count_if(views.begin(), views.end(), [](const ViewRecord& view) { return view.region == 1; }));
  EXPECT_LT(result.unknown_after_view.front()[1], result.unknown_after_task[1]);
}

TEST_F(EnvironmentUpdate, OutsideTheRegionsOnlyWhatANewViewLookedAtChanges) {
  const TsdfMap scanned_map = scanned();
  std::mt19937 random{7};
  std::uniform_real_distribution<double> x{-0.5, 0.5};
  std::uniform_real_distribution<double> y{-0.35, 0.35};
  exploration_.max_views = 2;
  for (int i = 0; i < test::scaled_cases(4); ++i) {
    TsdfMap map{scanned_map.snapshot()};
    seen_from_.clear();
    FreeRobot robot;
    const std::vector<RegionOfInterest> regions = spheres({{x(random), y(random), 0.05}, {x(random), y(random), 0.1}});
    update(map, robot, regions);
    ASSERT_FALSE(seen_from_.empty());
    std::size_t untouched = 0;
    std::size_t changed = 0;
    const IndexBox box = voxels_with_center_in(*map_config().workspace, kVoxelOfUpdate_m);
    for (Index3 voxel{box.lo}; voxel.z < box.hi.z; ++voxel.z) {
      for (voxel.y = box.lo.y; voxel.y < box.hi.y; ++voxel.y) {
        for (voxel.x = box.lo.x; voxel.x < box.hi.x; ++voxel.x) {
          const Eigen::Vector3d p = voxel_center(voxel, kVoxelOfUpdate_m);
          const Voxel was = scanned_map.content().grid.voxel(voxel);
          const Voxel is = map.content().grid.voxel(voxel);
          const bool same = was == is;
          const bool forgotten = std::any_of(regions.begin(), regions.end(), [&](const RegionOfInterest& region) {
            return contains(region.bounds, p);
          });
          if (in_some_view(p)) {
            changed += same ? 0 : 1;
          } else if (forgotten) {
            EXPECT_EQ(state_of(is), VoxelState::unknown);
          } else {
            ASSERT_TRUE(same) << p.transpose();
            ++untouched;
          }
        }
      }
    }
    EXPECT_GT(untouched, 1000U);
    EXPECT_GT(changed, 1000U);
  }
}

TEST_F(EnvironmentUpdate, WhatIsOutOfReachIsSaidAndTheRestIsDone) {
  TsdfMap map = scanned();
  OneSidedRobot robot{0.45};
  sphere_.radii_m = {0.5};
  const Updated result = update(map, robot, spheres({{-0.45, 0.0, 0.1}, {0.4, 0.0, 0.1}}));
  const auto& outcomes = result.run.regions;
  EXPECT_EQ(outcomes[0].status, RegionStatus::out_of_reach);
  EXPECT_GT(outcomes[0].refused.of(Refusal::no_path), 0U);
  EXPECT_GE(outcomes[0].gain_left, 0.0);
  EXPECT_NE(outcomes[1].status, RegionStatus::not_begun);
  EXPECT_EQ(result.run.stopped_because, StopReason::no_candidate);
  ASSERT_FALSE(result.run.views.empty());
  for (const ViewRecord& view : result.run.views) EXPECT_EQ(view.region, 1U);
  FunctionCamera camera = this->camera();
  const Executor executor;
  const StandByResult back = Explorer{{map, camera, robot, executor}, exploration_}.return_to_stand_by().value();
  EXPECT_FALSE(back.at_stand_by);
  EXPECT_EQ(back.refusal, Refusal::declined);
}

TEST_F(EnvironmentUpdate, WithoutRegionsNothingChanges) {
  TsdfMap map = scanned();
  const TsdfSnapshot before = map.snapshot();
  FreeRobot robot;
  const Updated result = update(map, robot, {});
  EXPECT_TRUE(result.run.views.empty());
  EXPECT_EQ(result.run.stopped_because, StopReason::regions_done);
  EXPECT_TRUE(map.content().grid == before.grid);
  EXPECT_TRUE(seen_from_.empty());
}

TEST_F(EnvironmentUpdate, ABadRegionIsRefused) {
  TsdfMap map = scanned();
  FreeRobot robot;
  FunctionCamera camera = this->camera();
  const Executor executor;
  Explorer explorer{{map, camera, robot, executor}, exploration_};
  const std::vector<RegionOfInterest> bad{{Sphere{{0, 0, 0}, -1.0}, 1.0, AttentionOrigin::hand_action, ""}};
  const auto result = explorer.update(bad, planner());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::invalid_argument);
}

TEST_F(EnvironmentUpdate, WhenItIsStoppedTheRobotStaysAndTheRestIsNotBegun) {
  class StopAfterView final : public Recorder {
   public:
    explicit StopAfterView(Progress& progress) : progress_{progress} {}
    [[nodiscard]] Status viewed(ViewRecord& /*view*/, const TsdfSnapshot& /*map*/,
                                std::span<const Frame> /*frames*/) override {
      progress_.request_cancel();
      return {};
    }

   private:
    Progress& progress_;
  };
  TsdfMap map = scanned();
  FreeRobot robot;
  Progress progress;
  StopAfterView stop{progress};
  const Updated result = update(map, robot, spheres({{-0.3, 0.0, 0.1}, {0.3, 0.1, 0.1}}), &stop, &progress);
  EXPECT_EQ(result.run.views.size(), 1U);
  EXPECT_EQ(result.run.stopped_because, StopReason::cancelled);
  EXPECT_EQ(result.run.regions[0].status, RegionStatus::interrupted);
  EXPECT_EQ(result.run.regions[1].status, RegionStatus::not_begun);
  EXPECT_EQ(robot.T_world_camera().translation(), seen_from_.back().translation());
}

struct ArmUpdate {
  RunRecord run;
  std::vector<UnknownOfRegions> unknown_after_view;
  StandByResult back;
};

/// Updates with the Comau, fusing during motions or not.
ArmUpdate update_with_arm(FuseWhen when, const Executor& executor, PlannedArm& robot, const RayScene& rays) {
  SimulatedRunConfig config;
  config.voxel_size_m = kVoxelOfUpdate_m;
  config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.5, 2.0};
  config.gain_width_px = 80;
  config.planner.min_gain = 20;
  config.exploration.max_views = 3;
  config.exploration.oscillation_frames = 3;
  if (when == FuseWhen::motion) config.exploration.frame_on_way_s = kFrameOnWay_s;
  TsdfConfig map_config = config.map();
  map_config.workspace = rays.scene().workspace;
  TsdfMap map = TsdfMap::create(map_config).value();
  config.strategy = builtin_planners().find("sphere").value();
  SimulatedCamera simulated = simulated_camera(rays, config).value();
  FunctionCamera camera{config.camera, [&](const Pose& pose) -> Result<Frame> {
                          const std::optional<Configuration> q = robot.configuration();
                          EXPECT_LT((camera_pose(robot.arm(), *q).matrix() - pose.matrix()).norm(), 1e-9);
                          return simulated.capture(pose, executor);
                        }};
  const std::vector<RegionOfInterest> regions = spheres({{-0.3, 0.0, 0.1}});
  RegionMeter meter{regions};
  Explorer explorer{{map, camera, robot, executor, &meter}, config.exploration};
  EXPECT_TRUE(explorer.scan(rays.scene().scan)->complete);
  EXPECT_TRUE(explorer.forget(regions).ok());
  RegionsInTurn in_turn{regions};
  const std::vector<Region> whole{rays.scene().workspace};
  ViewPlanner planner = make_planner(config, config.camera, whole).with(in_turn);
  ArmUpdate update;
  update.run = explorer.explore(planner).value();
  update.unknown_after_view = meter.unknown();
  update.back = explorer.return_to_stand_by().value();
  return update;
}

TEST(EnvironmentUpdateWithArm, ReturnsToItsStandByAndSeesMoreWhenItLooksOnItsWay) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  const RayScene rays = RayScene::build(random_clutter(5, 4)).value();
  const Executor executor = Executor::with_threads(2);
  SimulatedRunConfig config;
  config.voxel_size_m = kVoxelOfUpdate_m;
  const ArmModel fast = find_robot("comau").value().arm;
  const ArmModel slow = slowed(fast, kSpeedWhileFusing);
  PlannedArm stopping = planned_arm(fast, rays.scene(), config).value();
  PlannedArm looking = planned_arm(slow, rays.scene(), config).value();
  const Configuration start = *looking.configuration();
  const ArmUpdate at_views = update_with_arm(FuseWhen::viewpoints, executor, stopping, rays);
  const ArmUpdate on_way = update_with_arm(FuseWhen::motion, executor, looking, rays);
  ASSERT_FALSE(at_views.run.views.empty());
  ASSERT_FALSE(on_way.run.views.empty());
  for (const ArmUpdate* result : {&at_views, &on_way}) {
    EXPECT_TRUE(result->back.at_stand_by);
    EXPECT_GT(result->back.motion_s, 0.1);
  }
  EXPECT_LT((*looking.configuration() - start).lpNorm<Eigen::Infinity>(), 1e-6);
  const ViewRecord& first = at_views.run.views.front();
  const ViewRecord& first_slow = on_way.run.views.front();
  EXPECT_EQ(first.frames_on_way, 0U);
  EXPECT_GE(first_slow.frames_on_way, 5U);
  EXPECT_LE(static_cast<double>(first_slow.frames_on_way), first_slow.motion_s / kFrameOnWay_s + 1.0);
  EXPECT_LE(on_way.unknown_after_view.front()[0], at_views.unknown_after_view.front()[0]);
}

TEST(SlowedArm, TakesTheSamePathsInMoreTime) {
  const ArmModel arm = find_robot("comau").value().arm;
  const ArmModel slow = slowed(arm, 0.25);
  const Configuration from = arm.middle();
  Configuration to = from;
  for (Eigen::Index i = 0; i < to.size(); ++i) to[i] += 0.1 * static_cast<double>(i + 1);
  const Trajectory quick = parametrise(arm, {from, to});
  const Trajectory careful = parametrise(slow, {from, to});
  EXPECT_NEAR(careful.duration_s(), 4.0 * quick.duration_s(), 1e-9);
  for (double share = 0.0; share <= 1.0; share += 0.1) {
    EXPECT_LT((quick.at(share * quick.duration_s()).q - careful.at(share * careful.duration_s()).q).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace saccade
