// SPDX-License-Identifier: Apache-2.0
// From one view of a cluttered table to another, where the straight joint path collides, one thread: our planner, and
// OMPL's with FCL, a box per obstacle cell, and OMPL's simplifier behind it.
#include "saccade/arm/motion_planner.hpp"

#include <benchmark/benchmark.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <iostream>

#include "saccade/arm/reachability.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/fcl_arm.hpp"
#include "support/test_arms.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kPairs{100};
constexpr int kViews{6};
constexpr double kPeerBudget_s{10.0};

/// The built-in arm at a table of which some views were seen; around it, free space is all that it has.
ObstacleMap seen_table() {
  const Executor executor = Executor::with_threads(0);
  const Scene scene = find_scene("tabletop-2").value();
  const RayScene rays = RayScene::build(scene).value();
  SimulatedRunConfig config;
  TsdfConfig map_config = config.map();
  map_config.workspace = scene.workspace;
  TsdfMap map = TsdfMap::create(map_config).value();
  SimulatedCamera camera = simulated_camera(rays, config).value();
  const std::vector<Pose> poses = poses_of(view_sphere(Eigen::Vector3d{0.0, 0.0, 0.1}).value());
  std::mt19937_64 random{3};
  for (int i = 0; i < kViews; ++i) {
    const Pose& pose = poses[poses.size() / 2 + random() % (poses.size() / 4)];
    const Frame frame = camera.capture(pose, executor);
    SACCADE_EXPECTS(map.integrate(config.camera, frame.depth, pose, executor).ok());
  }
  ObstacleConfig obstacles;
  for (const SceneObject& object : scene.objects) {
    if (object.name == "table") obstacles.fixtures.push_back(Box{{-0.7, -0.5, -0.04}, {0.7, 0.5, 0.0}});
  }
  return ObstacleMap::create(map.snapshot(), obstacles, executor).value();
}

struct Pair {
  Configuration start;
  Configuration goal;
};

struct Problem {
  ArmModel model;
  ArmCollision arm;
  ObstacleMap obstacles;
  std::vector<Pair> pairs;
};

/// Pairs are drawn before anyone plans; those that ours cannot solve in a long time are left out.
const Problem& problem() {
  static const Problem made = [] {
    const ArmModel model = find_robot("comau_smart_six").value().arm;
    Problem problem{model, ArmCollision::create(model).value(), seen_table(), {}};
    const Reachability reachability = Reachability::create(problem.arm).value();
    std::vector<Configuration> at_views;
    for (const Eigen::Vector3d& center : {Eigen::Vector3d{-0.3, 0, 0.1}, {0, 0, 0.1}, {0.3, 0.1, 0.15}}) {
      ViewSphereConfig sphere;
      sphere.radii_m = {0.5, 0.8};
      const std::vector<Pose> views = poses_of(view_sphere(center, sphere).value());
      for (const Pose& T_world_camera : views) {
        const PoseGoals goals = reachability.goals(T_world_camera, model.middle(), problem.obstacles);
        at_views.insert(at_views.end(), goals.free.begin(), goals.free.end());
      }
    }
    MotionPlannerConfig patient;
    patient.max_motions = 200000;
    patient.budget_s = 20.0;
    const MotionPlanner planner = MotionPlanner::create(problem.arm, patient).value();
    std::mt19937_64 random{11};
    std::size_t straight{0};
    std::size_t unsolved{0};
    while (problem.pairs.size() < kPairs) {
      const Configuration& start = at_views[random() % at_views.size()];
      const Configuration& goal = at_views[random() % at_views.size()];
      if (!problem.arm.motion_contact(start, goal, problem.obstacles)) {
        ++straight;
      } else if (!planner.plan(start, std::span{&goal, 1}, problem.obstacles).value().plan) {
        ++unsolved;
      } else {
        problem.pairs.push_back({start, goal});
      }
    }
    std::cerr << at_views.size() << " configurations at views; " << straight << " pairs had a straight motion, "
              << unsolved << " no path\n";
    return problem;
  }();
  return made;
}

struct Figures {
  std::vector<double> ms;
  std::vector<double> path_s;
  std::vector<double> trajectory_s;
  std::size_t solved{0};

