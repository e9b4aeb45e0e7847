// SPDX-License-Identifier: Apache-2.0
// Reading other campaigns' files, and adding their runs.
#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/trial/campaign.hpp"
#include "saccade/trial/internal/campaign_schema.hpp"

namespace saccade {
namespace {

// Runs are copied value by value, so that no bit changes.
/// All columns of a run but its id, those of StoredRun first.
constexpr std::string_view kAllRunColumns{
    "scene, scene_hash, strategy, noise, seed, settings, views, program_version, stopped_because, seconds, "
    "finished_at, scan_views, scan_refused, refused_at_end, initial_coverage, initial_unknown_left, "
    "initial_unknown_near_objects, initial_accuracy_m, initial_chamfer_m, initial_f_score, coverage, unknown_left, "
    "unknown_near_objects, accuracy_m, chamfer_m, f_score"};
/// All columns of a view but its run.
constexpr std::string_view kAllViewColumns{
    "number, region, gain, gain_observed, T_world_camera, candidates, evaluated, refused, frames, points_at_object, "
    "looks_at_object, path_m, motion_s, planner_map_ms, candidates_ms, segmentation_ms, saliency_ms, "
    "reachability_ms, evaluation_ms, planning_ms, motion_ms, fusion_ms, coverage, unknown_left, "
    "unknown_near_objects, accuracy_m, chamfer_m, f_score"};

constexpr const char* kStored{
    "SELECT scene, scene_hash, strategy, noise, seed, settings, views, program_version FROM runs ORDER BY id"};

/// A run whose measures at the end are not those of its last view (of the scan, where it has none), or whose views are
/// not all there. Both are written once, with the run.
constexpr const char* kDisagreeing{R"sql(
SELECT scene, strategy, noise, seed FROM runs AS r LEFT JOIN views AS v ON v.run = r.id AND v.number = r.views
WHERE (SELECT count(*) FROM views WHERE run = r.id) <> r.views
  OR (SELECT count(*) FROM views WHERE run = r.id AND number BETWEEN 1 AND r.views) <> r.views
  OR r.coverage IS NOT iif(r.views = 0, r.initial_coverage, v.coverage)
  OR r.unknown_left IS NOT iif(r.views = 0, r.initial_unknown_left, v.unknown_left)
  OR r.unknown_near_objects IS NOT iif(r.views = 0, r.initial_unknown_near_objects, v.unknown_near_objects)
  OR r.accuracy_m IS NOT iif(r.views = 0, r.initial_accuracy_m, v.accuracy_m)
  OR r.chamfer_m IS NOT iif(r.views = 0, r.initial_chamfer_m, v.chamfer_m)
  OR r.f_score IS NOT iif(r.views = 0, r.initial_f_score, v.f_score)
LIMIT 1)sql"};

/// Columns of one table, with what their values must not be; %s stands for the column.
struct ColumnRule {
  const char* wrong;
  std::vector<const char*> columns;
};

constexpr const char* kNotText{"typeof(%s) <> 'text'"};
constexpr const char* kNoCount{"typeof(%s) <> 'integer' OR %s < 0"};
// SQLite takes texts and blobs for greater than all numbers, and no comparison holds for NULL.
constexpr const char* kNotFinite{"%s NOT BETWEEN -1.7976931348623157e308 AND 1.7976931348623157e308"};
constexpr const char* kNoShare{"%s NOT BETWEEN 0 AND 1"};

std::vector<ColumnRule> rules_of_runs() {
  return {{kNotText,
           {"scene", "scene_hash", "strategy", "noise", "settings", "stopped_because", "program_version", "finished_at",
            "scan_refused", "refused_at_end"}},
          {kNoCount,
           {"seed", "views", "scan_views", "initial_unknown_left", "initial_unknown_near_objects", "unknown_left",
            "unknown_near_objects"}},
          {kNoShare, {"initial_coverage", "coverage"}},
          {kNotFinite,
           {"seconds", "initial_accuracy_m", "initial_chamfer_m", "initial_f_score", "accuracy_m", "chamfer_m",
            "f_score"}}};
}

std::vector<ColumnRule> rules_of_views() {
  return {{kNotText, {"T_world_camera", "refused"}},
          {kNoCount,
           {"number", "region", "candidates", "evaluated", "frames", "points_at_object", "looks_at_object",
            "unknown_left", "unknown_near_objects"}},
          {kNotFinite,
           {"path_m", "motion_s", "planner_map_ms", "candidates_ms", "segmentation_ms", "saliency_ms",
            "reachability_ms", "evaluation_ms", "planning_ms", "motion_ms", "fusion_ms"}},
          {kNoShare, {"coverage"}},
          {kNotFinite, {"gain", "gain_observed", "accuracy_m", "chamfer_m", "f_score"}}};
}

std::string with_column(std::string rule, const std::string& column) {
  constexpr std::string_view kHere{"%s"};
  for (std::size_t at = 0; (at = rule.find(kHere, at)) != std::string::npos; at += column.size()) {
    rule.replace(at, kHere.size(), column);
  }
  return rule;
}

/// "CASE WHEN … THEN 'coverage' … END": the name of the first column whose value is wrong; NULL where all are right.
std::string wrong_column(const std::string& table, const std::vector<ColumnRule>& rules) {
  std::string text{"CASE"};
  for (const ColumnRule& rule : rules) {
    for (const char* column : rule.columns) {
      text += " WHEN " + with_column(rule.wrong, table + '.' + column) + " THEN '" + column + '\'';
    }
  }
  return text + " END";
}

/// What is wrong in each row of a table, and its run.
std::string select_wrong(const std::string& wrong, const std::string& from) {
  return "SELECT " + wrong + ", scene, strategy, noise, seed FROM " + from;
}

const std::array<std::string, 2>& wrong_values() {
  static const std::array<std::string, 2> kQueries{
      select_wrong(wrong_column("runs", rules_of_runs()), "runs"),
      select_wrong(wrong_column("views", rules_of_views()), "views JOIN runs ON runs.id = views.run")};
  return kQueries;
}

std::size_t count_of(std::string_view columns) {
  return static_cast<std::size_t>(std::count(columns.begin(), columns.end(), ',')) + 1;
}

std::string select_text(std::string_view columns, const std::string& from) {
  return "SELECT " + std::string{columns} + from;
}

std::string insert_text(const std::string& table, const std::string& columns) {
  std::string text = "INSERT INTO " + table + " (" + columns + ") VALUES (?";
  for (std::size_t i = 1; i < count_of(columns); ++i) text += ", ?";
  return text + ") ON CONFLICT DO NOTHING";
}

/// Reads the first eight columns of kStored and kAllRunColumns.
StoredRun stored_of(SqliteStatement& row) {
  StoredRun run;
  run.key.scene = row.text();
  run.key.scene_hash = row.text();
  run.key.strategy = row.text();
  run.key.noise = row.text();
  run.key.seed = static_cast<std::uint64_t>(row.integer());
  run.key.settings = row.text();
  run.views = static_cast<std::size_t>(row.integer());
  run.program_version = row.text();
  return run;
}

bool same_gain(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool same_view(const ViewRecord& a, const ViewRecord& b) {
  return a.region == b.region && same_gain(a.gain_predicted, b.gain_predicted) &&
         same_gain(a.gain_observed, b.gain_observed) && a.T_world_camera.matrix() == b.T_world_camera.matrix() &&
         a.candidates == b.candidates && a.evaluated == b.evaluated && a.refused == b.refused && a.frames == b.frames &&
         a.reveals_object == b.reveals_object && a.looks_at_object == b.looks_at_object && a.path_m == b.path_m &&
         a.motion_s == b.motion_s && a.measures == b.measures;
}

/// Compares everything but times and who made it.
bool same_figures(const RunRecord& a, const RunRecord& b) {
  if (a.stopped_because != b.stopped_because || a.refused_at_end != b.refused_at_end || a.scan.views != b.scan.views ||
      a.scan.refused != b.scan.refused || a.scan.measures != b.scan.measures || a.views.size() != b.views.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    if (!same_view(a.views[i], b.views[i])) return false;
  }
  return true;
}

std::string name_of(const CampaignKey& key) {
  return key.scene + ", " + key.strategy + ", " + key.noise + ", seed " + std::to_string(key.seed);
}

/// Reads scene, strategy, noise and seed, the next columns of a row.
std::string next_name(SqliteStatement& row) {
  CampaignKey key;
  key.scene = row.text();
  key.strategy = row.text();
  key.noise = row.text();
  key.seed = static_cast<std::uint64_t>(row.integer());
  return name_of(key);
}

/// Looks for a wrong value with a query of wrong_values().
Status check_rows(const SqliteFile& file, const std::string& query) {
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file, query));
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return {};
    const std::string column = row.text();
    if (column.empty()) continue;
    return Error{Errc::corrupt_data,
                 "holds a value of " + column + " that the run " + next_name(row) +
                     " cannot have; it was changed or damaged: move it away, and do its runs again",
                 file.path().string()};
  }
}

