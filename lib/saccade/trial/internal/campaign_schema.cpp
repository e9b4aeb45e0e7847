// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/internal/campaign_schema.hpp"

#include <array>

namespace saccade {
namespace {

constexpr std::int64_t kApplicationId{0x53434144};  // "SCAD", in the file's header

// Upgrades: version n + 1 of the tables is made from version n; 0 is an empty file. Existing entries never change,
// because files were made with them.
constexpr std::array kVersions{
    R"sql(
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
)sql",
    R"sql(
ALTER TABLE runs ADD COLUMN noise TEXT NOT NULL DEFAULT 'kinect-v1';
UPDATE runs SET noise = CASE WHEN json_extract(settings, '$.noise') = 0 THEN 'none'
  ELSE coalesce(json_extract(settings, '$.sensor'), 'kinect-v1') END WHERE json_valid(settings);
ALTER TABLE runs ADD COLUMN scan_views INTEGER NOT NULL DEFAULT 0;
ALTER TABLE runs ADD COLUMN scan_refused TEXT NOT NULL DEFAULT '{}';
ALTER TABLE runs ADD COLUMN refused_at_end TEXT NOT NULL DEFAULT '{}';
ALTER TABLE views ADD COLUMN evaluated INTEGER NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN refused TEXT NOT NULL DEFAULT '{}';
ALTER TABLE views ADD COLUMN looks_at_object INTEGER NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN path_m REAL NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN motion_s REAL NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN planner_map_ms REAL NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN segmentation_ms REAL NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN saliency_ms REAL NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN reachability_ms REAL NOT NULL DEFAULT 0;
ALTER TABLE views ADD COLUMN planning_ms REAL NOT NULL DEFAULT 0;
DROP VIEW curves;
CREATE VIEW curves AS
  SELECT id AS run, scene, strategy, noise, seed, settings, 0 AS number, initial_coverage AS coverage,
         initial_unknown_left AS unknown_left, initial_unknown_near_objects AS unknown_near_objects
  FROM runs
  UNION ALL
  SELECT views.run, scene, strategy, noise, seed, settings, number, views.coverage, views.unknown_left,
         views.unknown_near_objects
  FROM views JOIN runs ON runs.id = views.run;
)sql",
    R"sql(
ALTER TABLE views ADD COLUMN gain_observed REAL;
)sql"};
constexpr std::int64_t kNewestVersion{kVersions.size()};

/// Header of a campaign file.
struct Header {
  std::int64_t version{0};
  bool fresh{true};  ///< there is nothing in it yet
};

Error written_by(const SqliteFile& file, const char* which, std::int64_t version, const char* advice) {
  return {Errc::unsupported,
          std::string{"was written by "} + which + " Saccade (its format is " + std::to_string(version) +
              ", this program knows " + std::to_string(kNewestVersion) + "); " + advice,
          file.path().string()};
}

Result<Header> header_of(const SqliteFile& file) {
  SACCADE_TRY(const std::int64_t application, file.integer("PRAGMA application_id"));
  SACCADE_TRY(const std::int64_t version, file.integer("PRAGMA user_version"));
  SACCADE_TRY(const std::int64_t tables, file.integer("SELECT count(*) FROM sqlite_schema"));
  const bool fresh = application == 0 && version == 0 && tables == 0;
  if (!fresh && (application != kApplicationId || version < 1)) {
    return Error{Errc::invalid_argument, "is the database of another program; name another file", file.path().string()};
  }
  if (version > kNewestVersion) return written_by(file, "a newer", version, "use that one, or another file");
  return Header{version, fresh};
}

}  // namespace

Status make_campaign_tables(const SqliteFile& file) {
  SACCADE_TRY(const Header header, header_of(file));
  for (std::int64_t next = header.version; next < kNewestVersion; ++next) {
    SACCADE_CHECK(file.run(kVersions[static_cast<std::size_t>(next)]));
  }
  if (header.fresh) SACCADE_CHECK(file.run("PRAGMA application_id = " + std::to_string(kApplicationId)));
  return file.run("PRAGMA user_version = " + std::to_string(kNewestVersion));
}

Result<bool> has_campaign_tables(const SqliteFile& file) {
  SACCADE_TRY(const Header header, header_of(file));
  if (header.fresh) return false;
  if (header.version < kNewestVersion) {
    return written_by(file, "an older", header.version,
                      "run saccade compare on its folder once, which brings it up to date");
  }
  return true;
}

}  // namespace saccade
