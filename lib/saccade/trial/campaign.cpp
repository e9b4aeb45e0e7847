// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/campaign.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/trial/internal/campaign_schema.hpp"

namespace saccade {
namespace {

constexpr const char* kInsertRun{R"sql(
INSERT INTO runs (scene, scene_hash, strategy, noise, seed, settings, views, stopped_because, seconds, program_version,
  finished_at, scan_views, scan_refused, refused_at_end, initial_coverage, initial_unknown_left,
  initial_unknown_near_objects, initial_accuracy_m, initial_chamfer_m, initial_f_score, coverage, unknown_left,
  unknown_near_objects, accuracy_m, chamfer_m, f_score)
VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?,
  ?)
ON CONFLICT DO NOTHING)sql"};

constexpr const char* kInsertView{R"sql(
INSERT INTO views (run, number, region, gain, gain_observed, T_world_camera, candidates, evaluated, refused, frames,
  points_at_object, looks_at_object, path_m, motion_s, planner_map_ms, candidates_ms, segmentation_ms, saliency_ms, reachability_ms, evaluation_ms,
  planning_ms, motion_ms, fusion_ms, coverage, unknown_left, unknown_near_objects, accuracy_m, chamfer_m, f_score)
VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?))sql"};

constexpr const char* kSelectRuns{R"sql(
SELECT id, views, scene, scene_hash, strategy, noise, seed, settings, stopped_because, seconds, program_version, finished_at,
  scan_views, scan_refused, refused_at_end, initial_coverage, initial_unknown_left, initial_unknown_near_objects,
  initial_accuracy_m, initial_chamfer_m, initial_f_score
FROM runs )sql"};

// The columns that read_view reads.
constexpr const char* kReadViewColumns{R"sql(region, gain, gain_observed, candidates, evaluated, refused, frames,
  points_at_object, looks_at_object, path_m, motion_s, planner_map_ms, candidates_ms, segmentation_ms, saliency_ms,
  reachability_ms, evaluation_ms, planning_ms, motion_ms, fusion_ms, coverage, unknown_left, unknown_near_objects,
  accuracy_m, chamfer_m, f_score)sql"};

constexpr const char* kWhereKey{
    "WHERE scene = ? AND scene_hash = ? AND strategy = ? AND noise = ? AND seed = ? AND settings = ?"};

/// Views of a run that room is made for before they are read.
constexpr std::int64_t kMostReserved{1000};

std::int64_t whole(std::size_t count) { return static_cast<std::int64_t>(count); }

void bind(SqliteStatement& statement, const CampaignKey& key) {
  statement.bind(key.scene);
  statement.bind(key.scene_hash);
  statement.bind(key.strategy);
  statement.bind(key.noise);
  statement.bind(static_cast<std::int64_t>(key.seed));
  statement.bind(key.settings);
}

/// Binds measures that need a ground truth, which every run of a campaign has.
void bind(SqliteStatement& statement, const Measures& measures) {
  statement.bind(measures.coverage.value_or(0.0));
  statement.bind(whole(measures.unknown_left));
  statement.bind(whole(measures.unknown_near_objects.value_or(0)));
  statement.bind(measures.accuracy_m);
  statement.bind(measures.chamfer_m);
  statement.bind(measures.f_score);
}

Measures measures_of(SqliteStatement& row) {
  Measures measures;
  measures.coverage = row.real();
  measures.unknown_left = static_cast<std::size_t>(row.integer());
  measures.unknown_near_objects = static_cast<std::size_t>(row.integer());
  measures.accuracy_m = row.optional_real();
  measures.chamfer_m = row.optional_real();
  measures.f_score = row.optional_real();
  return measures;
}

Result<RefusalCounts> refusals_of(SqliteStatement& row) {
  const std::string text = row.text();
  if (text == "{}") return RefusalCounts{};
  SACCADE_TRY(const nlohmann::json counts, parse_json(text));
  return refusals_from_json(counts);
}

bool is_finite(const Measures& measures) {
  for (const auto& measure : {measures.coverage, measures.accuracy_m, measures.chamfer_m, measures.f_score}) {
    if (measure && !std::isfinite(*measure)) return false;
  }
  return true;
}

