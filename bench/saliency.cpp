// SPDX-License-Identifier: Apache-2.0
// Measures of segments (eq. 3.8–3.11) on the surface of a mapped table with clutter, beside isolation by going through
// all points in the cells around each one; and a distance so large that every segment is near another.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <unordered_map>

#include "saccade/attention/internal/isolation.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/cloud/cell_index.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/segment/lccp.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;

constexpr double kVoxel_m{0.0036};  // about half a million surface points

/// With `scraps`, one cell of 3 cm in fifty is a segment of its own, as where a map is noisy.
SegmentedPoints make_segments(bool scraps) {
  const Executor executor = Executor::with_threads(0);
  bench::TableMapConfig config;
  config.voxel_size_m = kVoxel_m;
  const TriangleMesh mesh = extract_mesh(bench::table_map(config), executor);
  const SupervoxelResult supervoxels =
      find_supervoxels({mesh.vertices, mesh.normals, {}}, SupervoxelConfig{}, executor).value();
  LccpResult segments = segment_by_convexity(supervoxels).value();
  if (scraps) {
    constexpr double kScrap_m{0.03};
    constexpr std::uint32_t kOneIn{50};
    CellIndex index;
    const auto first_scrap = static_cast<std::uint32_t>(segments.segments);
    for (std::size_t i = 0; i < segments.labels.size(); ++i) {
      const std::uint32_t cell = index.insert(cell_at(mesh.vertices[i], kScrap_m));
      if (cell % kOneIn == 0) segments.labels[i] = first_scrap + cell / kOneIn;
    }
    segments.segments += index.cells().size() / kOneIn + 1;
  }
  return SegmentedPoints::create(mesh.vertices, segments.labels, segments.segments).value();
}

const SegmentedPoints& table_segments(bool scraps) {
  static const SegmentedPoints clean = make_segments(false);
  static const SegmentedPoints with_scraps = make_segments(true);
  return scraps ? with_scraps : clean;
}

/// By a hash of cells as long as the distance, every point against all those around it until one is foreign and near.
std::vector<std::uint8_t> isolated_by_cells(const SegmentedPoints& points, double distance_m) {
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
  const auto positions_m = points.positions_m();
  for (std::uint32_t i = 0; i < positions_m.size(); ++i) {
    cells[cell_at(positions_m[i], distance_m * (1.0 + 1e-6))].push_back(i);
  }
  std::vector<std::uint8_t> isolated(positions_m.size(), 1);
  const auto meets = [&](std::uint32_t i, std::uint64_t cell) {
    const auto found = cells.find(cell);
    if (found == cells.end()) return false;
    for (const std::uint32_t other : found->second) {
      if (points.segment_of()[other] == points.segment_of()[i]) continue;
      const Eigen::Vector3d between = positions_m[i].cast<double>() - positions_m[other].cast<double>();
      if (between.squaredNorm() <= distance_m * distance_m) return true;
    }
    return false;
  };
  for (const auto& [cell, members] : cells) {
    for (const std::uint32_t i : members) {
      bool near = meets(i, cell);
      for (const std::uint64_t offset : neighbour_offsets()) near = near || meets(i, cell + offset);
      isolated[i] = near ? 0 : 1;
    }
  }
  return isolated;
}

void count_up(benchmark::State& state, const SegmentedPoints& points, const std::vector<std::uint8_t>& isolated) {
  state.counters["points"] = static_cast<double>(isolated.size());
  state.counters["segments"] = static_cast<double>(points.segments());
  state.counters["isolated"] = static_cast<double>(std::count(isolated.begin(), isolated.end(), std::uint8_t{1}));
}

void isolation(benchmark::State& state) {
  const double distance_m = 1e-3 * static_cast<double>(state.range(0));
  const SegmentedPoints& points = table_segments(state.range(1) != 0);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(2)));
  std::vector<std::uint8_t> isolated;
  for (auto _ : state) isolated = isolated_points(points, distance_m, executor);
  if (state.range(0) == 20 && isolated != isolated_by_cells(points, distance_m)) {
    state.SkipWithError("not what all points say");
  }
  count_up(state, points, isolated);
}
BENCHMARK(isolation)
    ->ArgNames({"mm", "scraps", "threads"})
    ->ArgsProduct({{5, 20, 100}, {0, 1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void isolation_by_cells(benchmark::State& state) {
  constexpr double kDistance_m{0.02};
  const SegmentedPoints& points = table_segments(state.range(0) != 0);
  std::vector<std::uint8_t> isolated;
  for (auto _ : state) isolated = isolated_by_cells(points, kDistance_m);
  count_up(state, points, isolated);
}
BENCHMARK(isolation_by_cells)->ArgName("scraps")->Arg(0)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

/// All that saccade segment counts as saliency.
void saliency(benchmark::State& state) {
  const SegmentedPoints& from = table_segments(state.range(0) != 0);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  std::vector<Saliency> saliencies;
  for (auto _ : state) {
    const SegmentedPoints points =
        SegmentedPoints::create(from.positions_m(), from.segment_of(), from.segments()).value();
    const std::vector<SegmentMeasures> measures = measure_segments(points, {}, executor).value();
    saliencies = objectness()({points, measures, {}});
  }
  if (saliencies.size() != from.segments()) state.SkipWithError("not one saliency per segment");
  state.counters["points"] = static_cast<double>(from.positions_m().size());
}
BENCHMARK(saliency)
    ->ArgNames({"scraps", "threads"})
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
