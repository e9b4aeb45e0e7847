// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/campaign.hpp"

#include <cmath>
#include <limits>

#include "saccade/io/campaign_schema.hpp"
#include "saccade/io/json_io.hpp"

namespace saccade {
namespace {

constexpr int kBusy_ms{10000};

constexpr const char* kInsertRun{R"sql(
INSERT INTO runs (scene, scene_hash, strategy, noise, seed, settings, views, stopped_because, seconds, program_version,
  finished_at, scan_views, scan_refused, refused_at_end, initial_coverage, initial_unknown_left,
  initial_unknown_near_objects, initial_accuracy_m, initial_chamfer_m, initial_f_score, coverage, unknown_left,
  unknown_near_objects, accuracy_m, chamfer_m, f_score)
VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?,
  ?)
ON CONFLICT DO NOTHING)sql"};

constexpr const char* kInsertView{R"sql(
INSERT INTO views (run, number, region, gain, T_world_camera, candidates, evaluated, refused, frames, points_at_object,
  looks_at_object, path_m, motion_s, planner_map_ms, candidates_ms, segmentation_ms, saliency_ms, reachability_ms, evaluation_ms,
  planning_ms, motion_ms, fusion_ms, coverage, unknown_left, unknown_near_objects, accuracy_m, chamfer_m, f_score)
VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?))sql"};

constexpr const char* kSelectRuns{R"sql(
SELECT id, scene, scene_hash, strategy, noise, seed, settings, stopped_because, seconds, program_version, finished_at,
  scan_views, scan_refused, refused_at_end, initial_coverage, initial_unknown_left, initial_unknown_near_objects,
  initial_accuracy_m, initial_chamfer_m, initial_f_score
FROM runs )sql"};

constexpr const char* kSelectViews{R"sql(
SELECT region, gain, T_world_camera, candidates, evaluated, refused, frames, points_at_object, looks_at_object, path_m,
  motion_s, planner_map_ms, candidates_ms, segmentation_ms, saliency_ms, reachability_ms, evaluation_ms, planning_ms, motion_ms,
  fusion_ms, coverage, unknown_left, unknown_near_objects, accuracy_m, chamfer_m, f_score
FROM views WHERE run = ? ORDER BY number)sql"};

constexpr const char* kWhereKey{
    "WHERE scene = ? AND scene_hash = ? AND strategy = ? AND noise = ? AND seed = ? AND settings = ?"};

std::int64_t whole(std::size_t count) { return static_cast<std::int64_t>(count); }

void bind(SqliteStatement& statement, const CampaignKey& key) {
  statement.bind(key.scene);
  statement.bind(key.scene_hash);
  statement.bind(key.strategy);
  statement.bind(key.noise);
  statement.bind(static_cast<std::int64_t>(key.seed));
  statement.bind(key.settings);
}

void bind(SqliteStatement& statement, const CampaignFigures& figures) {
  statement.bind(figures.coverage);
  statement.bind(whole(figures.unknown_left));
  statement.bind(whole(figures.unknown_near_objects));
  statement.bind(figures.accuracy_m);
  statement.bind(figures.chamfer_m);
  statement.bind(figures.f_score);
}

CampaignFigures figures_of(SqliteStatement& row) {
  CampaignFigures figures;
  figures.coverage = row.real();
  figures.unknown_left = static_cast<std::size_t>(row.integer());
  figures.unknown_near_objects = static_cast<std::size_t>(row.integer());
  figures.accuracy_m = row.optional_real();
  figures.chamfer_m = row.optional_real();
  figures.f_score = row.optional_real();
  return figures;
}

Result<RefusalCounts> refusals_of(SqliteStatement& row) {
  SACCADE_TRY(const nlohmann::json counts, parse_json(row.text()));
  return refusals_from_json(counts);
}

bool is_finite(const CampaignFigures& figures) {
  for (const auto& figure : {figures.accuracy_m, figures.chamfer_m, figures.f_score}) {
    if (figure && !std::isfinite(*figure)) return false;
  }
  return std::isfinite(figures.coverage);
}

Status check(const CampaignKey& key, const std::filesystem::path& path) {
  if (key.seed <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
  return Error{Errc::invalid_argument, "the seed of a run must be below 2^63", path.string()};
}

Status check(const CampaignRun& run, const std::filesystem::path& path) {
  SACCADE_CHECK(check(run.key, path));
  bool finite = is_finite(run.initial) && std::isfinite(run.seconds);
  for (const CampaignView& view : run.views) {
    finite = finite && is_finite(view.after) && std::isfinite(view.gain.value_or(0.0)) &&
             view.T_world_camera.matrix().allFinite() && std::isfinite(view.path_m) && std::isfinite(view.motion_s);
  }
  if (finite) return {};
  return Error{Errc::invalid_argument, "a figure of the run is not finite", path.string()};
}

Status insert_views(const SqliteFile& file, const std::vector<CampaignView>& views) {
  const std::int64_t run = file.last_row_id();
  SACCADE_TRY(SqliteStatement statement, SqliteStatement::prepare(file, kInsertView));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const CampaignView& view = views[i];
    statement.bind(run);
    statement.bind(whole(i + 1));
    statement.bind(whole(view.region));
    statement.bind(view.gain);
    statement.bind(pose_to_json(view.T_world_camera).dump());
    statement.bind(whole(view.candidates));
    statement.bind(whole(view.evaluated));
    statement.bind(refusals_to_json(view.refused).dump());
    statement.bind(whole(view.frames));
    statement.bind(std::int64_t{view.points_at_object ? 1 : 0});
    statement.bind(std::int64_t{view.looks_at_object ? 1 : 0});
    statement.bind(view.path_m);
    statement.bind(view.motion_s);
    for (const double ms : view.phases_ms) statement.bind(ms);
    bind(statement, view.after);
    SACCADE_CHECK(statement.run());
  }
  return {};
}

