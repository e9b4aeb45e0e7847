// SPDX-License-Identifier: Apache-2.0
#pragma once
// BenchmarkDifference: how the first strategy of a benchmark differs from each other one, object by object, as text,
// CSV and JSON.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/trial/benchmark.hpp"
#include "saccade/trial/campaign_summary.hpp"

namespace saccade::cli {

/// A run, and how its coverage grew.
struct MeasuredRun {
  CampaignKey key;
  BenchmarkCurve curve;
};

/// Returns the object of a scene of the protocol: "figure" of "figure@12".
[[nodiscard]] std::string object_of(const Benchmark& benchmark, const std::string& scene);

/// Figure of a curve.
using CurveFigure = std::function<double(const BenchmarkCurve& curve)>;
/// Returns the figure that is a share after a number of views. The figure expects a curve with as many.
[[nodiscard]] CurveFigure share_after(std::size_t views, double CoverageShares::*share);

/// A figure of a strategy, by the name of the object. Each object has the mean of its first views, each with the mean
/// of its seeds: starts and seeds of an object are not independent samples of objects.
using ObjectFigures = std::map<std::string, double>;
/// Returns the figure of each object of which the strategy has a run.
[[nodiscard]] ObjectFigures object_figures(const Benchmark& benchmark, std::span<const MeasuredRun> measured,
                                           const std::string& strategy, const CurveFigure& figure);
/// As above, for protocols with scenes of their own, each of which is an object. Expects a name of run_figures().
[[nodiscard]] ObjectFigures object_figures(std::span<const CampaignSummary> summaries, const std::string& strategy,
                                           std::string_view figure);
/// Mean over the objects.
[[nodiscard]] MeanEstimate over_objects(const ObjectFigures& figures);

/// The first strategy beside another one, at the protocol's number of views. Differences are the first strategy's share
/// minus the other's, of the same object; intervals are of their mean over the objects that both have.
struct BenchmarkDifference {
  std::string method;  ///< the first strategy
  std::string beside;  ///< the other one
  std::size_t views{0};
  MeanEstimate of_visible;             ///< coverage, for protocols with scenes of their own
  std::optional<MeanEstimate> of_all;  ///< none for these
};

/// Returns the first strategy's differences from each other one, in their order. `measured` are runs that all
/// strategies have in common. Empty without a second strategy or without runs.
[[nodiscard]] std::vector<BenchmarkDifference> object_differences(const Benchmark& benchmark,
                                                                  std::span<const MeasuredRun> measured,
                                                                  std::span<const std::string> strategies);
/// As above, for protocols with scenes of their own: of coverage at the end.
[[nodiscard]] std::vector<BenchmarkDifference> object_differences(const Benchmark& benchmark,
                                                                  std::span<const CampaignSummary> summaries,
                                                                  std::span<const std::string> strategies);

/// A line for each difference, and one that says that intervals are not corrected, where there are several.
[[nodiscard]] std::string differences_text(std::span<const BenchmarkDifference> differences);

/// [{method, beside, views, objects, of_visible: {n, mean, low, high, excludes_0}, of_all: {…}}]; `excludes_0` is null
/// without an interval.
[[nodiscard]] nlohmann::json differences_json(std::span<const BenchmarkDifference> differences);

/// Writes differences.csv. Its first columns are `about`, with the same values in all rows. io_failure.
[[nodiscard]] Status write_differences(const std::filesystem::path& folder,
                                       std::span<const std::pair<std::string_view, std::string>> about,
                                       std::span<const BenchmarkDifference> differences);

}  // namespace saccade::cli
