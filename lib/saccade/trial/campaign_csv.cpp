// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/campaign_summary.hpp"

#include <array>
#include <cmath>
#include <functional>

namespace saccade {
namespace {

constexpr std::array<std::string_view, 5> kKeyColumns{"scene", "scene_hash", "strategy", "noise", "seed"};
constexpr std::array<std::string_view, 6> kMapColumns{"coverage",   "unknown_left", "unknown_near_objects",
                                                      "accuracy_m", "chamfer_m",    "f_score"};
/// Columns of a view, between its number and its phases.
constexpr std::array<std::string_view, 11> kViewColumns{
    "region",          "gain",   "gain_observed", "candidates", "evaluated", "refused", "frames", "points_at_object",
    "looks_at_object", "path_m", "motion_s"};

void add_key(CsvTable& table, const CampaignKey& key) {
  table.add(key.scene).add(key.scene_hash).add(key.strategy).add(key.noise).add(key.seed);
}

void add_map(CsvTable& table, const Measures& measures) {
  table.add(measures.coverage).add(std::uint64_t{measures.unknown_left});
  table.add(std::uint64_t{measures.unknown_near_objects.value_or(0)});
  table.add(measures.accuracy_m).add(measures.chamfer_m).add(measures.f_score);
}

void add_view(CsvTable& table, const ViewRecord& view) {
  table.add(std::uint64_t{view.region});
  for (const double gain : {view.gain_predicted, view.gain_observed}) {
    table.add(std::isnan(gain) ? std::nullopt : std::optional{gain});
  }
  table.add(std::uint64_t{view.candidates});
  table.add(std::uint64_t{view.evaluated}).add(std::uint64_t{view.refused.total()});
  table.add(std::uint64_t{view.frames}).add(std::uint64_t{view.reveals_object.value_or(false) ? 1U : 0U});
  table.add(std::uint64_t{view.looks_at_object.value_or(false) ? 1U : 0U}).add(view.path_m).add(view.motion_s);
  for (const Phase phase : kPhaseNames.values) table.add(view.times.ms(phase));
  add_map(table, view.measures);
}

/// Writes a table of runs in parts, so that it takes little memory however many runs there are.
/// @param add_rows  adds the rows of a run
Status write_in_parts(const std::filesystem::path& path, std::span<const CampaignEntry> runs,
                      const std::vector<std::string_view>& columns,
                      const std::function<void(CsvTable& table, const CampaignEntry& entry)>& add_rows) {
  constexpr std::size_t kPart{1U << 18U};  // bytes, which stay in the cache
  SACCADE_TRY(AtomicFile file, AtomicFile::create(path));
  CsvTable table{columns};
  for (const CampaignEntry& entry : runs) {
    add_rows(table, entry);
    if (table.text().size() >= kPart) SACCADE_CHECK(table.move_to(file));
  }
  SACCADE_CHECK(table.move_to(file));
  return file.commit();
}

}  // namespace

Status write_runs_csv(const std::filesystem::path& path, std::span<const CampaignEntry> runs, std::size_t budget) {
  std::vector<std::string_view> columns{kKeyColumns.begin(), kKeyColumns.end()};
  columns.emplace_back("stopped_because");
  for (const RunFigure& figure : run_figures()) columns.push_back(figure.name);
  columns.insert(columns.end(), {"program_version", "finished_at", "settings"});
  return write_in_parts(path, runs, columns, [budget](CsvTable& table, const CampaignEntry& entry) {
    add_key(table, entry.key);
    table.add(to_string(entry.run.stopped_because));
    for (const RunFigure& figure : run_figures()) table.add(figure.of(entry, budget));
    table.add(entry.program_version).add(entry.finished_at).add(entry.key.settings);
    table.end_row();
  });
}

Status write_views_csv(const std::filesystem::path& path, std::span<const CampaignEntry> runs) {
  std::vector<std::string_view> columns{kKeyColumns.begin(), kKeyColumns.end()};
  columns.emplace_back("number");
  columns.insert(columns.end(), kViewColumns.begin(), kViewColumns.end());
  std::vector<std::string> phases;
  for (const Phase phase : kPhaseNames.values) phases.push_back(std::string{to_string(phase)} + "_ms");
  columns.insert(columns.end(), phases.begin(), phases.end());
  columns.insert(columns.end(), kMapColumns.begin(), kMapColumns.end());
  return write_in_parts(path, runs, columns, [](CsvTable& table, const CampaignEntry& entry) {
    add_key(table, entry.key);
    const std::string key{table.fields()};
    table.add(std::uint64_t{0});
    // Columns that a scan lacks.
    for (std::size_t i = 0; i < kViewColumns.size() + kPhaseNames.values.size(); ++i) table.add(std::nullopt);
    add_map(table, entry.run.scan.measures);
    table.end_row();
    for (std::size_t i = 0; i < entry.run.views.size(); ++i) {
      table.add_fields(key, kKeyColumns.size()).add(std::uint64_t{i + 1});
      add_view(table, entry.run.views[i]);
      table.end_row();
    }
  });
}

namespace {

/// Adds a calibration. Its measures cover all views together, so they have neither a mean over runs nor an interval.
void add_calibration(CsvTable& table, const CampaignSummary& summary) {
  const Calibration& calibration = summary.calibration;
  const auto add = [&](std::string_view figure, std::optional<double> value) {
    table.add(summary.group.scene.value_or("")).add(summary.group.strategy).add(summary.group.noise);
    table.add(figure).add(std::uint64_t{calibration.views}).add(value).add(std::nullopt).add(std::nullopt);
    table.end_row();
  };
  if (calibration.views == 0) return;
  add("promise_rank_correlation", calibration.rank_correlation);
  add("promise_median_kept", calibration.median_kept);
  add("promises_broken", static_cast<double>(calibration.broken));
}

}  // namespace

CsvTable summary_csv(std::span<const CampaignSummary> summaries) {
  CsvTable table{{"scene", "strategy", "noise", "figure", "n", "mean", "low", "high"}};
  for (const CampaignSummary& summary : summaries) {
    for (std::size_t i = 0; i < summary.figures.size(); ++i) {
      const MeanEstimate& estimate = summary.figures[i];
      table.add(summary.group.scene.value_or("")).add(summary.group.strategy).add(summary.group.noise);
      table.add(run_figures()[i].name).add(std::uint64_t{estimate.n});
      table.add(estimate.n == 0 ? std::nullopt : std::optional{estimate.mean});
      table.add(estimate.low()).add(estimate.high());
      table.end_row();
    }
    add_calibration(table, summary);
  }
  return table;
}

}  // namespace saccade
