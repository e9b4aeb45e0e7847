// SPDX-License-Identifier: Apache-2.0
// Gain of the 960 view poses of thesis §2.2.3 around a forgotten sphere of 0.2 m on a table: 640×480 rays, 5.8 mm.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "saccade/map/tsdf_map.hpp"
#include "saccade/view/best_views.hpp"
#include "saccade/view/view_gain.hpp"
#include "saccade/view/view_sphere.hpp"

namespace {

using namespace saccade;

constexpr double kReach_m{1.2};
const Eigen::Vector3d kPoi{0.0, 0.0, 0.1};
const Region kRegion{Sphere{kPoi, 0.2}};

double box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& center, const Eigen::Vector3d& half_m) {
  const Eigen::Vector3d q = (p - center).cwiseAbs() - half_m;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// A table with boxes on it, metres to the nearest surface.
double distance_m(const Eigen::Vector3d& p) {
  const double on_table = std::min(
      {box_distance(p, {0.0, 0.0, 0.05}, {0.06, 0.04, 0.05}), box_distance(p, {0.35, 0.1, 0.12}, {0.05, 0.08, 0.12}),
       box_distance(p, {-0.2, -0.3, 0.08}, {0.1, 0.05, 0.08}), box_distance(p, {0.05, 0.45, 0.2}, {0.2, 0.05, 0.2})});
  return std::min(p.z(), on_table);
}

/// The scene fully seen from outside, then the region forgotten; beyond the truncation behind surfaces all is unknown.
TsdfSnapshot make_map() {
  TsdfSnapshot map;
  const TsdfConfig& config = map.config;
  const double brick_m = kBrickEdge * config.voxel_size_m;
  const double half_diagonal_m = 0.5 * std::sqrt(3.0) * brick_m;
  const int n = static_cast<int>(std::ceil(kReach_m / brick_m));
  for (int i = 0; i < 8 * n * n * n; ++i) {
    const Index3 brick{i % (2 * n) - n, i / (2 * n) % (2 * n) - n, i / (4 * n * n) - n};
    const Eigen::Vector3d center = voxel_center(brick, brick_m);
    const double distance = distance_m(center);
    if (distance < -config.truncation_m() - half_diagonal_m) continue;
    BrickRef ref = BrickRef::constant_free(config.free_weight);
    if (distance < config.truncation_m() + half_diagonal_m) {
      DenseBrick& dense = ref.densify();
      for (int k = 0; k < kBrickVoxels; ++k) {
        const Index3 voxel = brick * kBrickEdge + child_offset(k);
        const double v = distance_m(voxel_center(voxel, config.voxel_size_m)) / config.truncation_m();
        const auto at = static_cast<std::size_t>(k);
        dense.w[at] = v < -1.0 ? std::uint16_t{0} : std::uint16_t{5};
        dense.v[at] = static_cast<std::int16_t>(v < -1.0 ? 0.0 : std::round(std::min(v, 1.0) * kTsdfOne));
      }
      dense.update_masks();
      ref.canonicalize(config.free_weight);
    }
    Sector& sector = map.grid.writable(parent(brick));
    sector.bricks[static_cast<std::size_t>(child_index(brick))] = ref;
    sector.update_summary(child_index(brick), config.free_weight);
  }
  TsdfMap forgetting{std::move(map)};
  if (!forgetting.forget(kRegion)) return {};
  return forgetting.snapshot();
}

const TsdfSnapshot& scene() {
  static const TsdfSnapshot map = make_map();
  return map;
}

void run(benchmark::State& state, const GainConfig& config, std::size_t every, std::size_t threads) {
  const auto candidates = view_sphere(kPoi);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < candidates->size(); i += every) poses.push_back((*candidates)[i].T_world_camera);
  const Executor executor = Executor::with_threads(threads);
  const TsdfSnapshot& map = scene();
  GainConfig few_savings = config;
  few_savings.savings = GainSavings::none();
  few_savings.savings.region_rays = few_savings.savings.region_exit = few_savings.savings.empty_bricks = true;
  const std::span<const Pose> some{poses.data() + poses.size() / 2, 2};
  const auto expected = evaluate_views(map, kRegion, some, few_savings, executor);
  double prepare_ms{0.0};
  double evaluate_ms{0.0};
  double cast{0.0};
  for (auto _ : state) {
    const auto result = evaluate_views(map, kRegion, poses, config, executor);
    if (!result || !expected ||
        !std::equal(expected->gains.begin(), expected->gains.end(),
                    result->gains.begin() + static_cast<std::ptrdiff_t>(poses.size() / 2)) ||
        expected->gains[0] == 0) {
      state.SkipWithError("the gains differ from those of rays walked one by one");
      return;
    }
    prepare_ms = result->prepare_ms;
    evaluate_ms = result->evaluate_ms;
    cast = static_cast<double>(result->rays_cast);
  }
  state.counters["poses"] = static_cast<double>(poses.size());
  state.counters["prepare_ms"] = prepare_ms;
  state.counters["evaluate_ms"] = evaluate_ms;
  state.counters["rays_cast"] = cast;
}

void all_savings(benchmark::State& state) { run(state, {}, 1, static_cast<std::size_t>(state.range(0))); }
void best_only(benchmark::State& state) {
  const auto candidates = view_sphere(kPoi);
  std::vector<Pose> poses;
  for (const auto& candidate : *candidates) poses.push_back(candidate.T_world_camera);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  const auto all = evaluate_views(scene(), kRegion, poses, {}, executor);
  const RankedView expected = order_views(all->gains, poses).front();
  double evaluated{0.0};
  for (auto _ : state) {
    const auto best = best_views(scene(), kRegion, poses, 1, {}, executor);
    if (!best || best->views.front().index != expected.index || best->views.front().gain != expected.gain) {
      return state.SkipWithError("the best view differs from that of all gains");
    }
    evaluated = static_cast<double>(best->poses_evaluated);
  }
  state.counters["poses_evaluated"] = evaluated;
}
void distinct_voxels(benchmark::State& state) {
  GainConfig config;
  config.count = GainCount::distinct_voxels;
  run(state, config, 1, static_cast<std::size_t>(state.range(0)));
}
void without_shared_lattice(benchmark::State& state) {
  GainConfig config;
  config.savings.shared_lattice = false;
  run(state, config, 1, static_cast<std::size_t>(state.range(0)));
}
void without_tiles(benchmark::State& state) {
  GainConfig config;
  config.savings.tiles = false;
  run(state, config, 1, static_cast<std::size_t>(state.range(0)));
}
/// Baseline: every ray of the region walked by itself, on every eighth pose.
void rays_one_by_one(benchmark::State& state) {
  GainConfig config;
  config.savings.tiles = config.savings.shared_lattice = false;
  run(state, config, 8, static_cast<std::size_t>(state.range(0)));
}

BENCHMARK(all_savings)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(best_only)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(distinct_voxels)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(without_shared_lattice)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(without_tiles)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(rays_one_by_one)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
