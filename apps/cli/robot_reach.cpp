// SPDX-License-Identifier: Apache-2.0
#include "robot_reach.hpp"

#include <algorithm>
#include <cmath>

#include "context.hpp"
#include "length_options.hpp"
#include "robot_reach_output.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/devices/cell.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {
namespace {

constexpr double kStep_m{0.05};
constexpr double kNumericStep_m{0.1};
/// 224 poses around a point instead of 960.
constexpr double kNumericRollStep_rad{90_deg};
constexpr double kNumericLongitudeStep_rad{45_deg};
constexpr double kNumericLatitudeStep_rad{15_deg};
constexpr double kAboveSupport_m{0.1};
/// Size of the cells of the free space: nothing is in them, so they need not be small.
constexpr double kFreeCell_m{0.04};

/// The highest top of a support that lies below the middle of the workspace's area and reaches into it.
std::optional<double> support_height_m(const std::vector<FixtureBox>& fixtures, const Box& workspace) {
  const Eigen::Vector3d middle = 0.5 * (workspace.min + workspace.max);
  std::optional<double> height_m;
  for (const FixtureBox& fixture : fixtures) {
    const double top_m = fixture.box.max.z();
    const Eigen::Vector3d inside{middle.x(), middle.y(), 0.5 * (fixture.box.min.z() + top_m)};
    const bool within = top_m >= workspace.min.z() && top_m < workspace.max.z();
    if (fixture.support && within && contains(fixture.box, inside))
      height_m = std::max(height_m.value_or(top_m), top_m);
  }
  return height_m;
}

Result<double> points_height_m(const ReachOptions& options, const std::vector<FixtureBox>& fixtures,
                               const Box& workspace) {
  const double height_m =
      options.height_m.value_or(support_height_m(fixtures, workspace).value_or(workspace.min.z()) + kAboveSupport_m);
  if (height_m >= workspace.min.z() && height_m <= workspace.max.z()) return height_m;
  return Error{Errc::invalid_argument,
               "the points, at z = " + std::to_string(height_m) + " m, lie outside the workspace; it reaches from " +
                   std::to_string(workspace.min.z()) + " to " + std::to_string(workspace.max.z()) + " m",
               "--height"};
}

IkConfig ik_config() {
  IkConfig config;
  config.numeric.restarts = kNumericRestarts;
  return config;
}

/// Nothing here takes long, so that what is asked for wrongly is refused at once.
Result<ReachTask> make_task(const ReachOptions& options) {
  SACCADE_TRY(UrdfArm robot, find_robot(options.arm.robot, options.arm.urdf));
  SACCADE_TRY(const Scene scene, find_scene(options.scene));
  SACCADE_TRY(std::vector<FixtureBox> fixtures, fixture_boxes(scene));
  if (std::filesystem::is_regular_file(options.scene) && !is_mesh_file(options.scene)) {
    SACCADE_TRY(const Cell cell, read_cell(options.scene));
    for (const Box& box : cell.fixtures) {
      fixtures.push_back({"fixture " + std::to_string(fixtures.size() + 1), box, true});  // one may be the table
    }
  }
  SACCADE_TRY(InverseKinematics ik, InverseKinematics::create(robot.arm, ik_config()));
  const bool numeric = ik.method() == IkMethod::numeric;
  ReachMapConfig config;
  config.workspace = options.workspace.value_or(scene.workspace);
  SACCADE_TRY(config.height_m, points_height_m(options, fixtures, config.workspace));
  config.step_m = options.step_m.value_or(numeric ? kNumericStep_m : kStep_m);
  config.sphere.radii_m = options.radii_m;
  if (numeric) {
    config.sphere.longitude_step_rad = kNumericLongitudeStep_rad;
    config.sphere.latitude_step_rad = kNumericLatitudeStep_rad;
    config.sphere.roll_step_rad = kNumericRollStep_rad;
  }
  SACCADE_CHECK(config.validate());
  return ReachTask{std::move(robot), std::move(ik), scene.name, std::move(fixtures), std::move(config)};
}

/// Free space and the fixtures.
Result<ObstacleMap> obstacles_of(const ReachTask& task, const Executor& executor) {
  TsdfConfig config;
  config.voxel_size_m = kFreeCell_m;
  config.workspace = task.config.workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(config));
  SACCADE_CHECK(map.free(*config.workspace));
  ObstacleConfig obstacles;
  obstacles.cell_size_m = kFreeCell_m;
  for (const FixtureBox& fixture : task.fixtures) obstacles.fixtures.push_back(fixture.box);
  return ObstacleMap::create(map.snapshot(), obstacles, executor);
}

