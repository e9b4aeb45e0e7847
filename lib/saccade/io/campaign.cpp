// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/campaign.hpp"

#include <cmath>
#include <limits>

#include "saccade/io/json_io.hpp"

namespace saccade {
namespace {

constexpr int kBusy_ms{10000};
constexpr std::int64_t kApplicationId{0x53434144};  // "SCAD", in the file's header
constexpr std::int64_t kSchema{1};

constexpr const char* kTables{R"sql(
CREATE TABLE runs (
  id INTEGER PRIMARY KEY,
  scene TEXT NOT NULL,
  scene_hash TEXT NOT NULL,
  strategy TEXT NOT NULL,
  seed INTEGER NOT NULL,
  settings TEXT NOT NULL,
  views INTEGER NOT NULL,
  stopped_because TEXT NOT NULL,
  seconds REAL NOT NULL,
  program_version TEXT NOT NULL,
  finished_at TEXT NOT NULL,
  initial_coverage REAL NOT NULL,
  initial_unknown_left INTEGER NOT NULL,
  initial_unknown_near_objects INTEGER NOT NULL,
  initial_accuracy_m REAL,
  initial_chamfer_m REAL,
  initial_f_score REAL,
  coverage REAL NOT NULL,
  unknown_left INTEGER NOT NULL,
  unknown_near_objects INTEGER NOT NULL,
  accuracy_m REAL,
  chamfer_m REAL,
  f_score REAL,
  UNIQUE (scene, scene_hash, strategy, seed, settings)
);
CREATE TABLE views (
  run INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
  number INTEGER NOT NULL,
  region INTEGER NOT NULL,
  gain REAL,
  T_world_camera TEXT NOT NULL,
  candidates INTEGER NOT NULL,
  frames INTEGER NOT NULL,
  points_at_object INTEGER NOT NULL,
  candidates_ms REAL NOT NULL,
  evaluation_ms REAL NOT NULL,
  motion_ms REAL NOT NULL,
  fusion_ms REAL NOT NULL,
  coverage REAL NOT NULL,
  unknown_left INTEGER NOT NULL,
  unknown_near_objects INTEGER NOT NULL,
  accuracy_m REAL,
  chamfer_m REAL,
  f_score REAL,
  PRIMARY KEY (run, number)
) WITHOUT ROWID;
CREATE VIEW curves AS
  SELECT id AS run, scene, strategy, seed, settings, 0 AS number, initial_coverage AS coverage,
         initial_unknown_left AS unknown_left, initial_unknown_near_objects AS unknown_near_objects
  FROM runs
  UNION ALL
  SELECT views.run, scene, strategy, seed, settings, number, views.coverage, views.unknown_left,
         views.unknown_near_objects
  FROM views JOIN runs ON runs.id = views.run;
)sql"};

constexpr const char* kInsertRun{R"sql(
INSERT INTO runs (scene, scene_hash, strategy, seed, settings, views, stopped_because, seconds, program_version,
  finished_at, initial_coverage, initial_unknown_left, initial_unknown_near_objects, initial_accuracy_m,
  initial_chamfer_m, initial_f_score, coverage, unknown_left, unknown_near_objects, accuracy_m, chamfer_m, f_score)
VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)
ON CONFLICT DO NOTHING)sql"};

constexpr const char* kInsertView{R"sql(
INSERT INTO views (run, number, region, gain, T_world_camera, candidates, frames, points_at_object, candidates_ms,
  evaluation_ms, motion_ms, fusion_ms, coverage, unknown_left, unknown_near_objects, accuracy_m, chamfer_m, f_score)
VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?))sql"};

constexpr const char* kSelectRuns{R"sql(
SELECT id, scene, scene_hash, strategy, seed, settings, stopped_because, seconds, program_version, finished_at,
  initial_coverage, initial_unknown_left, initial_unknown_near_objects, initial_accuracy_m, initial_chamfer_m,
  initial_f_score
FROM runs )sql"};

constexpr const char* kSelectViews{R"sql(
SELECT region, gain, T_world_camera, candidates, frames, points_at_object, candidates_ms, evaluation_ms, motion_ms,
  fusion_ms, coverage, unknown_left, unknown_near_objects, accuracy_m, chamfer_m, f_score
FROM views WHERE run = ? ORDER BY number)sql"};

constexpr const char* kWhereKey{"WHERE scene = ? AND scene_hash = ? AND strategy = ? AND seed = ? AND settings = ?"};

std::int64_t whole(std::size_t count) { return static_cast<std::int64_t>(count); }

void bind(SqliteStatement& statement, const CampaignKey& key) {
  statement.bind(key.scene);
  statement.bind(key.scene_hash);
  statement.bind(key.strategy);
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
             view.T_world_camera.matrix().allFinite();
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
    statement.bind(whole(view.frames));
    statement.bind(std::int64_t{view.points_at_object ? 1 : 0});
    for (const double ms : {view.candidates_ms, view.evaluation_ms, view.motion_ms, view.fusion_ms}) statement.bind(ms);
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
    view.frames = static_cast<std::size_t>(row.integer());
    view.points_at_object = row.integer() != 0;
    for (double* ms : {&view.candidates_ms, &view.evaluation_ms, &view.motion_ms, &view.fusion_ms}) *ms = row.real();
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
  run.key.seed = static_cast<std::uint64_t>(row.integer());
  run.key.settings = row.text();
  run.stopped_because = row.text();
  run.seconds = row.real();
  run.program_version = row.text();
  run.finished_at = row.text();
  run.initial = figures_of(row);
  SACCADE_TRY(run.views, views_of(file, id));
  return run;
}

/// Makes the tables in an empty file; refuses what this is not written for.
Status make_ready(const SqliteFile& file) {
  SACCADE_TRY(const std::int64_t application, file.integer("PRAGMA application_id"));
  SACCADE_TRY(const std::int64_t schema, file.integer("PRAGMA user_version"));
  SACCADE_TRY(const std::int64_t tables, file.integer("SELECT count(*) FROM sqlite_schema"));
  const std::string where = file.path().string();
  if (application == 0 && schema == 0 && tables == 0) {
    SACCADE_CHECK(file.run(kTables));
    SACCADE_CHECK(file.run("PRAGMA application_id = " + std::to_string(kApplicationId)));
  } else if (application != kApplicationId) {
    return Error{Errc::invalid_argument, "is the database of another program; name another file", where};
  } else if (schema > kSchema) {
    return Error{Errc::unsupported,
                 "was written by a newer Saccade (its format is " + std::to_string(schema) + ", this program knows " +
                     std::to_string(kSchema) + "); use that one, or another file",
                 where};
  }
  // In a file that is ready this changes nothing, but it is a write: one that cannot be done fails here, before the
  // work.
  return file.run("PRAGMA user_version = " + std::to_string(kSchema));
}

}  // namespace

Result<Campaign> Campaign::open(const std::filesystem::path& path) {
  SACCADE_TRY(SqliteFile file, SqliteFile::open(path, kBusy_ms));
  SACCADE_CHECK(file.run("PRAGMA synchronous = EXTRA; PRAGMA foreign_keys = ON"));
  {
    SACCADE_TRY(SqliteTransaction transaction, SqliteTransaction::begin(file));
    SACCADE_CHECK(make_ready(file));
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
