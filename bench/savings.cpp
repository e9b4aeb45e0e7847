// SPDX-License-Identifier: Apache-2.0
// Effect of each exact saving of view evaluation: none of them, each alone, one more after the other, all but
// one, and all. Without tiles only some of the 960 poses are evaluated: whole camera centres with their eight rolls,
// spread over the sphere. Every gain is compared with that of all savings.
#include <benchmark/benchmark.h>

#include <array>
#include <map>

#include "saccade/views/view_gain.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;
using bench::all_poses;
using bench::kRegion;

constexpr std::size_t kRolls{8};

/// In the order in which they are added to each other.
struct Saving {
  const char* name;
  bool GainSavings::*on;
};
constexpr std::array<Saving, 9> kSavings{{{"blocked_camera", &GainSavings::blocked_camera},
                                          {"region_rays", &GainSavings::region_rays},
                                          {"empty_bricks", &GainSavings::empty_bricks},
                                          {"region_exit", &GainSavings::region_exit},
                                          {"shared_lattice", &GainSavings::shared_lattice},
                                          {"tiles", &GainSavings::tiles},
                                          {"exposed_voxels", &GainSavings::exposed_voxels},
                                          {"packets", &GainSavings::packets},
                                          {"footprints", &GainSavings::footprints}}};

/// Every n-th camera centre with all its rolls. 11 and 61 have no factor in common with the numbers of longitudes and
/// latitudes.
std::vector<Pose> poses_of_every_nth_center(std::size_t n) {
  std::vector<Pose> poses;
  for (std::size_t center = 0; center < all_poses().size() / kRolls; center += n) {
    const auto first = all_poses().begin() + static_cast<std::ptrdiff_t>(center * kRolls);
    poses.insert(poses.end(), first, first + kRolls);
  }
  return poses;
}

/// So few that one round takes seconds at most.
std::size_t every_center(const GainSavings& savings) {
  if (savings.tiles && savings.empty_bricks) return 1;
  return savings.region_rays ? 11 : 61;
}

const std::vector<std::uint64_t>& expected_gains(std::size_t views) {
  static std::map<std::size_t, std::vector<std::uint64_t>> gains;
  std::vector<std::uint64_t>& known = gains[views];
  if (known.empty()) {
    known = evaluate_views(bench::map_after(views), kRegion, all_poses(), {}, Executor::with_threads(0)).value().gains;
  }
  return known;
}

bool same_gains(const std::vector<std::uint64_t>& gains, std::size_t views, std::size_t every) {
  const std::vector<std::uint64_t>& expected = expected_gains(views);
  for (std::size_t i = 0; i < gains.size(); ++i) {
    if (gains[i] != expected[i / kRolls * every * kRolls + i % kRolls]) return false;
  }
  return true;
}

/// Argument: best views fused. Two threads.
void evaluate(benchmark::State& state, const GainSavings& savings) {
  const auto views = static_cast<std::size_t>(state.range(0));
  const TsdfSnapshot& map = bench::map_after(views);
  const std::size_t every = every_center(savings);
  const std::vector<Pose> poses = poses_of_every_nth_center(every);
  const Executor executor = Executor::with_threads(2);
  GainConfig config;
  config.savings = savings;
  std::uint64_t cast{0};
  for (auto _ : state) {
    const auto result = evaluate_views(map, kRegion, poses, config, executor);
    if (!result || !same_gains(result->gains, views, every)) return state.SkipWithError("a saving changes gains");
    cast = result->rays_cast;
  }
  state.counters["poses"] = static_cast<double>(poses.size());
  state.counters["rays_cast"] = static_cast<double>(cast);
}

/// Rows that take seconds run once.
void add(const std::string& name, const GainSavings& savings) {
  auto* row =
      benchmark::RegisterBenchmark(name.c_str(), [savings](benchmark::State& state) { evaluate(state, savings); });
  row->ArgName("views")->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond)->UseRealTime();
  if (every_center(savings) > 1 || !savings.region_rays) row->Repetitions(1);
}

void add_all() {
  add("none", GainSavings::none());
  add("all", {});
  GainSavings so_far = GainSavings::none();
  for (const Saving& saving : kSavings) {
    GainSavings alone = GainSavings::none();
    alone.*saving.on = true;
    alone.empty_bricks = alone.empty_bricks || alone.tiles;  // tiles go by bricks, and packets take what tiles leave
    if (!alone.packets && !alone.blocked_camera && !alone.region_rays) add(std::string{"only_"} + saving.name, alone);
    so_far.*saving.on = true;
    if (!alone.blocked_camera) add(std::string{"up_to_"} + saving.name, so_far);
    GainSavings others;
    others.*saving.on = false;
    add(std::string{"without_"} + saving.name, others);
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
