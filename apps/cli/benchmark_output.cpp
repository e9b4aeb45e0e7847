// SPDX-License-Identifier: Apache-2.0
#include "benchmark_output.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "json_output.hpp"
#include "saccade/io/files/csv.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

std::string shown(const std::optional<MeanEstimate>& estimate, double scale, int decimals) {
  if (!estimate || estimate->n == 0) return "-";
  std::string text = fixed(scale * estimate->mean, decimals);
  if (estimate->half_width) text += " ± " + fixed(scale * *estimate->half_width, decimals);
  return text;
}

/// "12", or "12.2" of a mean.
std::string views_text(double views) { return fixed(views, views == std::floor(views) ? 0 : 1); }

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

std::string objects_text(const Benchmark& benchmark, const BenchmarkPlan& plan) {
  const std::vector<std::string> objects = objects_of(benchmark, plan.scenes);
  std::string text = joined(objects);
  if (plan.scenes.size() > objects.size()) {
    text += "; begun from " + std::to_string(plan.scenes.size()) + " first views in all";
  }
  return text;
}

/// Says why our figures and the published ones are about different objects.
std::string other_objects_text(ObjectSource objects) {
  if (objects == ObjectSource::own) {
    return "OTHER OBJECTS: these are not those of the publications, so our figures and theirs cannot be compared\n";
  }
  return "STAND-INS: these objects are made by rule and are not those of the publications, so our figures and theirs "
         "cannot be compared;\n          --objects DIR takes the published meshes, --meshes LIST any others\n";
}

/// Says what the table of an interrupted benchmark is over.
std::string incomplete_text(const BenchmarkTable& table) {
  std::string text = "INCOMPLETE: " + std::to_string(table.done) + " of " + std::to_string(table.planned) +
                     " runs so far; nothing is said beside published figures\n          ";
  if (table.each_strategy == 0) return text + "there is no object that all strategies with runs have in common yet\n";
  return text + "the table has " + std::to_string(table.each_strategy) + (table.each_strategy == 1 ? " run" : " runs") +
         " of each strategy: the objects, first views and seeds that all strategies with runs have in common; a run "
         "that no seed changes counts for each\n";
}

/// Width of the first column.
std::size_t method_width(const BenchmarkTable& table) {
  std::size_t width = 0;
  for (const BenchmarkRow& row : table.rows) width = std::max(width, row.method.size() + 2);
  return width;
}

void print_rows(std::ostream& text, const Benchmark& benchmark, const BenchmarkTable& table) {
  constexpr std::size_t kViews{8};
  constexpr std::size_t kColumn{16};
  const std::size_t width = method_width(table);
  text << padded_to("method", width) << padded_to("views", kViews);
  if (benchmark.rule) {
    text << padded_to("taken", kViews) << padded_to("of visible, %", kColumn) << padded_to("of all, %", kColumn);
  } else {
    text << padded_to("coverage, %", kColumn) << padded_to("path, m", kColumn) << padded_to("motion, s", kColumn);
  }
  text << "source\n";
  for (const BenchmarkRow& row : table.rows) {
    text << padded_to(row.method, width) << padded_to(views_text(row.views), kViews);
    if (row.published) {
      text << padded_to("", kViews) << padded_to("", kColumn)
           << padded_to(fixed(100.0 * row.published->coverage, 1), kColumn) << "["
           << source_number(benchmark, row.published->source) << "] " << row.published->object << '\n';
      continue;
    }
    if (benchmark.rule) {
      text << padded_to(row.taken ? fixed(row.taken->mean, 1) : "-", kViews)
           << padded_to(shown(row.of_visible, 100.0, 1), kColumn) << padded_to(shown(row.of_all, 100.0, 1), kColumn);
    } else {
      text << padded_to(shown(row.of_visible, 100.0, 1), kColumn) << padded_to(shown(row.path_m, 1.0, 2), kColumn)
           << padded_to(shown(row.motion_s, 1.0, 1), kColumn);
    }
    text << "this run\n";
  }
}

json row_json(const BenchmarkRow& row) {
  json value{{"method", row.method}, {"views", row.views}, {"published", row.published.has_value()}};
  const auto add = [&value](const char* name, const std::optional<MeanEstimate>& estimate) {
    if (estimate) value[name] = estimate_json(*estimate);
  };
  add("views_taken", row.taken);
  add("of_visible", row.of_visible);
  add("of_all", row.of_all);
  add("path_m", row.path_m);
  add("motion_s", row.motion_s);
  if (row.published) {
    value["coverage"] = row.published->coverage;
    value["year"] = row.published->year > 0 ? json(row.published->year) : json(nullptr);
    value["source"] = row.published->source;
    value["object"] = row.published->object;
    value["same_object"] = row.same_object;
    value["differs"] = row.published->differs;
  }
  return value;
}

}  // namespace

