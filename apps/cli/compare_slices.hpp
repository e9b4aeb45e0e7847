// SPDX-License-Identifier: Apache-2.0
#pragma once
// Slices of a campaign, the shards that hold them, and how far each is.

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "comparison.hpp"

namespace saccade::cli {

constexpr const char* kCampaignFile{"campaign.sqlite"};
constexpr const char* kShardsFolder{"shards"};
constexpr const char* kLogsFolder{"logs"};
constexpr const char* kSetAsideFolder{"set-aside"};
constexpr const char* kShardRecord{"shard.json"};

/// Returns the slice's part of the plan: runs that follow each other, so that few slices share a scene. Runs of which
/// one waits for another are not parted. Depends on nothing but the plan's length and order.
[[nodiscard]] std::vector<PlannedRun> runs_of(const Slice& slice, const std::vector<PlannedRun>& plan,
                                              bool equal_views);

/// Runs of a slice, and how many of them are done.
struct SliceRuns {
  std::size_t planned{0};
  std::size_t done{0};
};

/// Counts the runs of any slice of a plan; each question takes constant time.
class SliceCounter {
 public:
  SliceCounter(const std::vector<PlannedRun>& plan, bool equal_views);
  /// Number of slices, at most, that are not empty.
  [[nodiscard]] std::size_t parts() const { return upto_.size() - 1; }
  [[nodiscard]] SliceRuns of(const Slice& slice) const;

 private:
  std::vector<SliceRuns> upto_;  ///< runs within the first k parts, for k = 0, 1, …
};

/// DIR/shards/2-of-10.
[[nodiscard]] std::filesystem::path shard_folder(const std::filesystem::path& out, const Slice& slice);

/// Name of what tells that DIR holds a campaign: its file, a slice, or one that was set aside; nullptr without any.
[[nodiscard]] const char* campaign_marker(const std::filesystem::path& out);

/// How a slice came to its end, or that it goes on.
enum class ShardState : std::uint8_t { waiting, running, done, failed, interrupted, killed, lost, unknown };
inline constexpr auto kShardStateNames = make_names<ShardState>({{ShardState::waiting, "waiting"},
                                                                 {ShardState::running, "running"},
                                                                 {ShardState::done, "done"},
                                                                 {ShardState::failed, "failed"},
                                                                 {ShardState::interrupted, "interrupted"},
                                                                 {ShardState::killed, "killed"},
                                                                 {ShardState::lost, "lost"},
                                                                 {ShardState::unknown, "unknown"}});

/// Report of the task of a slice, in shard.json beside its campaign file.
struct ShardRecord {
  Slice slice;
  ShardState state{ShardState::waiting};
  std::size_t tries{0};  ///< times that the slice was begun
  std::string machine{};
  std::string job{};    ///< "12_3": job and task of Slurm
  std::string began{};  ///< UTC, as 2024-06-30T12:00:00Z; of the last try
  std::string ended{};
  std::string error{};  ///< why it failed; unknown: why its record cannot be read
};
[[nodiscard]] std::string machine_name();
/// The time now, UTC, as 2024-06-30T12:00:00Z.
[[nodiscard]] std::string utc_now();
[[nodiscard]] nlohmann::json to_json(const ShardRecord& record);
[[nodiscard]] Result<ShardRecord> shard_record_from_json(const nlohmann::json& json);
/// Renews the time of a record's file every minute, from a thread of its own, so that other machines see that the slice
/// goes on.
class RecordRenewal {
 public:
  explicit RecordRenewal(const std::filesystem::path& folder);

 private:
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;  ///< last: it uses the others
};

/// Reads the record of a shard's folder: waiting where there is none; killed where it says that it runs on this
/// machine, and none does; lost where it says that it runs on another, and was not renewed for a quarter of an hour;
/// unknown where the record cannot be read, which the next try writes anew.
[[nodiscard]] ShardRecord read_shard_record(const std::filesystem::path& folder, const Slice& slice);
/// Returns the records of the slices that have a folder in DIR/shards.
[[nodiscard]] std::vector<ShardRecord> shard_records(const std::filesystem::path& out);

/// A slice with what is done of it.
struct SliceProgress {
  ShardRecord record;
  std::size_t planned{0};
  std::size_t done{0};  ///< in its shard or in the campaign
};

/// The campaign files below a folder: its own, and those of its shards, sorted. The folder may also be one of shards,
/// or one shard. not_found where there is none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> campaign_files(const std::filesystem::path& folder);
/// Returns the files of the shards of a campaign alone; empty where it has none.
[[nodiscard]] std::vector<std::filesystem::path> shard_files(const std::filesystem::path& out);

/// All slices of the shards in DIR/shards, those included that have not begun.
/// @param plan  with what is done in the campaign and the shards
/// @param count  of slices that are submitted now; 0: none are
[[nodiscard]] Result<std::vector<SliceProgress>> progress_of(const Comparison& comparison,
                                                             const std::vector<PlannedRun>& plan, std::size_t count);
/// {slice, of, state, planned, done, tries, machine, job, began, ended, error} for each.
[[nodiscard]] nlohmann::json slices_json(const std::vector<SliceProgress>& slices);

}  // namespace saccade::cli
