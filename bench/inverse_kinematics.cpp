// SPDX-License-Identifier: Apache-2.0
// All solutions of 92,160 camera poses around a table for the built-in arm: the view spheres of 96 points. Beside them
// KDL's Levenberg–Marquardt, one solution and no limits, on every 97th of the same poses.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/kdl_arm.hpp"
#include "support/test_arms.hpp"

namespace {

using namespace saccade;

const InverseKinematics& solver() {
  static const InverseKinematics ik = InverseKinematics::create(find_robot("comau_smart_six")->arm).value();
  return ik;
}

/// Points over a table of 1.2 × 0.8 m, 960 poses around each.
const std::vector<Pose>& poses() {
  static const std::vector<Pose> all = [] {
    std::vector<Pose> made;
    for (int i = 0; i < 96; ++i) {
      const Eigen::Vector3d p_world{-0.6 + 1.2 / 11.0 * (i % 12), -0.4 + 0.8 / 7.0 * std::floor(i / 12.0), 0.1};
      const std::vector<Pose> around = poses_of(view_sphere(p_world).value());
      made.insert(made.end(), around.begin(), around.end());
    }
    return made;
  }();
  return all;
}

bool all_meet(const IkTable& table) {
  for (std::size_t i = 0; i < table.poses(); i += 31) {
    for (std::size_t k = 0; k < table.count(i); ++k) {
      const Configuration q = table.solution(i, k);
      if (!solver().arm().within_limits(q)) return false;
      if (test::miss(camera_pose(solver().arm(), q), poses()[i]) > kIkTolerance) return false;
    }
  }
  return table.solutions() > 0;
}

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void all_solutions(benchmark::State& state) {
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  IkTable table;
  for (auto _ : state) table = solver().solve_all(poses(), solver().arm().middle(), executor);
  if (!all_meet(table)) return state.SkipWithError("a solution misses its pose");
  std::size_t reached{0};
  for (std::size_t i = 0; i < table.poses(); ++i) reached += table.count(i) > 0 ? 1U : 0U;
  state.counters["poses"] = static_cast<double>(table.poses());
  state.counters["reached"] = static_cast<double>(reached);
  state.counters["solutions"] = static_cast<double>(table.solutions());
}

/// Those of the poses that the arm comes to.
const std::vector<Pose>& reached_poses() {
  static const std::vector<Pose> reached = [] {
    const IkTable table = solver().solve_all(poses(), solver().arm().middle(), {});
    std::vector<Pose> made;
    for (std::size_t i = 0; i < poses().size(); ++i) {
      if (table.count(i) > 0) made.push_back(poses()[i]);
    }
    return made;
  }();
  return reached;
}

/// `cpu_speedup`: how many times longer KDL takes per pose than ours, one thread each, right after one another. KDL
/// tries longest where there is nothing to be found; with reached:1 there always is.
void kdl_one_solution(benchmark::State& state) {
  const std::vector<Pose>& asked = state.range(0) != 0 ? reached_poses() : poses();
  test::KdlArm kdl{solver().arm()};
  double theirs_s{0.0};
  double ours_s{0.0};
  std::size_t count{0};
  std::size_t solved{0};
  for (auto _ : state) {
    count = 0;
    solved = 0;
    const double begin = cpu_s();
    const Stopwatch stopwatch;
    for (std::size_t i = 0; i < asked.size(); i += 97, ++count) {
      Configuration q = solver().arm().middle();
      solved += kdl.solve(asked[i], q) ? 1U : 0U;
    }
    state.SetIterationTime(1e-3 * stopwatch.elapsed_ms());
    theirs_s += (cpu_s() - begin) / static_cast<double>(count);
    const double middle = cpu_s();
    benchmark::DoNotOptimize(solver().solve_all(asked, solver().arm().middle(), {}));
    ours_s += (cpu_s() - middle) / static_cast<double>(asked.size());
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["poses"] = static_cast<double>(count);
  state.counters["solved"] = static_cast<double>(solved);
  state.counters["kdl_us_per_pose"] = 1e6 * theirs_s / rounds;
  state.counters["ours_us_per_pose"] = 1e6 * ours_s / rounds;
  state.counters["cpu_speedup"] = theirs_s / ours_s;
}

void forward(benchmark::State& state) {
  Configuration q = solver().arm().middle();
  for (auto _ : state) {
    benchmark::DoNotOptimize(forward_kinematics(solver().arm(), q).T_world_camera.matrix().data());
    q[0] += 1e-6;
  }
}

BENCHMARK(all_solutions)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(kdl_one_solution)->ArgName("reached")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK(forward)->Unit(benchmark::kNanosecond);

}  // namespace

BENCHMARK_MAIN();
