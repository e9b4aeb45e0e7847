// SPDX-License-Identifier: Apache-2.0
#include "benchmark_output.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "json_output.hpp"
#include "saccade/io/files/csv.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// Numbers of views at which our strategies are told: those of published figures, and the protocol's own.
std::set<std::size_t> told_views(const Benchmark& benchmark) {
  std::set<std::size_t> views{benchmark.views_in_all};
  for (const PublishedFigure& figure : benchmark.published) {
    views.insert(std::min(benchmark.views_in_all, static_cast<std::size_t>(figure.views)));
  }
  return views;
}

std::vector<std::string> strategies_in(const ComparedRuns& compared) {
  std::vector<std::string> strategies;
  for (const CampaignSummary& summary : compared.summaries) {
    const std::string& name = summary.group.strategy;
    if (std::find(strategies.begin(), strategies.end(), name) == strategies.end()) strategies.push_back(name);
  }
  return strategies;
}

/// Mean over scenes, each with the mean of its runs: seeds of one scene are not samples of scenes.
MeanEstimate over_scenes(const std::vector<MeasuredRun>& measured, const std::string& strategy, std::size_t views,
                         double CoverageShares::*share) {
  std::map<std::string, std::vector<double>> of_scene;
  for (const MeasuredRun& run : measured) {
    if (run.key.strategy == strategy) of_scene[run.key.scene].push_back(run.curve.after[views - 1].*share);
  }
  std::vector<double> means;
  for (const auto& [scene, values] : of_scene) means.push_back(mean(values));
  return estimate_mean(means);
}

BenchmarkRow row_of_own_scenes(const ComparedRuns& compared, const std::string& strategy) {
  BenchmarkRow row;
  row.method = strategy;
  for (const CampaignSummary& summary : compared.summaries) {
    // The summary over all scenes comes after those of each, and replaces them; one scene has none over all.
    if (summary.group.strategy != strategy) continue;
    row.views = summary.of("views").mean;
    row.of_visible = summary.of("coverage");
    row.path_m = summary.of("path_m");
    row.motion_s = summary.of("motion_s");
  }
  return row;
}

std::string shown(const std::optional<MeanEstimate>& estimate, double scale, int decimals) {
  if (!estimate || estimate->n == 0) return "-";
  std::string text = fixed(scale * estimate->mean, decimals);
  if (estimate->half_width) text += " ± " + fixed(scale * *estimate->half_width, decimals);
  return text;
}

std::string padded_to(std::string text, std::size_t width) {
  const auto characters = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
  text.append(characters < width ? width - characters : 1, ' ');
  return text;
}

/// Returns the publications of a protocol, each once, in their order.
std::vector<std::string> sources_of(const Benchmark& benchmark) {
  std::vector<std::string> sources;
  for (const PublishedFigure& figure : benchmark.published) {
    if (std::find(sources.begin(), sources.end(), figure.source) == sources.end()) sources.push_back(figure.source);
  }
  return sources;
}

/// Returns the number of a source among them, from 1.
std::size_t source_number(const Benchmark& benchmark, const std::string& source) {
  const std::vector<std::string> sources = sources_of(benchmark);
  return static_cast<std::size_t>(std::find(sources.begin(), sources.end(), source) - sources.begin()) + 1;
}

std::string what_counts(const Benchmark& benchmark) {
  if (!benchmark.rule) return "coverage: share of the observable surface that the map's mesh has within one voxel";
  const std::string size = millimetres(benchmark.rule->size_m);
  if (benchmark.rule->kind == CoverageRule::Kind::voxels) {
    return "coverage: share of the voxels of " + size + " with surface in which a point was measured";
  }
  return "coverage: share of the surface's points with a measured point within " + size;
}

std::string objects_text(const BenchmarkPlan& plan) { return joined(plan.scenes, ", ", &Scene::name); }

/// Width of the first column.
std::size_t method_width(const std::vector<BenchmarkRow>& table) {
  std::size_t width = 0;
  for (const BenchmarkRow& row : table) width = std::max(width, row.method.size() + 2);
  return width;
}

json row_json(const BenchmarkRow& row) {
  json value{{"method", row.method}, {"views", row.views}, {"published", row.published.has_value()}};
  const auto add = [&value](const char* name, const std::optional<MeanEstimate>& estimate) {
    if (estimate) value[name] = estimate_json(*estimate);
  };
  add("of_visible", row.of_visible);
  add("of_all", row.of_all);
  add("path_m", row.path_m);
  add("motion_s", row.motion_s);
  if (row.published) {
    value["coverage"] = row.published->coverage;
    value["year"] = row.published->year > 0 ? json(row.published->year) : json(nullptr);
    value["source"] = row.published->source;
    value["object"] = row.published->object;
    value["differs"] = row.published->differs;
  }
  return value;
}

}  // namespace

