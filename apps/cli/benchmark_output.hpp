// SPDX-License-Identifier: Apache-2.0
#pragma once
// Output of `saccade benchmark`: our strategies and the published ones in one table, as text, CSV and JSON.

#include <filesystem>
#include <nlohmann/json.hpp>
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
[[nodiscard]] BenchmarkTable benchmark_table(const Benchmark& benchmark, const std::vector<MeasuredRun>& measured,
                                             const ComparedRuns& compared, const std::set<std::string>& of_one_seed,
                                             std::size_t planned);

/// Says how the first strategy compares with each published figure at its number of views: short of it, which comes
/// first, or reached. The first view is given and not compared. Nothing is said before all runs are done.
[[nodiscard]] std::vector<std::string> beside_published(const Benchmark& benchmark, const BenchmarkTable& table,
                                                        ObjectSource objects);

/// The table and what goes with it, for people.
[[nodiscard]] std::string benchmark_text(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                         const BenchmarkTable& table);

/// {name, version, objects, objects_from, scenes, runs: {…}, table: […], differences: […], beside_published: […], …}
[[nodiscard]] nlohmann::json benchmark_json(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                            const BenchmarkTable& table);

/// Writes table.csv and differences.csv, and curves.csv for protocols with a rule. io_failure.
[[nodiscard]] Status write_benchmark(const std::filesystem::path& folder, const Benchmark& benchmark,
                                     const BenchmarkPlan& plan, const BenchmarkTable& table,
                                     const std::vector<MeasuredRun>& measured);

}  // namespace saccade::cli