Status check_values(const SqliteFile& file) {
  for (const std::string& query : wrong_values()) SACCADE_CHECK(check_rows(file, query));
  return {};
}

/// Copies the views of one run.
class ViewCopy {
 public:
  static Result<ViewCopy> prepare(const SqliteFile& from, const SqliteFile& into) {
    SACCADE_TRY(
        SqliteStatement read,
        SqliteStatement::prepare(from, select_text(kAllViewColumns, " FROM views WHERE run = ? ORDER BY number")));
    SACCADE_TRY(SqliteStatement write,
                SqliteStatement::prepare(into, insert_text("views", std::string{kAllViewColumns} + ", run")));
    return ViewCopy{std::move(read), std::move(write)};
  }

  Status copy(std::int64_t run, std::int64_t new_run) {
    read_.restart();
    read_.bind(run);
    while (true) {
      SACCADE_TRY(const bool more, read_.step());
      if (!more) return {};
      for (std::size_t i = 0; i < count_; ++i) write_.bind_next_of(read_);
      write_.bind(new_run);
      SACCADE_CHECK(write_.run());
    }
  }

 private:
  ViewCopy(SqliteStatement read, SqliteStatement write) : read_{std::move(read)}, write_{std::move(write)} {}
  SqliteStatement read_;
  SqliteStatement write_;
  std::size_t count_{count_of(kAllViewColumns)};
};

