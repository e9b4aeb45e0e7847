// SPDX-License-Identifier: Apache-2.0
// The mesh of a growing map: extraction of the whole against an update after one more frame, and after a small region
// was forgotten. 5.8 mm, 640×480, the frames of mapping.
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "frames.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/map/mesh.hpp"

namespace {

using namespace saccade;
using bench::frames;
using bench::kWarmFrames;

Executor executor_of(const benchmark::State& state) {
  return Executor::with_threads(static_cast<std::size_t>(state.range(0)));
}

/// The maps after 40 frames, 41 frames …
const std::vector<TsdfSnapshot>& maps() {
  static const std::vector<TsdfSnapshot> after = [] {
    std::vector<TsdfSnapshot> snapshots{bench::warm_map()};
    TsdfMap map{bench::warm_map()};
    for (std::size_t i = kWarmFrames; i < frames().depth.size(); ++i) {
      const auto done = map.integrate(frames().camera, frames().depth[i], frames().T_world_camera[i], {});
      SACCADE_EXPECTS(done.ok());
      snapshots.push_back(map.snapshot());
    }
    return snapshots;
  }();
  return after;
}

TsdfSnapshot with_a_hole(const TsdfSnapshot& content) {
  TsdfMap map{content};
  SACCADE_EXPECTS(map.forget(Sphere{frames().seen_point(), 0.1}).ok());
  return map.snapshot();
}

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.normals == b.normals && a.colors == b.colors && a.triangles == b.triangles;
}

/// Tells whether following from one map to the next gives the mesh that is extracted anew, and there is one.
bool follows(const TsdfSnapshot& from, const TsdfSnapshot& to, const Executor& executor) {
  LiveMesh live;
  live.update(from, executor);
  live.update(to, executor);
  const TriangleMesh mesh = live.mesh(executor);
  return mesh.triangles.size() > 10000 && same_mesh(mesh, extract_mesh(to, executor));
}

void extract_all(benchmark::State& state) {
  const Executor executor = executor_of(state);
  if (!follows(maps()[0], maps()[1], executor)) return state.SkipWithError("the mesh differs from extraction anew");
  std::size_t i{0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(extract_mesh(maps()[i], executor).triangles.data());
    i = (i + 1) % maps().size();
  }
  LiveMesh live;
  const MeshUpdate update = live.update(maps().back(), executor);
  state.counters["bricks_extracted"] = static_cast<double>(update.bricks_extracted);
  state.counters["triangles"] = static_cast<double>(live.mesh(executor).triangles.size());
}

/// One more frame; `whole`: with the whole mesh of it, not only the bricks that were replaced.
void follow_frames(benchmark::State& state, bool whole) {
  const Executor executor = executor_of(state);
  if (!follows(maps()[0], maps()[1], executor)) return state.SkipWithError("the mesh differs from extraction anew");
  LiveMesh live;
  live.update(maps()[0], executor);
  std::size_t i{0};
  std::size_t extracted{0};
  std::size_t replaced{0};
  for (auto _ : state) {
    if (++i == maps().size()) {
      i = 1;
      live.update(maps()[0], executor);
    }
    const Stopwatch stopwatch;
    const MeshUpdate update = live.update(maps()[i], executor);
    if (whole) benchmark::DoNotOptimize(live.mesh(executor).triangles.data());
    state.SetIterationTime(1e-3 * stopwatch.elapsed_ms());
    extracted += update.bricks_extracted;
    replaced += update.bricks.size();
  }
  state.counters["bricks_extracted"] =
      benchmark::Counter(static_cast<double>(extracted), benchmark::Counter::kAvgIterations);
  state.counters["bricks_replaced"] =
      benchmark::Counter(static_cast<double>(replaced), benchmark::Counter::kAvgIterations);
}
void update_after_frame(benchmark::State& state) { follow_frames(state, false); }
void update_after_frame_and_join(benchmark::State& state) { follow_frames(state, true); }

void update_after_forget(benchmark::State& state) {
  const Executor executor = executor_of(state);
  const std::array<TsdfSnapshot, 2> states{maps().back(), with_a_hole(maps().back())};
  if (!follows(states[0], states[1], executor)) return state.SkipWithError("the mesh differs from extraction anew");
  LiveMesh live;
  live.update(states[0], executor);
  std::size_t i{0};
  for (auto _ : state) {
    i = 1 - i;  // there and back
    if (live.update(states[i], executor).bricks.empty()) return state.SkipWithError("nothing was replaced");
  }
}

void find_changes_after_frame(benchmark::State& state) {
  const Executor executor = executor_of(state);
  std::size_t i{1};
  std::size_t changed{0};
  for (auto _ : state) {
    changed += changed_bricks(maps()[i - 1].grid, maps()[i].grid, executor).size();
    i = i + 1 < maps().size() ? i + 1 : 1;
  }
  if (changed == 0) return state.SkipWithError("nothing changed");
  state.counters["bricks"] = static_cast<double>(maps().back().grid.usage().bricks());
  state.counters["bricks_changed"] =
      benchmark::Counter(static_cast<double>(changed), benchmark::Counter::kAvgIterations);
}

BENCHMARK(extract_all)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(update_after_frame)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK(update_after_frame_and_join)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK(update_after_forget)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(find_changes_after_frame)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
