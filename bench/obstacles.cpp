// SPDX-License-Identifier: Apache-2.0
// The planner's map: cells of 4 cm and distances from them in a workspace of 3 m at 5.8 mm, after each of a few views
// of the table, and spheres of an arm's size against it; beside FCL with a box per obstacle cell.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "peers.hpp"
#include "saccade/arm/internal/obstacle_field.hpp"
#include "saccade/arm/obstacle_map.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/views/view_gain.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kViews{8};
constexpr std::size_t kSpheresPerArm{80};
constexpr std::size_t kArms{400};

Executor executor_of(const benchmark::State& state) {
  return Executor::with_threads(static_cast<std::size_t>(state.range(0)));
}

/// The maps after one view, two views …; before, the upper part of the workspace is free, as after an arm's first look
/// around, and everything below is unknown.
const std::vector<TsdfSnapshot>& maps() {
  static const std::vector<TsdfSnapshot> after = [] {
    const Executor executor = Executor::with_threads(0);
    TsdfConfig config;
    config.workspace = Box{{-1.5, -1.5, -0.5}, {1.5, 1.5, 2.5}};
    TsdfMap map = TsdfMap::create(config).value();
    SACCADE_EXPECTS(map.free(Box{{-1.5, -1.5, 0.5}, {1.5, 1.5, 2.5}}).ok());
    std::vector<TsdfSnapshot> snapshots;
    const PinholeCamera camera = GainConfig{}.sensor;
    for (const Pose& T_world_camera : bench::every_nth_pose(bench::all_poses().size() / kViews)) {
      const RenderedFrame seen = render(bench::table(), camera, T_world_camera, executor).value();
      SACCADE_EXPECTS(map.integrate(camera, seen.depth, T_world_camera, executor).ok());
      snapshots.push_back(map.snapshot());
    }
    return snapshots;
  }();
  return after;
}

ObstacleConfig config_with_fixtures() {
  ObstacleConfig config;
  config.fixtures = {Box{{-2.0, -2.0, -1.0}, {2.0, 2.0, -0.45}}, Box{{-0.9, -0.2, -0.5}, {-0.6, 0.2, 0.4}}};
  return config;
}

ObstacleMap obstacles_of(const TsdfSnapshot& map, const Executor& executor) {
  return ObstacleMap::create(map, config_with_fixtures(), executor).value();
}

bool follows(const Executor& executor) {
  ObstacleMap followed = obstacles_of(maps()[0], executor);
  for (const TsdfSnapshot& map : maps()) {
    if (!followed.update(map, executor)) return false;
  }
  const ObstacleMap anew = obstacles_of(maps().back(), executor);
  return followed.cells() == anew.cells() && followed.field() == anew.field() && anew.cells().obstacle_count() > 1000;
}

void update_after_view(benchmark::State& state) {
  const Executor executor = executor_of(state);
  if (!follows(executor)) return state.SkipWithError("the obstacles differ from those made anew");
  ObstacleMap obstacles = obstacles_of(maps()[0], executor);
  std::size_t i{0};
  std::size_t bricks{0};
  std::size_t cells{0};
  for (auto _ : state) {
    if (++i == maps().size()) {
      i = 1;
      SACCADE_EXPECTS(obstacles.update(maps()[0], executor).ok());
    }
    const Stopwatch stopwatch;
    const ObstacleUpdate update = obstacles.update(maps()[i], executor).value();
    state.SetIterationTime(1e-3 * stopwatch.elapsed_ms());
    bricks += update.bricks;
    cells += update.cells;
  }
  state.counters["bricks"] = benchmark::Counter(static_cast<double>(bricks), benchmark::Counter::kAvgIterations);
  state.counters["cells"] = benchmark::Counter(static_cast<double>(cells), benchmark::Counter::kAvgIterations);
}

void make_anew(benchmark::State& state) {
  const Executor executor = executor_of(state);
  for (auto _ : state) benchmark::DoNotOptimize(obstacles_of(maps().back(), executor).cells().obstacle_count());
  state.counters["obstacle_cells"] =
      static_cast<double>(obstacles_of(maps().back(), executor).cells().obstacle_count());
}

/// Spheres of one configuration of an arm.
struct Arm {
  std::vector<float> x, y, z, radius;
  [[nodiscard]] SphereSpans spans() const { return {x, y, z, radius}; }
};

/// Chains of spheres that bend at random from a clear first one on.
struct Arms {
  std::vector<Arm> clear;
  std::vector<Arm> touching;
};

Arm random_arm(std::mt19937& rng) {
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>{lo, hi}(rng); };
  Arm arm;
  Eigen::Vector3d p{uniform(-0.7, 0.7), uniform(-0.7, 0.7), uniform(0.6, 1.0)};
  Eigen::Vector3d direction{Eigen::Vector3d::UnitZ()};
  for (std::size_t i = 0; i < kSpheresPerArm; ++i) {
    if (i % 16 == 0) direction = Eigen::Vector3d::NullaryExpr([&] { return uniform(-1.0, 1.0); }).normalized();
    p += 0.02 * direction;
    arm.x.push_back(static_cast<float>(p.x()));
    arm.y.push_back(static_cast<float>(p.y()));
    arm.z.push_back(static_cast<float>(p.z()));
    arm.radius.push_back(static_cast<float>(0.09 - 0.0005 * static_cast<double>(i)));
  }
  return arm;
}

