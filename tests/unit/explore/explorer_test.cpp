// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/explorer.hpp"

#include <gtest/gtest.h>

#include "saccade/map/tsdf_map.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/trial/metrics.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade {
namespace {

constexpr double kVoxel_m{0.012};

/// Optional parts of an explorer.
struct Caller {
  Recorder* recorder{nullptr};
  Approve approve{};
  Progress* progress{nullptr};
};

/// A clutter of four objects, seen by a small noisy camera.
class Explore : public ::testing::Test {
 protected:
  Explore() {
    SimulatedCameraConfig config;
    config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 3.0};
    camera_.emplace(*SimulatedCamera::create(rays(), config));
    sphere_.longitude_step_rad = 1.0471975511965976;
    sphere_.latitude_step_rad = 0.52359877559829887;
    sphere_.roll_step_rad = 1.5707963267948966;
    sphere_.radii_m = {1.0};
    gain_.sensor = config.camera;
    planner_.min_gain = 20;
    exploration_.max_views = 6;
    exploration_.oscillation_frames = 3;
  }

  static const RayScene& rays() {
    static const RayScene built = *RayScene::build(random_clutter(5, 4));
    return built;
  }
  static const GroundTruth& truth() {
    static const GroundTruth made = *GroundTruth::build(rays(), 0.006, Executor::with_threads(2));
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

  FunctionCamera camera() {
    return FunctionCamera{camera_->camera(),
                          [this](const Pose& pose) -> Result<Frame> { return camera_->capture(pose); }};
  }
  PlannerSetup setup(std::vector<Region> regions, std::uint64_t seed = 1) const {
    PlannerSetup setup;
    setup.sphere = sphere_;
    setup.gain = gain_;
    setup.planner = planner_;
    setup.regions = std::move(regions);
    setup.max_views = static_cast<std::size_t>(exploration_.max_views);
    setup.seed = seed;
    return setup;
  }
  ViewPlanner planner(std::string_view name, std::vector<Region> regions = {rays().scene().workspace},
                      std::uint64_t seed = 1) const {
    return ViewPlanner{builtin_planners().find(name)->make(setup(std::move(regions), seed))};
  }
  ViewPlanner sphere() const { return planner("sphere"); }
  ViewPlanner random(std::uint64_t seed) const { return planner("random", {rays().scene().workspace}, seed); }

  Result<ScanRecord> scan(TsdfMap& map, Robot& robot, std::vector<Pose> poses, const Caller& caller = {}) {
    FunctionCamera camera = this->camera();
    const Executor executor;
    Explorer explorer{{map, camera, robot, executor, nullptr, nullptr, caller.approve, caller.progress}, exploration_};
    return explorer.scan(poses);
  }
  Result<RunRecord> explore(TsdfMap& map, Robot& robot, ViewPlanner planner, const Caller& caller = {},
                            RunRecord so_far = {}) {
    FunctionCamera camera = this->camera();
    const Executor executor;
    Explorer explorer{{map, camera, robot, executor, caller.recorder, nullptr, caller.approve, caller.progress},
                      exploration_};
    return explorer.explore(planner, std::move(so_far));
  }
  /// Scans, then explores the whole workspace.
  RunRecord run(TsdfMap& map, Robot& robot, const ViewPlanner& planner, const Caller& caller = {}) {
    EXPECT_TRUE(scan(map, robot, {rays().scene().scan.front()}, {nullptr, caller.approve, nullptr})->complete);
    auto result = explore(map, robot, planner, caller);
    EXPECT_TRUE(result) << result.error().to_string();
    return *result;
  }

  ViewSphereConfig sphere_;
  GainConfig gain_;
  ViewPlannerConfig planner_;
  ExplorerConfig exploration_;
  std::optional<SimulatedCamera> camera_;
};

/// Calls a function after each view.
class AfterView final : public Recorder {
 public:
  using Call = std::function<void(const ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames)>;
  explicit AfterView(Call call) : call_{std::move(call)} {}
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override {
    call_(view, map, frames);
    return {};
  }