class RobotReach final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "reach",
            .description = "draws where in a workspace an arm can take view poses",
            .result_name = "robot"};
  }

  void declare(Options& options) override {
    add_arm_options(options.group(), reach_.arm)->capture_default_str();
    options.value("--scene", reach_.scene, "SCENE",
                  "scene that gives the workspace and the obstacles (its fixtures and supports, as boxes): a built-in "
                  "scene, clutter:SEED, "
                  "a YAML file or a mesh file");
    options.box("--workspace", reach_.workspace, "box of the points of interest, instead of the scene's workspace");
    options.value("--height", reach_.height_m, "METRES",
                  "world z of the points (default: 0.1 above the support in the workspace, else above its lower end)");
    options.value("--step", reach_.step_m, "METRES",
                  "distance between points, metres (default: 0.05; 0.1 for arms without a closed form)");
    options.lengths("--distance,--radius", reach_.radii_m,
                    "radius of the view sphere around each point, metres; several separated by commas (default: 0.8)");
    options.folder({.help = "folder for reach.png, reach.csv and reach.json",
                    .files = {kReachFiles.begin(), kReachFiles.end()},
                    .document = kReachFiles.front(),
                    .required = true,
                    .opened_by_command = true});
    options.flag("--no-pictures{false}", pictures_, "draw no picture");
  }

  void check(const GlobalOptions& /*global*/) override {
    check_arm_options(reach_.arm);
    if (reach_.step_m) require_length(*reach_.step_m, "--step");
    if (reach_.height_m && !std::isfinite(*reach_.height_m)) usage_error("--height", "must be a number");
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    const Executor& executor = context.executor();
    SACCADE_TRY(const ReachTask task, make_task(reach_));
    SACCADE_CHECK(context.open_folder());
    SACCADE_TRY(const ArmCollision collision, ArmCollision::create(task.robot.arm));
    SACCADE_TRY(const Reachability reachability, Reachability::create(collision, ik_config()));
    SACCADE_TRY(const ObstacleMap obstacles, obstacles_of(task, executor));
    context.lap("prepare");
    show_choices(task.robot, context.bar());
    if (task.ik.method() == IkMethod::numeric) {
      context.bar().note(
          "no closed form for this arm: its inverse kinematics iterates, which takes milliseconds a pose");
    }
    const Stopwatch testing;
    SACCADE_TRY(const ReachMap map,
                reach_map(reachability, task.robot.arm.middle(), obstacles, task.config, executor, context.progress()));
    if (map.points_done == 0) return Error{Errc::cancelled, "no point was done", ""};
    const double test_ms = testing.elapsed_ms();
    context.lap("test");
    SACCADE_CHECK(write_reach(*context.folder(), task, map, pictures_));
    Outcome outcome{.result = reach_json(task, map),
                    .text = reach_text(task, map, test_ms) + "\nresults: " + context.out().string() + "\n"};
    if (map.points_done < map.points.size()) {
      outcome.cut_short = "interrupted after " + std::to_string(map.points_done) + " of " +
                          std::to_string(map.points.size()) + " points; the results hold those";
    }
    return std::move(outcome).empty_if(
        map.total().reachable == 0,
        "not one pose can be reached; is the arm where it should be (--base-at), and the radius right?");
  }

 private:
  ReachOptions reach_;
  bool pictures_{true};
};

}  // namespace

std::unique_ptr<Command> make_robot_reach() { return std::make_unique<RobotReach>(); }

}  // namespace saccade::cli