const ObstacleMap& obstacles() {
  static const ObstacleMap made = obstacles_of(maps().back(), Executor::with_threads(0));
  return made;
}

const Arms& arms() {
  static const Arms made = [] {
    std::mt19937 rng{1};
    Arms arms;
    while (arms.clear.size() < kArms || arms.touching.size() < kArms) {
      Arm arm = random_arm(rng);
      auto& kind = obstacles().first_touching(arm.spans()) == kSpheresPerArm ? arms.clear : arms.touching;
      if (kind.size() < kArms) kind.push_back(std::move(arm));
    }
    return arms;
  }();
  return made;
}

void count(benchmark::State& state, std::size_t configurations) {
  const auto done = static_cast<double>(state.iterations()) * static_cast<double>(configurations);
  state.counters["arms_per_s"] = benchmark::Counter(done, benchmark::Counter::kIsRate);
  state.counters["spheres_per_s"] = benchmark::Counter(done * kSpheresPerArm, benchmark::Counter::kIsRate);
}

void clear_arms(benchmark::State& state) {
  SACCADE_EXPECTS(arms().clear.size() == kArms);
  for (auto _ : state) {
    for (const Arm& arm : arms().clear) {
      if (obstacles().first_touching(arm.spans()) < kSpheresPerArm) return state.SkipWithError("a sphere touches");
    }
  }
  count(state, kArms);
}

void clear_spheres_one_by_one(benchmark::State& state) {
  SACCADE_EXPECTS(arms().clear.size() == kArms);
  for (auto _ : state) {
    for (const Arm& arm : arms().clear) {
      for (std::size_t i = 0; i < kSpheresPerArm; ++i) {
        if (!obstacles().clear({arm.x[i], arm.y[i], arm.z[i]}, arm.radius[i]))
          return state.SkipWithError("a sphere touches");
      }
    }
  }
  count(state, kArms);
}

void touching_arms(benchmark::State& state) {
  SACCADE_EXPECTS(arms().touching.size() == kArms);
  for (auto _ : state) {
    for (const Arm& arm : arms().touching) {
      if (obstacles().first_touching(arm.spans()) == kSpheresPerArm) return state.SkipWithError("no sphere touches");
    }
  }
  state.counters["arms_per_s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(kArms), benchmark::Counter::kIsRate);
}

void clearances_of_arms(benchmark::State& state) {
  std::vector<float> clearances(kSpheresPerArm);
  SACCADE_EXPECTS(arms().clear.size() == kArms);
  for (auto _ : state) {
    for (const Arm& arm : arms().clear) {
      obstacles().clearance_bounds(arm.spans(), clearances);
      benchmark::DoNotOptimize(clearances.data());
    }
  }
  count(state, kArms);
}

BENCHMARK(update_after_view)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK(make_anew)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(clear_arms)->Unit(benchmark::kMicrosecond);
BENCHMARK(clearances_of_arms)->Unit(benchmark::kMicrosecond);
BENCHMARK(clear_spheres_one_by_one)->Unit(benchmark::kMicrosecond);
BENCHMARK(touching_arms)->Unit(benchmark::kMicrosecond);

#ifdef SACCADE_WITH_FCL
/// The obstacle cells that a sphere can come to from outside, and the fixtures.
std::vector<Box> exposed_boxes() {
  const ObstacleCells& cells = obstacles().cells();
  const IndexBox box = cells.box();
  std::vector<Box> exposed;
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) {
        const Index3 cell{x, y, z};
        const auto free = [&](int dx, int dy, int dz) { return !cells.is_obstacle(cell + Index3{dx, dy, dz}); };
        const bool reached =
            free(1, 0, 0) || free(-1, 0, 0) || free(0, 1, 0) || free(0, -1, 0) || free(0, 0, 1) || free(0, 0, -1);
        if (cells.is_obstacle(cell) && reached) exposed.push_back(cells.bounds_of(cell));
      }
    }
  }
  exposed.insert(exposed.end(), obstacles().config().fixtures.begin(), obstacles().config().fixtures.end());
  return exposed;
}

void fcl_make_boxes(benchmark::State& state) {
  const std::vector<Box> boxes = exposed_boxes();
  for (auto _ : state) benchmark::DoNotOptimize(bench::FclBoxes{boxes}.size());
  state.counters["boxes"] = static_cast<double>(boxes.size());
}

void fcl_clear_arms(benchmark::State& state) {
  const bench::FclBoxes boxes{exposed_boxes()};
  const auto touches = [&](const Arm& arm, std::size_t i) {
    return boxes.touches(Sphere{{arm.x[i], arm.y[i], arm.z[i]}, arm.radius[i]});
  };
  for (const Arm& arm : arms().touching) {
    std::size_t first{0};
    while (first < kSpheresPerArm && !touches(arm, first)) ++first;
    if (first != obstacles().first_touching(arm.spans()))
      return state.SkipWithError("another sphere is the first to touch");
  }
  for (auto _ : state) {
    for (const Arm& arm : arms().clear) {
      for (std::size_t i = 0; i < kSpheresPerArm; ++i) {
        if (touches(arm, i)) return state.SkipWithError("a sphere touches");
      }
    }
  }
  count(state, kArms);
}

BENCHMARK(fcl_make_boxes)->Unit(benchmark::kMillisecond);
BENCHMARK(fcl_clear_arms)->Unit(benchmark::kMicrosecond);
#endif

}  // namespace

BENCHMARK_MAIN();
