// SPDX-License-Identifier: Apache-2.0
// Reading other campaigns' files, and adding their runs.
#include <algorithm>
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
  return Error{Errc::invalid_argument,
               "holds the run " + name_of(key) +
                   " with other figures than the campaign, which cannot be; one of the two programs or files is broken",
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
  static_cast<void>(made);
  return Campaign{std::move(file)};
}

Status Campaign::check_whole() const {
  SACCADE_TRY(SqliteStatement check, SqliteStatement::prepare(file_, "PRAGMA quick_check(1)"));
  SACCADE_TRY(const bool row, check.step());
  if (row && check.text() == "ok") return {};
  return Error{Errc::corrupt_data, "is damaged or was cut short; move it away, and do its runs again", path().string()};
}

Status Campaign::for_each_stored(const AcceptRun& take) const {
  SACCADE_TRY(const bool made, has_campaign_tables(file_));
  if (!made) return {};
  SACCADE_TRY(SqliteStatement row, SqliteStatement::prepare(file_, kStored));
  while (true) {
    SACCADE_TRY(const bool more, row.step());
    if (!more) return {};
    SACCADE_CHECK(take(stored_of(row)));
  }
}

Status Campaign::take_runs(const Campaign& shard, const AcceptRun& accept, CampaignMerge& merged) const {
  SACCADE_TRY(const bool made, has_campaign_tables(shard.file_));
  if (!made) return {};
  SACCADE_TRY(SqliteStatement read,
              SqliteStatement::prepare(shard.file_, select_text(kAllRunColumns, ", id FROM runs ORDER BY id")));
  SACCADE_TRY(SqliteStatement write, SqliteStatement::prepare(file_, insert_text("runs", std::string{kAllRunColumns})));
  SACCADE_TRY(ViewCopy views, ViewCopy::prepare(shard.file_, file_));
  while (true) {
    SACCADE_TRY(const bool more, read.step());
    if (!more) return {};
    for (std::size_t i = 0; i < count_of(kAllRunColumns); ++i) write.bind_next_of(read);
    const std::int64_t id = read.integer();
    SACCADE_CHECK(write.run());
    const bool added = file_.changed_rows() > 0;
    const std::int64_t new_id = file_.last_row_id();
    read.read_again();
    const StoredRun run = stored_of(read);
    SACCADE_CHECK(added ? accept(run) : check_known(*this, shard, run.key));
    if (added) SACCADE_CHECK(views.copy(id, new_id));
    ++(added ? merged.added : merged.known);
  }
}

Result<CampaignMerge> Campaign::merge(std::span<const std::filesystem::path> files, const AcceptRun& accept) const {
  CampaignMerge merged;
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