 private:
  Call call_;
};

TEST_F(Explore, EveryViewLeavesLessUnknownAndTheObjectsGetCovered) {
  FreeRobot robot;
  TsdfMap map = empty_map();
  std::size_t unknown = count_unknown(map.content(), rays().scene().workspace);
  AfterView recorder{[&](const ViewRecord& view, const TsdfSnapshot& after, std::span<const Frame> frames) {
    EXPECT_EQ(frames.size(), 3U);
    EXPECT_EQ(&after, &map.content());
    const std::size_t left = count_unknown(map.content(), rays().scene().workspace);
    EXPECT_LT(left, unknown);
    EXPECT_GE(view.gain_predicted, planner_.min_gain);
    EXPECT_GT(view.candidates, 50U);
    ASSERT_TRUE(view.choice);
    EXPECT_EQ(view.choice->candidates.size(), view.candidates);
    EXPECT_EQ(view.frames, 3U);
    EXPECT_EQ(view.tilt.least_rad, -exploration_.oscillation_rad);
    EXPECT_EQ(view.tilt.greatest_rad, exploration_.oscillation_rad);
    unknown = left;
  }};
  const RunRecord result = run(map, robot, sphere(), {&recorder, {}, nullptr});
  EXPECT_GE(result.views.size(), 3U);
  TsdfMap scanned = empty_map();
  ASSERT_TRUE(scan(scanned, robot, {rays().scene().scan.front()}));
  EXPECT_LT(coverage(scanned), 0.75);
  EXPECT_GT(coverage(map), 0.9);
}

TEST_F(Explore, ChoosingBeatsChance) {
  exploration_.max_views = 2;
  FreeRobot robot;
  TsdfMap chosen = empty_map();
  run(chosen, robot, sphere());
  const std::size_t left_by_choice = count_unknown(chosen.content(), rays().scene().workspace);
  double left_by_chance = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    TsdfMap map = empty_map();
    EXPECT_EQ(run(map, robot, random(seed)).views.size(), 2U);
    left_by_chance += static_cast<double>(count_unknown(map.content(), rays().scene().workspace)) / 5.0;
  }
  EXPECT_LT(static_cast<double>(left_by_choice), left_by_chance);
}

TEST_F(Explore, SaysWhyItStops) {
  FreeRobot robot;
  exploration_.max_views = 1;
  TsdfMap used_up = empty_map();
  EXPECT_EQ(run(used_up, robot, sphere()).stopped_because, StopReason::views_used_up);
  TsdfMap stopped = empty_map();
  exploration_.max_views = 6;
  Progress progress;
  AfterView enough{[&](const auto&...) { progress.request_cancel(); }};
  const RunRecord cancelled = run(stopped, robot, sphere(), {&enough, {}, &progress});
  EXPECT_EQ(cancelled.stopped_because, StopReason::cancelled);
  EXPECT_EQ(cancelled.views.size(), 1U);
  planner_.min_gain = 1e9;
  TsdfMap done = empty_map();
  const RunRecord nothing = run(done, robot, sphere());
  EXPECT_EQ(nothing.stopped_because, StopReason::regions_done);
  EXPECT_TRUE(nothing.views.empty());
}

TEST_F(Explore, ARunThatGoesOnEndsAsOneThatWasNeverInterrupted) {
  exploration_.max_views = 3;
  FreeRobot robot;
  TsdfMap whole = empty_map();
  const RunRecord expected = run(whole, robot, sphere());
  ASSERT_EQ(expected.views.size(), 3U);

  camera_->resume_at(0);
  TsdfMap parts = empty_map();
  Progress progress;
  AfterView once{[&](const auto&...) { progress.request_cancel(); }};
  const RunRecord first = run(parts, robot, sphere(), {&once, {}, &progress});
  ASSERT_EQ(first.views.size(), 1U);
  TsdfMap later{parts.snapshot()};
  const auto rest = explore(later, robot, sphere(), {}, first);
  ASSERT_TRUE(rest);
  ASSERT_EQ(rest->views.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rest->views[i].gain_predicted, expected.views[i].gain_predicted);
    EXPECT_EQ(rest->views[i].T_world_camera.matrix(), expected.views[i].T_world_camera.matrix());
  }
  EXPECT_EQ(rest->stopped_because, expected.stopped_because);
  EXPECT_EQ(later.content().grid, whole.content().grid);
}

