// SPDX-License-Identifier: Apache-2.0
#include "benchmark_differences.hpp"

#include <algorithm>
#include <cmath>

#include "compare_output.hpp"
#include "json_output.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// Mean of a's figures minus b's, over the objects that both have.
MeanEstimate mean_difference(const ObjectFigures& a, const ObjectFigures& b) {
  ObjectFigures differences;
  for (const auto& [object, of_a] : a) {
    const auto of_b = b.find(object);
    if (of_b != b.end()) differences[object] = of_a - of_b->second;
  }
  return over_objects(differences);
}

/// Whether 0 lies outside the interval; nullopt without one.
std::optional<bool> excludes_0(const MeanEstimate& difference) {
  if (!difference.half_width) return std::nullopt;
  return *difference.low() > 0.0 || *difference.high() < 0.0;
}

/// "+7.1 ± 4.2", in points; "0.0" has no sign.
std::string in_points(const MeanEstimate& difference) {
  std::string text = fixed(100.0 * std::abs(difference.mean), 1);
  if (text.find_first_of("123456789") != std::string::npos) text = (difference.mean < 0.0 ? "-" : "+") + text;
  if (difference.half_width) text += " ± " + fixed(100.0 * *difference.half_width, 1);
  return text;
}

std::string excludes_text(const BenchmarkDifference& difference) {
  const std::optional<bool> visible = excludes_0(difference.of_visible);
  if (!visible) return difference.of_all ? "one object has no interval" : "one scene has no interval";
  if (!difference.of_all) return *visible ? "the interval excludes 0" : "the interval holds 0";
  const bool all = excludes_0(*difference.of_all).value_or(false);
  if (*visible == all) return all ? "both intervals exclude 0" : "both intervals hold 0";
  return *visible ? "the interval of visible excludes 0, that of all holds it"
                  : "the interval of visible holds 0, that of all excludes it";
}

json difference_json(const MeanEstimate& difference) {
  json value = estimate_json(difference);
  value["excludes_0"] = optional_json(excludes_0(difference));
  return value;
}

/// Adds mean, low, high and whether the interval excludes 0.
void add_difference(CsvTable& table, const std::optional<MeanEstimate>& difference) {
  const std::optional<bool> excludes = difference ? excludes_0(*difference) : std::nullopt;
  table.add(difference ? std::optional{difference->mean} : std::nullopt)
      .add(difference ? difference->low() : std::nullopt)
      .add(difference ? difference->high() : std::nullopt)
      .add(!excludes   ? ""
           : *excludes ? "yes"
                       : "no");
}

}  // namespace

std::string object_of(const Benchmark& benchmark, const std::string& scene) {
  return benchmark.starts > 1 ? scene.substr(0, scene.rfind('@')) : scene;
}

CurveFigure share_after(std::size_t views, double CoverageShares::*share) {
  return [views, share](const BenchmarkCurve& curve) { return curve.after[views - 1].*share; };
}

ObjectFigures object_figures(const Benchmark& benchmark, std::span<const MeasuredRun> measured,
                             const std::string& strategy, const CurveFigure& figure) {
  std::map<std::string, std::map<std::string, std::vector<double>>> of_object;  // by scene, whose seeds they are
  for (const MeasuredRun& run : measured) {
    if (run.key.strategy != strategy) continue;
    of_object[object_of(benchmark, run.key.scene)][run.key.scene].push_back(figure(run.curve));
  }
  ObjectFigures figures;
  for (const auto& [object, of_scene] : of_object) {
    std::vector<double> of_starts;
    for (const auto& [scene, values] : of_scene) of_starts.push_back(mean(values));
    figures[object] = mean(of_starts);
  }
  return figures;
}

ObjectFigures object_figures(std::span<const CampaignSummary> summaries, const std::string& strategy,
                             std::string_view figure) {
  ObjectFigures figures;
  for (const CampaignSummary& summary : summaries) {
    if (!summary.group.scene || summary.group.strategy != strategy || summary.of(figure).n == 0) continue;
    figures[*summary.group.scene] = summary.of(figure).mean;
  }
  return figures;
}

MeanEstimate over_objects(const ObjectFigures& figures) {
  std::vector<double> values;
  for (const auto& [object, value] : figures) values.push_back(value);
  return estimate_mean(values);
}

