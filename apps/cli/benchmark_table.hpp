// SPDX-License-Identifier: Apache-2.0
#pragma once
// Table of `saccade benchmark`: our strategies and the published figures, line by line.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "benchmark_differences.hpp"
#include "compare_output.hpp"
#include "saccade/trial/benchmark.hpp"

namespace saccade::cli {

/// A line of the table: a strategy of ours at a number of views, or a published figure. Means are over objects
/// (ObjectFigures).
struct BenchmarkRow {
  std::string method;
  double views{0.0};                  ///< the first one included
  std::optional<MeanEstimate> taken;  ///< views taken; a run ends before where no view gains anything
  std::optional<MeanEstimate> of_visible;
  std::optional<MeanEstimate> of_all;
  std::optional<MeanEstimate> path_m;    ///< for protocols with scenes of their own
  std::optional<MeanEstimate> motion_s;  ///< as path_m
  std::optional<PublishedFigure> published;
  bool same_object{false};  ///< says has_same_object() of a published figure
};

struct BenchmarkTable {
  std::vector<BenchmarkRow> rows;
  std::vector<BenchmarkDifference> differences;  ///< over the runs that the rows are over
  std::size_t planned{0};                        ///< runs of the benchmark
  std::size_t done{0};                           ///< runs that are done
  std::size_t each_strategy{0};                  ///< pairs of scene and seed that the rows are over

  [[nodiscard]] bool is_complete() const { return done == planned; }
};

/// Returns the objects of the scenes, each once, in their order.
[[nodiscard]] std::vector<std::string> objects_of(const Benchmark& benchmark, const std::vector<Scene>& scenes);

/// Returns our strategies, at each number of views for which there is a published figure and at the protocol's own,
/// then the published figures. The rows of strategies are over the runs (scene and seed) that all of them have, so that
/// those of an interrupted benchmark are about the same objects. A strategy without any run has no rows.
/// @param of_one_seed  strategies whose runs are the same with every seed; they have a run for any seed of a scene
/// @param planned  runs of the benchmark
[[nodiscard]] BenchmarkTable benchmark_table(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                             const std::vector<MeasuredRun>& measured, const ComparedRuns& compared,
                                             const std::set<std::string>& of_one_seed, std::size_t planned);

}  // namespace saccade::cli