TEST_F(Explore, TheCallerMayPassOverViewsOrStopBeforeAMove) {
  FreeRobot robot;
  exploration_.max_views = 1;
  std::vector<Eigen::Vector3d> asked;
  Caller caller;
  caller.approve = [&](const RankedView& view) {
    asked.emplace_back(view.T_world_camera.translation());
    return asked.size() == 2 ? Approval::skip : Approval::go;  // the first is the scan's
  };
  TsdfMap map = empty_map();
  const RunRecord result = run(map, robot, sphere(), caller);
  ASSERT_EQ(result.views.size(), 1U);
  ASSERT_EQ(asked.size(), 3U);
  EXPECT_EQ(result.views[0].T_world_camera.translation(), asked[2]);

  caller.approve = [](const RankedView&) { return Approval::stop; };
  TsdfMap untouched = empty_map();
  EXPECT_FALSE(scan(untouched, robot, rays().scene().scan, caller)->complete);
  EXPECT_EQ(count_unknown(untouched.content(), rays().scene().workspace),
            count_unknown(empty_map().content(), rays().scene().workspace));
  const auto stopped = explore(untouched, robot, sphere(), caller);
  ASSERT_TRUE(stopped);
  EXPECT_TRUE(stopped->views.empty());
  EXPECT_EQ(stopped->stopped_because, StopReason::cancelled);
}

TEST_F(Explore, RegionsAreTakenInTurn) {
  const Box& all = rays().scene().workspace;
  const double middle = 0.5 * (all.min.x() + all.max.x());
  Box left = all;
  left.max.x() = middle;
  Box right = all;
  right.min.x() = middle;
  FreeRobot robot;
  for (const bool by_chance : {false, true}) {
    TsdfMap map = empty_map();
    exploration_.max_views = 4;  // by chance two for each region
    const auto result = explore(map, robot, planner(by_chance ? "random" : "sphere", {left, right}));
    ASSERT_TRUE(result);
    ASSERT_EQ(result->views.size(), 4U);
    EXPECT_EQ(result->views.front().region, 0U);
    if (by_chance) {
      EXPECT_EQ(result->views[1].region, 0U);
      EXPECT_EQ(result->views[2].region, 1U);
    }
    for (std::size_t i = 1; i < 4; ++i) EXPECT_GE(result->views[i].region, result->views[i - 1].region);
  }
}

/// Reaches nothing beyond a plane.
class FencedRobot final : public Robot {
 public:
  explicit FencedRobot(double max_y_m) : max_y_m_{max_y_m} {}
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, MotionKind /*way*/) override {
    for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
      if (T_world_camera[i].translation().y() > max_y_m_) continue;
      return PlannedMotion{Motion{i, T_world_camera[i], {}}, {}, ""};
    }
    return PlannedMotion{{}, Refusal::no_path, "a fence"};
  }
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const MotionObserver&) override {
    positions.push_back(motion.T_world_camera.translation());
    return std::optional{Arrival{motion.T_world_camera, 0.0}};
  }
  std::vector<Eigen::Vector3d> positions;

 private:
  double max_y_m_;
};

/// Tilts the camera upwards less than it is asked to.
class StiffRobot final : public Robot {
 public:
  explicit StiffRobot(double max_tilt_rad) : max_tilt_rad_{max_tilt_rad} {}
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, MotionKind way) override {
    const Pose& wanted = T_world_camera.front();
    if (way == MotionKind::planned) {
      T_world_view_ = wanted;
      tilts_rad.clear();
    } else if (tilt_rad(wanted) > max_tilt_rad_) {
      return PlannedMotion{{}, Refusal::outside_limits, "a stiff joint"};
    }
    return PlannedMotion{Motion{0, wanted, {}}, {}, ""};
  }
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const MotionObserver& on_way) override {
    if (!on_way) tilts_rad.push_back(tilt_rad(motion.T_world_camera));
    return std::optional{Arrival{motion.T_world_camera, 0.0}};
  }
  std::vector<double> tilts_rad;  ///< tilts of the frames of the last view

 private:
  [[nodiscard]] double tilt_rad(const Pose& pose) const {
    const Eigen::AngleAxisd turn{T_world_view_.linear().transpose() * pose.linear()};
    return turn.angle() * turn.axis().x();
  }
  double max_tilt_rad_;
  Pose T_world_view_{Pose::Identity()};
};