Status check_known(const Campaign& campaign, const Campaign& shard, const CampaignKey& key) {
  SACCADE_TRY(const std::optional<CampaignEntry> ours, campaign.find(key));
  SACCADE_TRY(const std::optional<CampaignEntry> theirs, shard.find(key));
  if (ours && theirs && same_figures(ours->run, theirs->run)) return {};
  if (ours && theirs && ours->program_version != theirs->program_version) {
    return Error{Errc::unsupported,
                 "holds the run " + name_of(key) + " as Saccade " + theirs->program_version +
                     " made it, and the campaign as " + ours->program_version +
                     " did, with other figures; use one version for a campaign, and do the runs of the other again",
                 {}};
  }
  return Error{
      Errc::invalid_argument,
      "holds the run " + name_of(key) +
          " with other figures than the campaign or a shard before it, which cannot be; one of the programs or "
          "files is broken",
      {}};
}

}  // namespace

Result<Campaign> Campaign::open_to_read(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLeastPage{512};  // SQLite takes what is shorter for an empty file
  std::error_code code;
  const std::uintmax_t bytes = std::filesystem::file_size(path, code);
  if (!code && bytes > 0 && bytes < kLeastPage) {
    return Error{Errc::corrupt_data, "is not an SQLite file, or was cut short; move it away", path.string()};
  }
  SACCADE_TRY(SqliteFile file, SqliteFile::open_existing(path, kCampaignBusy_ms));
  SACCADE_TRY(const bool made, has_campaign_tables(file));
  return Campaign{std::move(file), made};
}

