// SPDX-License-Identifier: Apache-2.0
// Guidance for annotators, on a labelled cloud (mOSD) and on one of ten million points: seeds from labels, margins, and
// the next best click.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/annotation_margin.hpp"
#include "saccade/annotate/label_seeds.hpp"
#include "support/labelled_clouds.hpp"
#include "support/places.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kControlPoints{90};
constexpr std::uint32_t kLabels{9};

/// A square lattice with ripples, for where there are no recorded clouds, and for many points.
PointCloud lattice(std::size_t side) {
  PointCloud cloud;
  for (std::size_t i = 0; i < side * side; ++i) {
    const auto x = static_cast<float>(i % side) / static_cast<float>(side);
    const auto y = static_cast<float>(i / side) / static_cast<float>(side);
    cloud.positions_m.emplace_back(x, y, 0.05F * std::sin(20.0F * x) * std::sin(20.0F * y));
  }
  return cloud;
}

const PointCloud& cloud() {
  static const PointCloud chosen = [] {
    PointCloud points;
    const std::vector<test::LabelledCloud> clouds = test::labelled_clouds(test::shared_data());
    if (clouds.empty()) return lattice(412);
    for (const Eigen::Vector3f& p_m : clouds.front().cloud.positions_m) {
      if (p_m.allFinite()) points.positions_m.push_back(p_m);
    }
    return points;
  }();
  return chosen;
}

std::shared_ptr<const Neighbourhood> graph_of(const PointCloud& points) {
  return std::make_shared<const Neighbourhood>(Neighbourhood::build(points, {}, Executor::with_threads(2)).value());
}

Annotation with_random_control_points(const std::shared_ptr<const Neighbourhood>& graph) {
  Annotation annotation{graph};
  std::mt19937 random{1};
  for (std::uint32_t i = 0; i < kControlPoints; ++i) {
    const auto point = static_cast<std::uint32_t>(random() % graph->size());
    annotation.apply({1, SetControlPoints{{point}, 1 + i % kLabels, 0.0}});
  }
  return annotation;
}

const std::shared_ptr<const Neighbourhood>& graph() {
  static const std::shared_ptr<const Neighbourhood> built = graph_of(cloud());
  return built;
}

void measure_margins(benchmark::State& state, const Annotation& annotation) {
  std::vector<float> margins;
  for (auto _ : state) margins = label_margins(annotation);
  for (const ControlPoint& control : annotation.control_points()) {
    if (margins[control.point] != 1.0F) state.SkipWithError("a control point is in doubt");
  }
  state.counters["points"] = static_cast<double>(margins.size());
}

void margins_90(benchmark::State& state) { measure_margins(state, with_random_control_points(graph())); }
void margins_90_of_10_million(benchmark::State& state) {
  measure_margins(state, with_random_control_points(graph_of(lattice(3163))));
}

void click(benchmark::State& state) {
  const Annotation annotation = with_random_control_points(graph());
  const std::vector<float> margins = label_margins(annotation);
  const std::vector<std::uint8_t> ends = cloud_ends(*graph(), cloud().positions_m, {});
  std::optional<BestClick> best;
  for (auto _ : state) best = next_best_click(annotation, margins, ends);
  if (!best || best->gain != click_gain(annotation, margins, best->point)) state.SkipWithError("another gain");
}

/// Cells of a grid in the plane x, y, as many as a segmentation has segments.
void seeds_of_300_segments(benchmark::State& state) {
  constexpr int kCells{17};
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p_m : cloud().positions_m) box.extend(p_m);
  std::vector<std::uint32_t> labels;
  for (const Eigen::Vector3f& p_m : cloud().positions_m) {
    const Eigen::Array3f at = (p_m - box.min()).array() / box.sizes().array() * static_cast<float>(kCells);
    const auto cell = std::min(static_cast<int>(at.x()), kCells - 1) * kCells + static_cast<int>(at.y());
    labels.push_back(1U + static_cast<std::uint32_t>(cell));
  }
  LabelSeeds seeds;
  for (auto _ : state) seeds = label_seeds(graph(), cloud(), labels, {}).value();
  std::size_t count{0};
  for (const SetControlPoints& action : seeds.actions) count += action.points.size();
  const double share = static_cast<double>(seeds.reproduced) / static_cast<double>(seeds.points);
  if (share < 0.95) state.SkipWithError("too little is reproduced");
  state.counters["segments"] = static_cast<double>(seeds.actions.size());
  state.counters["seeds"] = static_cast<double>(count);
  state.counters["share"] = share;
}

BENCHMARK(margins_90)->Unit(benchmark::kMillisecond);
BENCHMARK(margins_90_of_10_million)->Unit(benchmark::kMillisecond);
BENCHMARK(click)->Unit(benchmark::kMillisecond);
BENCHMARK(seeds_of_300_segments)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