TEST_F(Explore, FramesAreSpreadOverTheTiltsThatTheRobotCanTake) {
  const double whole_rad = exploration_.oscillation_rad;
  exploration_.max_views = 1;
  for (const auto& [most_rad, greatest_rad] :
       {std::pair{0.3 * whole_rad, 0.25 * whole_rad}, {0.01 * whole_rad, 0.0}, {1.01 * whole_rad, whole_rad}}) {
    StiffRobot robot{most_rad};
    TsdfMap map = empty_map();
    const RunRecord result = run(map, robot, sphere());
    ASSERT_EQ(result.views.size(), 1U);
    EXPECT_EQ(result.views[0].frames, 3U);
    EXPECT_EQ(result.views[0].tilt.least_rad, -whole_rad);
    EXPECT_EQ(result.views[0].tilt.greatest_rad, greatest_rad);
    ASSERT_EQ(robot.tilts_rad.size(), 3U);
    EXPECT_NEAR(robot.tilts_rad[0], -whole_rad, 1e-9);
    EXPECT_NEAR(robot.tilts_rad[1], 0.5 * (greatest_rad - whole_rad), 1e-9);
    EXPECT_NEAR(robot.tilts_rad[2], greatest_rad, 1e-9);
  }
}

TEST_F(Explore, PosesOutOfReachArePassedOver) {
  FencedRobot front{-0.2};
  TsdfMap map = empty_map();
  const RunRecord result = run(map, front, sphere());
  EXPECT_GE(result.views.size(), 1U);
  for (const Eigen::Vector3d& p : front.positions) EXPECT_LE(p.y(), -0.2);
  FencedRobot nowhere{-100.0};
  TsdfMap untouched = empty_map();
  const RunRecord none = run(untouched, nowhere, sphere());
  EXPECT_TRUE(none.views.empty());
  EXPECT_EQ(none.stopped_because, StopReason::no_candidate);
  EXPECT_GT(none.refused_at_end.of(Refusal::no_path), 0U);
  EXPECT_EQ(none.refused_at_end.total(), none.refused_at_end.of(Refusal::no_path));
}

/// Returns one gain, whatever it is asked.
class ShortGain final : public Gain {
 public:
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext&, const RegionOfInterest&,
                                                     std::span<const Pose>) override {
    return std::vector<double>{1.0};
  }
};

TEST_F(Explore, RefusesNonsense) {
  FreeRobot robot;
  TsdfMap map = empty_map();
  exploration_.oscillation_frames = 0;
  EXPECT_FALSE(explore(map, robot, sphere()));
  exploration_.oscillation_frames = 1;
  WholeWorkspace attention;
  SphereViews views{sphere_};
  ShortGain short_of_gains;
  const auto refused = explore(map, robot, ViewPlanner{attention, views, short_of_gains});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::size_mismatch);
  planner_.rival_share = 0.0;
  EXPECT_FALSE(explore(map, robot, sphere()));
}

TEST_F(Explore, AnOwnRuleStopsItToo) {
  class AfterTwo final : public Stopping {
   public:
    [[nodiscard]] std::optional<StopReason> reached(const RunRecord& run) const override {
      return run.views.size() < 2 ? std::nullopt : std::optional{StopReason::regions_done};
    }
  };
  const AfterTwo rule;
  FreeRobot robot;
  TsdfMap map = empty_map();
  FunctionCamera camera = this->camera();
  const Executor executor;
  ViewPlanner planner = sphere();
  Explorer explorer{{map, camera, robot, executor, nullptr, &rule}, exploration_};
  const RunRecord run = explorer.explore(planner).value();
  EXPECT_EQ(run.views.size(), 2U);
  EXPECT_EQ(run.stopped_because, StopReason::regions_done);
}

TEST_F(Explore, ABlindCameraSeesNothingAndTheMapStaysUnknown) {
  FreeRobot robot;
  TsdfMap map = empty_map();
  FunctionCamera blind{camera_->camera()};
  const Executor executor;
  exploration_.max_views = 1;
  ViewPlanner planner = random(1);
  Explorer explorer{{map, blind, robot, executor}, exploration_};
  EXPECT_EQ(explorer.explore(planner)->views.size(), 1U);
  EXPECT_EQ(count_unknown(map.content(), rays().scene().workspace),
            count_unknown(empty_map().content(), rays().scene().workspace));
}

}  // namespace
}  // namespace saccade