  static double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
  void report(benchmark::State& state) const {
    state.counters["median_ms"] = quantile(ms, 0.5);
    state.counters["p90_ms"] = quantile(ms, 0.9);
    state.counters["path_s"] = quantile(path_s, 0.5);
    state.counters["solved"] = static_cast<double>(solved);
    if (!trajectory_s.empty()) state.counters["trajectory_s"] = quantile(trajectory_s, 0.5);
  }
};

Figures plan_all() {
  Figures figures;
  const MotionPlanner planner = MotionPlanner::create(problem().arm).value();
  for (const Pair& pair : problem().pairs) {
    const Stopwatch stopwatch;
    const PlanOutcome outcome = planner.plan(pair.start, std::span{&pair.goal, 1}, problem().obstacles).value();
    figures.ms.push_back(stopwatch.elapsed_ms());
    if (!outcome.plan) continue;
    ++figures.solved;
    figures.path_s.push_back(rest_to_rest_s(problem().model, outcome.plan->path));
    figures.trajectory_s.push_back(outcome.plan->trajectory.duration_s());
  }
  return figures;
}

/// Typical code of OMPL's users: a state space of the joints, FCL at states every hundredth of its extent,
/// simplifySolution.
Figures peer_plans_all() {
  namespace ob = ompl::base;
  namespace og = ompl::geometric;
  ompl::msg::noOutputHandler();
  Figures figures;
  const ArmModel& model = problem().model;
  test::FclArm fcl{problem().arm, problem().obstacles};
  const auto joints = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(model.dof()));
  ob::RealVectorBounds bounds(static_cast<unsigned>(model.dof()));
  for (int i = 0; i < model.dof(); ++i) {
    bounds.setLow(static_cast<unsigned>(i), model.joint(i).limits.lower);
    bounds.setHigh(static_cast<unsigned>(i), model.joint(i).limits.upper);
  }
  joints->setBounds(bounds);
  const auto configuration = [&](const ob::State* state) {
    Configuration q{model.dof()};
    for (int i = 0; i < model.dof(); ++i) q[i] = state->as<ob::RealVectorStateSpace::StateType>()->values[i];
    return q;
  };
  for (const Pair& pair : problem().pairs) {
    og::SimpleSetup setup{joints};
    setup.setStateValidityChecker(
        [&](const ob::State* state) { return !fcl.collides(forward_kinematics(model, configuration(state))); });
    setup.setPlanner(std::make_shared<og::RRTConnect>(setup.getSpaceInformation()));
    ob::ScopedState<> start{joints};
    ob::ScopedState<> goal{joints};
    for (int i = 0; i < model.dof(); ++i) {
      start[static_cast<unsigned>(i)] = pair.start[i];
      goal[static_cast<unsigned>(i)] = pair.goal[i];
    }
    setup.setStartAndGoalStates(start, goal);
    const Stopwatch stopwatch;
    const bool solved = setup.solve(kPeerBudget_s) == ob::PlannerStatus::EXACT_SOLUTION;
    if (solved) setup.simplifySolution();
    figures.ms.push_back(stopwatch.elapsed_ms());
    if (!solved) continue;
    ++figures.solved;
    JointPath path;
    for (const ob::State* state : setup.getSolutionPath().getStates()) path.push_back(configuration(state));
    figures.path_s.push_back(rest_to_rest_s(model, path));
  }
  return figures;
}

void ours(benchmark::State& state) {
  static_cast<void>(problem());
  Figures figures;
  for (auto _ : state) figures = plan_all();
  figures.report(state);
}
BENCHMARK(ours)->Unit(benchmark::kMillisecond)->Iterations(1);

void ompl_fcl(benchmark::State& state) {
  static_cast<void>(problem());
  const double ours_ms = Figures::quantile(plan_all().ms, 0.5);
  Figures figures;
  for (auto _ : state) figures = peer_plans_all();
  figures.report(state);
  state.counters["speedup"] = Figures::quantile(figures.ms, 0.5) / ours_ms;
}
BENCHMARK(ompl_fcl)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