std::vector<BenchmarkDifference> object_differences(const Benchmark& benchmark, std::span<const MeasuredRun> measured,
                                                    std::span<const std::string> strategies) {
  std::vector<BenchmarkDifference> differences;
  if (strategies.empty() || measured.empty()) return differences;
  const auto shares = [&](const std::string& strategy, double CoverageShares::*share) {
    return object_figures(benchmark, measured, strategy, share_after(benchmark.views_in_all, share));
  };
  const ObjectFigures visible = shares(strategies.front(), &CoverageShares::of_visible);
  const ObjectFigures all = shares(strategies.front(), &CoverageShares::of_all);
  for (const std::string& other : strategies.subspan(1)) {
    differences.push_back({strategies.front(), other, benchmark.views_in_all,
                           mean_difference(visible, shares(other, &CoverageShares::of_visible)),
                           mean_difference(all, shares(other, &CoverageShares::of_all))});
  }
  return differences;
}

std::vector<BenchmarkDifference> object_differences(const Benchmark& benchmark,
                                                    std::span<const CampaignSummary> summaries,
                                                    std::span<const std::string> strategies) {
  std::vector<BenchmarkDifference> differences;
  if (strategies.empty()) return differences;
  const ObjectFigures first = object_figures(summaries, strategies.front(), "coverage");
  for (const std::string& other : strategies.subspan(1)) {
    const MeanEstimate coverage = mean_difference(first, object_figures(summaries, other, "coverage"));
    if (coverage.n == 0) continue;
    differences.push_back({strategies.front(), other, benchmark.budget, coverage, std::nullopt});
  }
  return differences;
}

std::string differences_text(std::span<const BenchmarkDifference> differences) {
  std::string text;
  for (const BenchmarkDifference& difference : differences) {
    const bool own_scenes = !difference.of_all;
    const std::size_t n = difference.of_visible.n;
    text += difference.method + " beside " + difference.beside + (own_scenes ? ", by scene: " : ", by object: ") +
            in_points(difference.of_visible) + (own_scenes ? " points of coverage" : " points of visible");
    if (difference.of_all) text += ", " + in_points(*difference.of_all) + " of all";
    text += (own_scenes ? " after at most " : " after ") + std::to_string(difference.views) + " views (" +
            std::to_string(n) + (own_scenes ? " scene" : " object") + (n == 1 ? "" : "s") + "); " +
            excludes_text(difference) + '\n';
  }
  const auto intervals = std::count_if(differences.begin(), differences.end(), [](const auto& difference) {
    return difference.of_visible.half_width.has_value();
  });
  if (intervals > 1) text += "these intervals are not corrected for the number of comparisons\n";
  return text;
}

json differences_json(std::span<const BenchmarkDifference> differences) {
  json rows = json::array();
  for (const BenchmarkDifference& difference : differences) {
    json row{{"method", difference.method},
             {"beside", difference.beside},
             {"views", difference.views},
             {"objects", difference.of_visible.n},
             {"of_visible", difference_json(difference.of_visible)}};
    if (difference.of_all) row["of_all"] = difference_json(*difference.of_all);
    rows.push_back(std::move(row));
  }
  return rows;
}

Status write_differences(const std::filesystem::path& folder,
                         std::span<const std::pair<std::string_view, std::string>> about,
                         std::span<const BenchmarkDifference> differences) {
  std::vector<std::string_view> columns;
  for (const auto& [column, value] : about) columns.push_back(column);
  for (const char* column : {"method", "beside", "views", "objects", "of_visible", "of_visible_low", "of_visible_high",
                             "of_visible_excludes_0", "of_all", "of_all_low", "of_all_high", "of_all_excludes_0"}) {
    columns.emplace_back(column);
  }
  CsvTable rows{columns};
  for (const BenchmarkDifference& difference : differences) {
    for (const auto& [column, value] : about) rows.add(value);
    rows.add(difference.method).add(difference.beside);
    rows.add(static_cast<std::uint64_t>(difference.views)).add(static_cast<std::uint64_t>(difference.of_visible.n));
    add_difference(rows, difference.of_visible);
    add_difference(rows, difference.of_all);
    rows.end_row();
  }
  return rows.write(folder / "differences.csv");
}

}  // namespace saccade::cli
