// SPDX-License-Identifier: Apache-2.0
// Which camera poses an arm can take: 23,040 around 24 points of a table before it, and the table; one thread. Beside
// it how many poses the samples of what a pose leaves open solve. The arms with seven joints are those of the recorded
// data; without it they are left out.
#include "saccade/arm/reachability.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "saccade/arm/urdf.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/shared_arms.hpp"
#include "support/sliding_arms.hpp"

namespace {

using namespace saccade;

struct Task {
  Reachability reachability;
  ObstacleMap obstacles;
  std::vector<Pose> poses;
};

/// @param look_from_m the camera's distance from the points
Task task_of(const ArmModel& arm, double look_from_m) {
  ViewSphereConfig sphere;
  sphere.radii_m = {look_from_m};
  Task task{Reachability::create(ArmCollision::create(arm).value()).value(),
            test::only({Box{{-0.7, -0.4, -0.1}, {0.7, 0.4, -0.005}}}),
            {}};
  for (int i = 0; i < 24; ++i) {
    const Eigen::Vector3d p_world{-0.5 + 0.2 * (i % 6), -0.3 + 0.2 * std::floor(i / 6.0), 0.05};
    const std::vector<Pose> around = poses_of(view_sphere(p_world, sphere).value());
    task.poses.insert(task.poses.end(), around.begin(), around.end());
  }
  return task;
}

/// Behind the table's edge, with a camera beside the flange.
ArmModel behind_table(const ArmModel& arm) {
  ArmDescription description = arm.description();
  description.T_world_base.translation().y() -= 0.6;
  description.T_flange_camera = description.T_flange_camera * Eigen::Translation3d{0.06, 0.0, 0.04};
  return ArmModel::create(std::move(description)).value();
}

/// Counters: shares of the poses by what is said of them; the median of single poses, µs.
void test_poses(benchmark::State& state, const Task& task) {
  const Configuration& reference = task.reachability.arm().middle();
  std::vector<std::optional<Refusal>> refusals;
  double total_us = 0.0;
  for (auto _ : state) {
    const Stopwatch stopwatch;
    refusals = task.reachability.test(task.poses, reference, task.obstacles, Executor{});
    total_us += 1e3 * stopwatch.elapsed_ms();
  }
  const auto count = static_cast<double>(task.poses.size());
  const auto share = [&](std::optional<Refusal> what) {
    return static_cast<double>(std::count(refusals.begin(), refusals.end(), what)) / count;
  };
  if (share(std::nullopt) < 0.1) return state.SkipWithError("hardly any pose can be taken");
  state.counters["free"] = share(std::nullopt);
  state.counters["no_ik"] = share(Refusal::no_ik);
  state.counters["outside_limits"] = share(Refusal::outside_limits);
  state.counters["in_collision"] = share(Refusal::goal_in_collision);
  state.counters["mean_us"] = total_us / count / static_cast<double>(state.iterations());
  std::vector<double> each_us;
  for (std::size_t i = 0; i < task.poses.size(); i += 7) {
    const Stopwatch stopwatch;
    benchmark::DoNotOptimize(
        task.reachability.test(std::span{&task.poses[i], 1}, reference, task.obstacles, Executor{}));
    each_us.push_back(1e3 * stopwatch.elapsed_ms());
  }
  std::sort(each_us.begin(), each_us.end());
  state.counters["median_us"] = each_us[each_us.size() / 2];
  state.counters["p90_us"] = each_us[each_us.size() * 9 / 10];
}

/// Counter: the share of the poses of random configurations that are solved from the middle of the limits.
void solved(benchmark::State& state, const ArmModel& arm) {
  constexpr int kPoses{5000};
  IkConfig config;
  config.redundancy_samples = static_cast<int>(state.range(0));
  const InverseKinematics ik = InverseKinematics::create(arm, config).value();
  std::mt19937_64 random{1};
  std::vector<Pose> poses;
  for (int i = 0; i < kPoses; ++i) poses.push_back(camera_pose(arm, test::random_configuration(arm, random)));
  double found = 0.0;
  double solutions = 0.0;
  for (auto _ : state) {
    found = 0.0;
    solutions = 0.0;
    for (const Pose& pose : poses) {
      const std::size_t count = ik.solve(pose).size();
      found += count > 0 ? 1.0 : 0.0;
      solutions += static_cast<double>(count);
    }
  }
  state.counters["solved"] = found / kPoses;
  state.counters["solutions"] = solutions / kPoses;
  state.SetItemsProcessed(state.iterations() * kPoses);
}

void add_solved(const std::string& name, const ArmModel& arm) {
  benchmark::RegisterBenchmark(("solved/" + name).c_str(), solved, arm)
      ->ArgName("samples")
      ->RangeMultiplier(2)
      ->Range(4, 64)
      ->Arg(24)
      ->Unit(benchmark::kMillisecond);
}

void add(const std::string& name, const ArmModel& arm, double look_from_m) {
  const auto task = std::make_shared<std::optional<Task>>();  // made when it is asked for
  benchmark::RegisterBenchmark(("test_poses/" + name).c_str(), [task, arm, look_from_m](benchmark::State& state) {
    if (!*task) task->emplace(task_of(arm, look_from_m));
    test_poses(state, **task);
  })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  add("comau_smart_six", find_robot("comau_smart_six").value().arm, 0.8);
  add("ur_like", find_robot("ur_like").value().arm, 0.5);
  if (std::filesystem::exists(test::shared_robots())) {
    add("panda", behind_table(test::shared_panda().value().arm), 0.4);
    add("panda_hand", behind_table(test::shared_panda_hand().value().arm), 0.4);
    add("iiwa14", behind_table(test::shared_iiwa().value().arm), 0.4);
    add_solved("panda", test::shared_panda().value().arm);
    add_solved("iiwa14", test::shared_iiwa().value().arm);
    add("iiwa14_spheres", behind_table(test::shared_iiwa("spheres_dense").value().arm), 0.4);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