Result<std::vector<CampaignView>> views_of(const SqliteFile& file, std::int64_t run) {
  std::vector<CampaignView> views;
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file, kSelectViews));
  row.bind(run);
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return views;
    CampaignView view;
    view.region = static_cast<std::size_t>(row.integer());
    view.gain = row.optional_real();
    SACCADE_TRY(const nlohmann::json pose, parse_json(row.text()));
    SACCADE_TRY(view.T_world_camera, pose_from_json(pose));
    view.candidates = static_cast<std::size_t>(row.integer());
    view.evaluated = static_cast<std::size_t>(row.integer());
    SACCADE_TRY(view.refused, refusals_of(row));
    view.frames = static_cast<std::size_t>(row.integer());
    view.points_at_object = row.integer() != 0;
    view.looks_at_object = row.integer() != 0;
    view.path_m = row.real();
    view.motion_s = row.real();
    for (double& ms : view.phases_ms) ms = row.real();
    view.after = figures_of(row);
    views.push_back(view);
  }
}

/// The run of the statement's row.
Result<CampaignRun> run_of(const SqliteFile& file, SqliteStatement& row) {
  CampaignRun run;
  const std::int64_t id = row.integer();
  run.key.scene = row.text();
  run.key.scene_hash = row.text();
  run.key.strategy = row.text();
  run.key.noise = row.text();
  run.key.seed = static_cast<std::uint64_t>(row.integer());
  run.key.settings = row.text();
  run.stopped_because = row.text();
  run.seconds = row.real();
  run.program_version = row.text();
  run.finished_at = row.text();
  run.scan_views = static_cast<std::size_t>(row.integer());
  SACCADE_TRY(run.scan_refused, refusals_of(row));
  SACCADE_TRY(run.refused_at_end, refusals_of(row));
  run.initial = figures_of(row);
  SACCADE_TRY(run.views, views_of(file, id));
  return run;
}

}  // namespace

Result<Campaign> Campaign::open(const std::filesystem::path& path) {
  SACCADE_TRY(SqliteFile file, SqliteFile::open(path, kBusy_ms));
  SACCADE_CHECK(file.run("PRAGMA synchronous = EXTRA; PRAGMA foreign_keys = ON"));
  {
    SACCADE_TRY(SqliteTransaction transaction, SqliteTransaction::begin(file));
    SACCADE_CHECK(make_campaign_tables(file));
    SACCADE_CHECK(transaction.commit());
  }
  return Campaign{std::move(file)};
}

Result<bool> Campaign::has(const CampaignKey& key) const {
  SACCADE_CHECK(check(key, path()));
  SACCADE_TRY(SqliteStatement statement,
              SqliteStatement::prepare(file_, std::string{"SELECT 1 FROM runs "} + kWhereKey));
  bind(statement, key);
  return statement.step();
}

Result<bool> Campaign::add(const CampaignRun& run) const {
  SACCADE_CHECK(check(run, path()));
  SACCADE_TRY(SqliteTransaction transaction, SqliteTransaction::begin(file_));
  SACCADE_TRY(SqliteStatement statement, SqliteStatement::prepare(file_, kInsertRun));
  bind(statement, run.key);
  statement.bind(whole(run.views.size()));
  statement.bind(run.stopped_because);
  statement.bind(run.seconds);
  statement.bind(run.program_version);
  statement.bind(whole(run.scan_views));
  statement.bind(refusals_to_json(run.scan_refused).dump());
  statement.bind(refusals_to_json(run.refused_at_end).dump());
  bind(statement, run.initial);
  bind(statement, run.final());
  SACCADE_CHECK(statement.run());
  if (file_.changed_rows() == 0) return false;
  SACCADE_CHECK(insert_views(file_, run.views));
  SACCADE_CHECK(transaction.commit());
  return true;
}

Result<std::optional<CampaignRun>> Campaign::find(const CampaignKey& key) const {
  SACCADE_CHECK(check(key, path()));
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, std::string{kSelectRuns} + kWhereKey));
  bind(row, key);
  SACCADE_TRY(const bool found, row.step());
  if (!found) return std::optional<CampaignRun>{};
  SACCADE_TRY(CampaignRun run, run_of(file_, row));
  return std::optional{std::move(run)};
}

Result<std::vector<CampaignRun>> Campaign::runs() const {
  std::vector<CampaignRun> runs;
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, std::string{kSelectRuns} + "ORDER BY id"));
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return runs;
    SACCADE_TRY(CampaignRun run, run_of(file_, row));
    runs.push_back(std::move(run));
  }
}

}  // namespace saccade
