// SPDX-License-Identifier: Apache-2.0
#pragma once
// Output of `saccade benchmark`: our strategies and the published ones in one table, as text, CSV and JSON.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benchmark_table.hpp"

namespace saccade::cli {

/// Says how the first strategy compares with each published figure at its number of views: short of it, which comes
/// first, or reached. The first view is given and not compared. Nothing is said before all runs are done.
[[nodiscard]] std::vector<std::string> beside_published(const Benchmark& benchmark, const BenchmarkTable& table);

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