Status Campaign::check_whole() const {
  SACCADE_TRY(SqliteStatement check, SqliteStatement::prepare(file_, "PRAGMA quick_check(1)"));
  SACCADE_TRY(const bool row, check.step());
  if (!row || check.text() != "ok") {
    return Error{Errc::corrupt_data, "is damaged or was cut short; move it away, and do its runs again",
                 path().string()};
  }
  if (!made_) return {};
  SACCADE_CHECK(check_values(file_));
  SACCADE_TRY(SqliteStatement disagreeing, SqliteStatement::prepare(file_, kDisagreeing));
  SACCADE_TRY(const bool found, disagreeing.step());
  if (!found) {
    const Status read = parse_all();
    if (read || read.error().code != Errc::corrupt_data) return read;
    Error error = read.error();
    error.message += "; the file was changed or damaged: move it away, and do its runs again";
    return error;
  }
  return Error{
      Errc::corrupt_data,
      "holds other figures for the end of the run " + next_name(disagreeing) +
          " than for its views, or lacks views; it was changed or damaged: move it away, and do its runs again",
      path().string()};
}

Status Campaign::for_each_stored(const TakeRun& take) const {
  if (!made_) return {};
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, kStored));
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return {};
    SACCADE_CHECK(take(stored_of(row)));
  }
}

Status Campaign::take_runs(const Campaign& shard, const AcceptRun& accept, CampaignMerge& merged) const {
  if (!shard.made_) return {};
  SACCADE_TRY(SqliteStatement read,
              SqliteStatement::prepare(shard.file_, select_text(kAllRunColumns, ", id FROM runs ORDER BY id")));
  SACCADE_TRY(SqliteStatement write, SqliteStatement::prepare(file_, insert_text("runs", std::string{kAllRunColumns})));
  SACCADE_TRY(ViewCopy views, ViewCopy::prepare(shard.file_, file_));
  CampaignMerge here;
  std::string why_not;  // why the first run that is left out was
  while (true) {
    SACCADE_TRY(const bool more, read.step());
    if (!more) break;
    const StoredRun run = stored_of(read);
    SACCADE_TRY(const bool known, has(run.key));
    if (known) {
      SACCADE_CHECK(check_known(*this, shard, run.key));
      ++here.known;
      continue;
    }
    SACCADE_TRY(const MergeChoice choice, accept(run));
    if (!choice.taken) {
      if (here.left_out++ == 0) why_not = choice.why_not;
      continue;
    }
    read.read_again();
    for (std::size_t i = 0; i < count_of(kAllRunColumns); ++i) write.bind_next_of(read);
    SACCADE_CHECK(write.run());
    SACCADE_CHECK(views.copy(read.integer(), file_.last_row_id()));
    ++here.added;
  }
  if (here.left_out > 0 && here.added + here.known == 0) return Error{Errc::invalid_argument, why_not, {}};
  merged.added += here.added;
  merged.known += here.known;
  merged.left_out += here.left_out;
  return {};
}

Result<CampaignMerge> Campaign::merge(std::span<const std::filesystem::path> files, const AcceptRun& accept) const {
  CampaignMerge merged;
  SACCADE_CHECK(file_.run("PRAGMA synchronous = EXTRA"));
  SACCADE_TRY(SqliteTransaction transaction, SqliteTransaction::begin(file_));
  for (const std::filesystem::path& path : files) {
    SACCADE_TRY(const Campaign shard, open_to_read(path));
    SACCADE_CHECK(shard.check_whole());
    if (const Status taken = take_runs(shard, accept, merged); !taken) {
      Error error = taken.error();
      if (error.context.empty()) error.context = path.string();
      return error;
    }
  }
  SACCADE_CHECK(transaction.commit());
  return merged;
}

}  // namespace saccade
