// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/campaign_csv.hpp"

namespace saccade {
namespace {

void add_key(CsvTable& table, const CampaignKey& key) {
  table.add(key.scene).add(key.scene_hash).add(key.strategy).add(key.seed);
}

void add_figures(CsvTable& table, const CampaignFigures& figures) {
  table.add(figures.coverage).add(std::uint64_t{figures.unknown_left}).add(std::uint64_t{figures.unknown_near_objects});
  table.add(figures.accuracy_m).add(figures.chamfer_m).add(figures.f_score);
}

}  // namespace

CsvTable runs_csv(std::span<const CampaignRun> runs) {
  CsvTable table{{"scene",
                  "scene_hash",
                  "strategy",
                  "seed",
                  "views",
                  "stopped_because",
                  "seconds",
                  "initial_coverage",
                  "initial_unknown_left",
                  "initial_unknown_near_objects",
                  "initial_accuracy_m",
                  "initial_chamfer_m",
                  "initial_f_score",
                  "coverage",
                  "unknown_left",
                  "unknown_near_objects",
                  "accuracy_m",
                  "chamfer_m",
                  "f_score",
                  "program_version",
                  "finished_at",
                  "settings"}};
  for (const CampaignRun& run : runs) {
    add_key(table, run.key);
    table.add(std::uint64_t{run.views.size()}).add(run.stopped_because).add(run.seconds);
    add_figures(table, run.initial);
    add_figures(table, run.final());
    table.add(run.program_version).add(run.finished_at).add(run.key.settings);
    table.end_row();
  }
  return table;
}

CsvTable views_csv(std::span<const CampaignRun> runs) {
  CsvTable table{{"scene",
                  "scene_hash",
                  "strategy",
                  "seed",
                  "number",
                  "region",
                  "gain",
                  "candidates",
                  "frames",
                  "points_at_object",
                  "candidates_ms",
                  "evaluation_ms",
                  "motion_ms",
                  "fusion_ms",
                  "coverage",
                  "unknown_left",
                  "unknown_near_objects",
                  "accuracy_m",
                  "chamfer_m",
                  "f_score"}};
  for (const CampaignRun& run : runs) {
    add_key(table, run.key);
    table.add(std::uint64_t{0});
    for (int field = 0; field < 9; ++field) table.add(std::nullopt);  // what a scan does not have
    add_figures(table, run.initial);
    table.end_row();
    for (std::size_t i = 0; i < run.views.size(); ++i) {
      const CampaignView& view = run.views[i];
      add_key(table, run.key);
      table.add(std::uint64_t{i + 1}).add(std::uint64_t{view.region}).add(view.gain);
      table.add(std::uint64_t{view.candidates}).add(std::uint64_t{view.frames});
      table.add(std::uint64_t{view.points_at_object ? 1U : 0U});
      table.add(view.candidates_ms).add(view.evaluation_ms).add(view.motion_ms).add(view.fusion_ms);
      add_figures(table, view.after);
      table.end_row();
    }
  }
  return table;
}

CsvTable summary_csv(std::span<const CampaignSummary> summaries) {
  CsvTable table{{"scene",
                  "strategy",
                  "n",
                  "initial_coverage",
                  "initial_coverage_low",
                  "initial_coverage_high",
                  "coverage",
                  "coverage_low",
                  "coverage_high",
                  "unknown_near_objects",
                  "unknown_near_objects_low",
                  "unknown_near_objects_high",
                  "f_score",
                  "f_score_low",
                  "f_score_high",
                  "accuracy_m",
                  "accuracy_m_low",
                  "accuracy_m_high",
                  "views",
                  "views_low",
                  "views_high",
                  "seconds",
                  "seconds_low",
                  "seconds_high"}};
  for (const CampaignSummary& summary : summaries) {
    table.add(summary.scene).add(summary.strategy).add(std::uint64_t{summary.coverage.n});
    for (const MeanEstimate* estimate : {&summary.initial_coverage, &summary.coverage, &summary.unknown_near_objects,
                                         &summary.f_score, &summary.accuracy_m, &summary.views, &summary.seconds}) {
      table.add(estimate->n == 0 ? std::nullopt : std::optional{estimate->mean});
      table.add(estimate->low()).add(estimate->high());
    }
    table.end_row();
  }
  return table;
}

}  // namespace saccade