Status check(const CampaignKey& key, const std::filesystem::path& path) {
  if (key.seed <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
  return Error{Errc::invalid_argument, "the seed of a run must be below 2^63", path.string()};
}

Status check(const CampaignEntry& entry, const std::filesystem::path& path) {
  SACCADE_CHECK(check(entry.key, path));
  bool finite = is_finite(entry.run.scan.measures) && std::isfinite(entry.seconds);
  for (const ViewRecord& view : entry.run.views) {
    finite = finite && is_finite(view.measures) && !std::isinf(view.gain_predicted) &&
             !std::isinf(view.gain_observed) && view.T_world_camera.matrix().allFinite() &&
             std::isfinite(view.path_m) && std::isfinite(view.motion_s);
  }
  if (finite) return {};
  return Error{Errc::invalid_argument, "a measure of the run is not finite", path.string()};
}

std::optional<double> number_of(double gain) { return std::isnan(gain) ? std::nullopt : std::optional{gain}; }

std::int64_t flag(const std::optional<bool>& value) { return value.value_or(false) ? 1 : 0; }

Status insert_views(const SqliteFile& file, const std::vector<ViewRecord>& views) {
  const std::int64_t run = file.last_row_id();
  SACCADE_TRY(SqliteStatement statement, SqliteStatement::prepare(file, kInsertView));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewRecord& view = views[i];
    statement.bind(run);
    statement.bind(whole(i + 1));
    statement.bind(whole(view.region));
    statement.bind(number_of(view.gain_predicted));
    statement.bind(number_of(view.gain_observed));
    statement.bind(pose_to_json(view.T_world_camera).dump());
    statement.bind(whole(view.candidates));
    statement.bind(whole(view.evaluated));
    statement.bind(refusals_to_json(view.refused).dump());
    statement.bind(whole(view.frames));
    statement.bind(flag(view.reveals_object));
    statement.bind(flag(view.looks_at_object));
    statement.bind(view.path_m);
    statement.bind(view.motion_s);
    for (const Phase phase : kPhaseNames.values) statement.bind(view.times.ms(phase));
    bind(statement, view.measures);
    SACCADE_CHECK(statement.run());
  }
  return {};
}

/// Reads the next columns of the row, kReadViewColumns; the pose is not among them.
Status read_view(SqliteStatement& row, ViewRecord& view) {
  view.region = static_cast<std::size_t>(row.integer());
  view.gain_predicted = row.optional_real().value_or(std::numeric_limits<double>::quiet_NaN());
  view.gain_observed = row.optional_real().value_or(std::numeric_limits<double>::quiet_NaN());
  view.candidates = static_cast<std::size_t>(row.integer());
  view.evaluated = static_cast<std::size_t>(row.integer());
  SACCADE_TRY(view.refused, refusals_of(row));
  view.frames = static_cast<std::size_t>(row.integer());
  view.reveals_object = row.integer() != 0;
  view.looks_at_object = row.integer() != 0;
  view.path_m = row.real();
  view.motion_s = row.real();
  for (const Phase phase : kPhaseNames.values) view.times.add(phase, row.real());
  view.measures = measures_of(row);
  return {};
}

/// Statement for read_views.
Result<SqliteStatement> prepare_views(const SqliteFile& file) {
  return SqliteStatement::prepare(
      file, std::string{"SELECT T_world_camera, "} + kReadViewColumns + " FROM views WHERE run = ? ORDER BY number");
}

Status read_views(SqliteStatement& row, std::int64_t run, std::vector<ViewRecord>& views) {
  row.restart();
  row.bind(run);
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return {};
    SACCADE_TRY(const nlohmann::json pose, parse_json(row.text()));
    ViewRecord& view = views.emplace_back();
    SACCADE_TRY(view.T_world_camera, pose_from_json(pose));
    SACCADE_CHECK(read_view(row, view));
  }
}

struct RunRow {
  std::int64_t id{0};
  std::int64_t views{0};  ///< as the file says; those that follow count
};

/// Makes room for the views of a run, which spares moving them.
void make_room(const RunRow& row, CampaignEntry& entry) {
  entry.run.views.reserve(static_cast<std::size_t>(std::clamp<std::int64_t>(row.views, 0, kMostReserved)));
}

/// Reads the run of the statement's row, but for its views; the key also where the rest cannot be read.
Status run_of(SqliteStatement& row, RunRow& stored, CampaignEntry& entry) {
  stored = {row.integer(), row.integer()};
  entry.key.scene = row.text();
  entry.key.scene_hash = row.text();
  entry.key.strategy = row.text();
  entry.key.noise = row.text();
  entry.key.seed = static_cast<std::uint64_t>(row.integer());
  entry.key.settings = row.text();
  const std::string reason = row.text();
  const auto stopped_because = kStopReasonNames.find(reason);
  if (!stopped_because) return Error{Errc::corrupt_data, "unknown reason to stop: \"" + reason + "\"", ""};
  entry.run.stopped_because = *stopped_because;
  entry.seconds = row.real();
  entry.program_version = row.text();
  entry.finished_at = row.text();
  entry.run.scan.views = static_cast<std::size_t>(row.integer());
  SACCADE_TRY(entry.run.scan.refused, refusals_of(row));
  SACCADE_TRY(entry.run.refused_at_end, refusals_of(row));
  entry.run.scan.measures = measures_of(row);
  return {};
}

