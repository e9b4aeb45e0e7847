// SPDX-License-Identifier: Apache-2.0
#pragma once
// Output of `saccade benchmark`: our strategies and the published ones in one table, as text, CSV and JSON.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare_output.hpp"
#include "saccade/trial/benchmark.hpp"

namespace saccade::cli {

/// A run, and how its coverage grew.
struct MeasuredRun {
  CampaignKey key;
  BenchmarkCurve curve;
};

/// A line of the table: a strategy of ours at a number of views, or a published figure.
struct BenchmarkRow {
  std::string method;
  double views{0.0};                       ///< the first one included
  std::optional<MeanEstimate> of_visible;  ///< over scenes, each with the mean of its runs
  std::optional<MeanEstimate> of_all;
  std::optional<MeanEstimate> path_m;    ///< for protocols with scenes of their own
  std::optional<MeanEstimate> motion_s;  ///< as path_m
  std::optional<PublishedFigure> published;
};

/// Returns our strategies, at each number of views for which there is a published figure and at the protocol's own,
/// then the published figures.
[[nodiscard]] std::vector<BenchmarkRow> benchmark_table(const Benchmark& benchmark,
                                                        const std::vector<MeasuredRun>& measured,
                                                        const ComparedRuns& compared);

/// Says how the first strategy compares with each published figure at its number of views: reached, or short of it.
/// The first view is given and not compared.
[[nodiscard]] std::vector<std::string> beside_published(const Benchmark& benchmark,
                                                        const std::vector<BenchmarkRow>& table, bool stand_ins);

/// The table and what goes with it, for people.
[[nodiscard]] std::string benchmark_text(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                         const std::vector<BenchmarkRow>& table);

/// {name, version, objects, stand_ins, table: […], beside_published: […]}
[[nodiscard]] nlohmann::json benchmark_json(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                            const std::vector<BenchmarkRow>& table);

/// Writes table.csv, and curves.csv for protocols with a rule. io_failure.
[[nodiscard]] Status write_benchmark(const std::filesystem::path& folder, const Benchmark& benchmark,
                                     const BenchmarkPlan& plan, const std::vector<BenchmarkRow>& table,
                                     const std::vector<MeasuredRun>& measured);

/// The protocols, a line each.
[[nodiscard]] std::string benchmark_list();
[[nodiscard]] nlohmann::json benchmark_list_json();

}  // namespace saccade::cli