std::vector<std::string> beside_published(const Benchmark& benchmark, const BenchmarkTable& table) {
  if (!table.is_complete() || table.rows.empty() || table.rows.front().published) return {};
  const std::string& ours = table.rows.front().method;
  std::vector<std::string> short_of;
  std::vector<std::string> reached;
  for (const BenchmarkRow& told : table.rows) {
    if (!told.published || told.views <= 1.0) continue;  // the first view is given, not chosen
    const PublishedFigure& figure = *told.published;
    const auto at = std::min(static_cast<double>(benchmark.views_in_all), std::floor(figure.views));
    const auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const BenchmarkRow& candidate) {
      return !candidate.published && candidate.method == ours && candidate.views == at;
    });
    if (row == table.rows.end() || !row->of_all || !row->of_visible || !row->taken) continue;
    const double gap = row->of_all->mean - figure.coverage;
    std::string line = ours + " after " + fixed(at, 0) + " views";
    if (row->taken->mean < at) line += " (" + fixed(row->taken->mean, 1) + " taken)";
    line += ": " + fixed(100.0 * row->of_visible->mean, 1) + " % of what the views can show, " +
            fixed(100.0 * row->of_all->mean, 1) + " % of all; " + figure.method + " " +
            fixed(100.0 * figure.coverage, 1) + " % after " + views_text(figure.views) + ": ";
    line += gap >= 0.0 ? "not below it" : "short of it by " + fixed(-100.0 * gap, 1) + " points of all";
    if (!told.same_object) line += " (other objects)";
    (gap >= 0.0 ? reached : short_of).push_back(std::move(line));
  }
  short_of.insert(short_of.end(), reached.begin(), reached.end());
  return short_of;
}

std::string benchmark_text(const Benchmark& benchmark, const BenchmarkPlan& plan, const BenchmarkTable& table) {
  std::ostringstream text;
  text << "benchmark " << benchmark.name << ", version " << benchmark.version << ": " << benchmark.text << '\n';
  text << "objects   " << objects_text(benchmark, plan) << '\n';
  if (plan.objects != ObjectSource::published) text << other_objects_text(plan.objects);
  if (!table.is_complete()) text << incomplete_text(table);
  text << what_counts(benchmark) << "\n\n";
  print_rows(text, benchmark, table);
  text << '\n' << differences_text(table.differences);
  if (!benchmark.not_published.empty()) text << "published: none: " << benchmark.not_published << '\n';
  std::size_t number = 0;
  for (const std::string& source : sources_of(benchmark)) text << '[' << ++number << "] " << source << '\n';
  std::set<std::string> told;
  for (const PublishedFigure& figure : benchmark.published) {
    if (!told.insert(figure.differs).second) continue;
    text << "what differs from [" << source_number(benchmark, figure.source) << "]: " << figure.differs << '\n';
  }
  for (const std::string& line : beside_published(benchmark, table)) text << line << '\n';
  return text.str();
}

json benchmark_json(const Benchmark& benchmark, const BenchmarkPlan& plan, const BenchmarkTable& table) {
  json rows = json::array();
  for (const BenchmarkRow& row : table.rows) rows.push_back(row_json(row));
  json scenes = json::array();
  for (const Scene& scene : plan.scenes) scenes.push_back(scene.name);
  return {{"name", benchmark.name},
          {"version", benchmark.version},
          {"text", benchmark.text},
          {"measure", what_counts(benchmark)},
          {"objects", objects_of(benchmark, plan.scenes)},
          {"scenes", std::move(scenes)},
          {"objects_from", kObjectSourceNames.of(plan.objects)},
          {"views_in_all", benchmark.views_in_all},
          {"runs", {{"planned", table.planned}, {"done", table.done}, {"each_strategy", table.each_strategy}}},
          {"complete", table.is_complete()},
          {"table", std::move(rows)},
          {"differences", differences_json(table.differences)},
          {"beside_published", beside_published(benchmark, table)},
          {"not_published", benchmark.not_published}};
}

Status write_benchmark(const std::filesystem::path& folder, const Benchmark& benchmark, const BenchmarkPlan& plan,
                       const BenchmarkTable& table, const std::vector<MeasuredRun>& measured) {
  const std::vector<std::pair<std::string_view, std::string>> about{
      {"benchmark", benchmark.name},
      {"version", std::to_string(benchmark.version)},
      {"objects_from", std::string{kObjectSourceNames.of(plan.objects)}},
      {"complete", table.is_complete() ? "yes" : "no"}};
  std::vector<std::string_view> columns;
  for (const auto& [column, value] : about) columns.push_back(column);
  for (const char* column : {"method", "views", "views_taken", "of_visible", "of_visible_low", "of_visible_high",
                             "of_all", "of_all_low", "of_all_high", "objects", "path_m", "motion_s", "published",
                             "year", "source", "object", "same_object", "differs"}) {
    columns.emplace_back(column);
  }
  CsvTable rows{columns};
  const auto add_mean = [&rows](const std::optional<MeanEstimate>& estimate) {
    rows.add(estimate && estimate->n > 0 ? std::optional{estimate->mean} : std::nullopt);
  };
  const auto add_interval = [&rows](const std::optional<MeanEstimate>& estimate) {
    rows.add(estimate ? estimate->low() : std::nullopt).add(estimate ? estimate->high() : std::nullopt);
  };
  for (const BenchmarkRow& row : table.rows) {
    const std::optional<PublishedFigure>& figure = row.published;
    for (const auto& [column, value] : about) rows.add(value);
    rows.add(row.method).add(row.views);
    add_mean(row.taken);
    for (const auto* share : {&row.of_visible, &row.of_all}) {
      add_mean(*share);
      add_interval(*share);
    }
    rows.add(row.of_visible ? std::optional{static_cast<double>(row.of_visible->n)} : std::nullopt);
    add_mean(row.path_m);
    add_mean(row.motion_s);
    rows.add(figure ? std::optional{figure->coverage} : std::nullopt);
    rows.add(figure && figure->year > 0 ? std::to_string(figure->year) : "").add(figure ? figure->source : "");
    rows.add(figure ? figure->object : "");
    rows.add(!figure ? "" : row.same_object ? "yes" : "no").add(figure ? figure->differs : "");
    rows.end_row();
  }
  SACCADE_CHECK(rows.write(folder / "table.csv"));
  SACCADE_CHECK(write_differences(folder, about, table.differences));
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

}  // namespace saccade::cli