/// Returns the error of a run's row, with the run and the file; one that names the file stays as it is.
Error run_error(Error error, const CampaignKey& key, const std::filesystem::path& path) {
  if (error.context == path.string()) return error;
  error.message = "cannot read the run " + key.scene + ", " + key.strategy + ", " + key.noise + ", seed " +
                  std::to_string(key.seed) + ": " + error.message;
  return in_file(std::move(error), path);
}

/// @param views  of prepare_views()
Result<CampaignEntry> entry_of(const SqliteFile& file, SqliteStatement& row, SqliteStatement& views) {
  RunRow stored;
  CampaignEntry entry;
  if (const Status read = run_of(row, stored, entry); !read) return run_error(read.error(), entry.key, file.path());
  if (const Status read = read_views(views, stored.id, entry.run.views); !read) {
    return run_error(read.error(), entry.key, file.path());
  }
  return entry;
}

}  // namespace

Result<Campaign> Campaign::open(const std::filesystem::path& path) {
  SACCADE_TRY(SqliteFile file, SqliteFile::open(path, kCampaignBusy_ms));
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

Result<bool> Campaign::add(const CampaignEntry& entry) const {
  SACCADE_CHECK(check(entry, path()));
  const RunRecord& run = entry.run;
  SACCADE_TRY(SqliteTransaction transaction, SqliteTransaction::begin(file_));
  SACCADE_TRY(SqliteStatement statement, SqliteStatement::prepare(file_, kInsertRun));
  bind(statement, entry.key);
  statement.bind(whole(run.views.size()));
  statement.bind(std::string{to_string(run.stopped_because)});
  statement.bind(entry.seconds);
  statement.bind(entry.program_version);
  statement.bind(whole(run.scan.views));
  statement.bind(refusals_to_json(run.scan.refused).dump());
  statement.bind(refusals_to_json(run.refused_at_end).dump());
  bind(statement, run.scan.measures);
  bind(statement, run.final());
  SACCADE_CHECK(statement.run());
  if (file_.changed_rows() == 0) return false;
  SACCADE_CHECK(insert_views(file_, run.views));
  SACCADE_CHECK(transaction.commit());
  return true;
}

Result<std::optional<CampaignEntry>> Campaign::find(const CampaignKey& key) const {
  SACCADE_CHECK(check(key, path()));
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, std::string{kSelectRuns} + kWhereKey));
  bind(row, key);
  SACCADE_TRY(const bool found, row.step());
  if (!found) return std::optional<CampaignEntry>{};
  SACCADE_TRY(SqliteStatement views, prepare_views(file_));
  SACCADE_TRY(CampaignEntry entry, entry_of(file_, row, views));
  return std::optional{std::move(entry)};
}

Result<std::vector<CampaignEntry>> Campaign::runs() const {
  std::vector<CampaignEntry> runs;
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, std::string{kSelectRuns} + "ORDER BY id"));
  SACCADE_TRY(SqliteStatement views, prepare_views(file_));
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return runs;
    SACCADE_TRY(CampaignEntry entry, entry_of(file_, row, views));
    runs.push_back(std::move(entry));
  }
}

Status Campaign::parse_all() const {
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, std::string{kSelectRuns} + "ORDER BY id"));
  SACCADE_TRY(SqliteStatement views, prepare_views(file_));
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return {};
    SACCADE_CHECK(entry_of(file_, row, views));
  }
}

Result<std::vector<CampaignEntry>> Campaign::figures(const std::function<bool(const CampaignKey& key)>& wanted) const {
  std::vector<CampaignEntry> runs;
  // Both tables are in the order of the runs.
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, std::string{kSelectRuns} + "ORDER BY id"));
  SACCADE_TRY(SqliteStatement view, SqliteStatement::prepare(file_, std::string{"SELECT run, "} + kReadViewColumns +
                                                                        " FROM views ORDER BY run, number"));
  SACCADE_TRY(bool has_view, view.step());
  std::int64_t of_view = has_view ? view.integer() : 0;
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return runs;
    RunRow stored;
    CampaignEntry entry;
    if (const Status read = run_of(row, stored, entry); !read) return run_error(read.error(), entry.key, path());
    const bool chosen = wanted(entry.key);
    if (chosen) make_room(stored, entry);
    while (has_view && of_view <= stored.id) {
      if (chosen && of_view == stored.id) {
        const Status read = read_view(view, entry.run.views.emplace_back());
        if (!read) return run_error(read.error(), entry.key, path());
      }
      SACCADE_TRY(has_view, view.step());
      of_view = has_view ? view.integer() : 0;
    }
    if (chosen) runs.push_back(std::move(entry));
  }
}

}  // namespace saccade