std::vector<BenchmarkRow> benchmark_table(const Benchmark& benchmark, const std::vector<MeasuredRun>& measured,
                                          const ComparedRuns& compared) {
  std::vector<BenchmarkRow> table;
  for (const std::string& strategy : strategies_in(compared)) {
    if (!benchmark.rule) {
      table.push_back(row_of_own_scenes(compared, strategy));
      continue;
    }
    for (const std::size_t views : told_views(benchmark)) {
      BenchmarkRow row;
      row.method = strategy;
      row.views = static_cast<double>(views);
      row.of_visible = over_scenes(measured, strategy, views, &CoverageShares::of_visible);
      row.of_all = over_scenes(measured, strategy, views, &CoverageShares::of_all);
      table.push_back(std::move(row));
    }
  }
  for (const PublishedFigure& figure : benchmark.published) {
    BenchmarkRow row;
    row.method = figure.method;
    row.views = figure.views;
    row.published = figure;
    table.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> beside_published(const Benchmark& benchmark, const std::vector<BenchmarkRow>& table,
                                          bool stand_ins) {
  std::vector<std::string> lines;
  if (table.empty() || table.front().published) return lines;
  const std::string& ours = table.front().method;
  for (const PublishedFigure& figure : benchmark.published) {
    if (figure.views <= 1.0) continue;  // the first view is given, not chosen
    const auto at = std::min(static_cast<double>(benchmark.views_in_all), std::floor(figure.views));
    const auto row = std::find_if(table.begin(), table.end(), [&](const BenchmarkRow& candidate) {
      return !candidate.published && candidate.method == ours && candidate.views == at;
    });
    if (row == table.end() || !row->of_all || !row->of_visible) continue;
    const double gap = row->of_all->mean - figure.coverage;
    std::string line = ours + " after " + fixed(at, 0) + " views: " + fixed(100.0 * row->of_visible->mean, 1) +
                       " % of what the views can show, " + fixed(100.0 * row->of_all->mean, 1) + " % of all; " +
                       figure.method + " " + fixed(100.0 * figure.coverage, 1) + " % after " +
                       fixed(figure.views, figure.views == std::floor(figure.views) ? 0 : 1) + ": ";
    line += gap >= 0.0 ? "not below it" : "short of it by " + fixed(-100.0 * gap, 1) + " points of all";
    if (stand_ins) line += " (other objects)";
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string benchmark_text(const Benchmark& benchmark, const BenchmarkPlan& plan,
                           const std::vector<BenchmarkRow>& table) {
  constexpr std::size_t kColumn{16};
  std::ostringstream text;
  text << "benchmark " << benchmark.name << ", version " << benchmark.version << ": " << benchmark.text << '\n';
  text << "objects   " << objects_text(plan) << '\n';
  if (plan.stand_ins) {
    text << "STAND-INS: these objects are made by rule and are not those of the publications, so our figures and "
            "theirs cannot be compared;\n          --objects DIR takes the published meshes\n";
  }
  text << what_counts(benchmark) << "\n\n";
  const std::size_t width = method_width(table);
  text << padded_to("method", width) << padded_to("views", 8);
  if (benchmark.rule) {
    text << padded_to("of visible, %", kColumn) << padded_to("of all, %", kColumn) << "source\n";
  } else {
    text << padded_to("coverage, %", kColumn) << padded_to("path, m", kColumn) << padded_to("motion, s", kColumn)
         << "source\n";
  }
  for (const BenchmarkRow& row : table) {
    text << padded_to(row.method, width) << padded_to(fixed(row.views, row.views == std::floor(row.views) ? 0 : 1), 8);
    if (row.published) {
      text << padded_to("", kColumn) << padded_to(fixed(100.0 * row.published->coverage, 1), kColumn) << "["
           << source_number(benchmark, row.published->source) << "] " << row.published->object << '\n';
      continue;
    }
    text << padded_to(shown(row.of_visible, 100.0, 1), kColumn);
    if (benchmark.rule) {
      text << padded_to(shown(row.of_all, 100.0, 1), kColumn);
    } else {
      text << padded_to(shown(row.path_m, 1.0, 2), kColumn) << padded_to(shown(row.motion_s, 1.0, 1), kColumn);
    }
    text << "this run\n";
  }
  text << '\n';
  if (!benchmark.not_published.empty()) text << "published: none: " << benchmark.not_published << '\n';
  std::size_t number = 0;
  for (const std::string& source : sources_of(benchmark)) text << '[' << ++number << "] " << source << '\n';
  std::set<std::string> told;
  for (const PublishedFigure& figure : benchmark.published) {
    if (!told.insert(figure.differs).second) continue;
    text << "what differs from [" << source_number(benchmark, figure.source) << "]: " << figure.differs << '\n';
  }
  for (const std::string& line : beside_published(benchmark, table, plan.stand_ins)) text << line << '\n';
  return text.str();
}

json benchmark_json(const Benchmark& benchmark, const BenchmarkPlan& plan, const std::vector<BenchmarkRow>& table) {
  json rows = json::array();
  for (const BenchmarkRow& row : table) rows.push_back(row_json(row));
  json objects = json::array();
  for (const Scene& scene : plan.scenes) objects.push_back(scene.name);
  return {{"name", benchmark.name},
          {"version", benchmark.version},
          {"text", benchmark.text},
          {"measure", what_counts(benchmark)},
          {"objects", std::move(objects)},
          {"stand_ins", plan.stand_ins},
          {"views_in_all", benchmark.views_in_all},
          {"table", std::move(rows)},
          {"beside_published", beside_published(benchmark, table, plan.stand_ins)},
          {"not_published", benchmark.not_published}};
}

Status write_benchmark(const std::filesystem::path& folder, const Benchmark& benchmark, const BenchmarkPlan& plan,
                       const std::vector<BenchmarkRow>& table, const std::vector<MeasuredRun>& measured) {
  CsvTable rows{{"benchmark", "version", "stand_ins", "method", "views", "of_visible", "of_all", "objects", "path_m",
                 "motion_s", "published", "year", "source", "object", "differs"}};
  const auto mean_of = [](const std::optional<MeanEstimate>& estimate) {
    return estimate && estimate->n > 0 ? std::optional{estimate->mean} : std::nullopt;
  };
  for (const BenchmarkRow& row : table) {
    const std::optional<PublishedFigure>& figure = row.published;
    rows.add(benchmark.name).add(static_cast<std::uint64_t>(benchmark.version));
    rows.add(plan.stand_ins ? "yes" : "no").add(row.method).add(row.views).add(mean_of(row.of_visible));
    rows.add(mean_of(row.of_all));
    rows.add(row.of_visible ? std::optional{static_cast<double>(row.of_visible->n)} : std::nullopt);
    rows.add(mean_of(row.path_m)).add(mean_of(row.motion_s));
    rows.add(figure ? std::optional{figure->coverage} : std::nullopt);
    rows.add(figure && figure->year > 0 ? std::to_string(figure->year) : "").add(figure ? figure->source : "");
    rows.add(figure ? figure->object : "").add(figure ? figure->differs : "");
    rows.end_row();
  }
  SACCADE_CHECK(rows.write(folder / "table.csv"));
  if (!benchmark.rule) return {};
  CsvTable curves{{"object", "strategy", "seed", "view", "of_visible", "of_all", "views_taken"}};
  for (const MeasuredRun& run : measured) {
    for (std::size_t i = 0; i < run.curve.after.size(); ++i) {
      curves.add(run.key.scene).add(run.key.strategy).add(run.key.seed).add(static_cast<std::uint64_t>(i + 1));
      curves.add(run.curve.after[i].of_visible).add(run.curve.after[i].of_all);
      curves.add(static_cast<std::uint64_t>(run.curve.taken)).end_row();
    }
  }
  return curves.write(folder / "curves.csv");
}

std::string benchmark_list() {
  std::size_t width = 0;
  for (const Benchmark& benchmark : benchmarks()) width = std::max(width, benchmark.name.size() + 2);
  std::string text;
  for (const Benchmark& benchmark : benchmarks()) text += padded_to(benchmark.name, width) + benchmark.text + '\n';
  return text;
}

json benchmark_list_json() {
  json all = json::array();
  for (const Benchmark& benchmark : benchmarks()) {
    json meshes = json::array();
    for (const BenchmarkMesh& mesh : benchmark.meshes) {
      meshes.push_back({{"file", mesh.file}, {"md5", mesh.md5}, {"from", mesh.from}});
    }
    all.push_back({{"name", benchmark.name},
                   {"version", benchmark.version},
                   {"text", benchmark.text},
                   {"meshes", std::move(meshes)},
                   {"stand_ins", benchmark.stand_ins}});
  }
  return {{"benchmarks", std::move(all)}};
}

}  // namespace saccade::cli
