// SPDX-License-Identifier: Apache-2.0
#pragma once
// Campaign: the runs of a comparison in one SQLite file, each stored once and atomically. Tables:
// docs/guides/compare.md.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/explore/run_record.hpp"
#include "saccade/io/files/sqlite_file.hpp"

namespace saccade {

/// Everything that determines a run's measures. Runs with equal keys are equal.
struct CampaignKey {
  std::string scene;
  std::string scene_hash;  ///< hash of the scene's content (scene_hash), so that an edited scene counts as another one
  std::string strategy;
  std::string noise;      ///< noise of the simulated sensor: none, kinect-v1, …
  std::uint64_t seed{1};  ///< below 2⁶³
  std::string settings;   ///< canonical JSON of everything else that affects the measures: sorted keys, no blanks

  [[nodiscard]] bool operator==(const CampaignKey&) const = default;
};

/// Run of a campaign. The tables keep neither images nor arm configurations of its views.
struct CampaignEntry {
  CampaignKey key;
  RunRecord run;
  double seconds{0.0};
  std::string program_version;
  std::string finished_at;  ///< UTC, as 2024-06-30T12:00:00Z; set when the run is stored
};

/// A run's key and what tells how it came about, without its measures.
struct StoredRun {
  CampaignKey key;
  std::size_t views{0};  ///< taken
  std::string program_version;
};

/// Result of a merge.
struct CampaignMerge {
  std::size_t added{0};
  std::size_t known{0};     ///< runs that the campaign had, with the same measures
  std::size_t left_out{0};  ///< runs that do not belong to the campaign
};

/// Takes a run; an error ends the reading.
using TakeRun = std::function<Status(const StoredRun& run)>;

/// Whether a merge takes a run.
struct MergeChoice {
  bool taken{true};
  std::string why_not{};  ///< why a run is left out: what follows the file's name in an error
};

/// Tells whether a run belongs to the campaign; an error ends the merge.
using AcceptRun = std::function<Result<MergeChoice>(const StoredRun& run)>;

/// Open campaign file. A run is stored in one transaction that reaches the disk before add() returns: it survives any
/// later end of the program, and an unfinished run leaves no trace. Several processes may use one file at once; each
/// waits up to ten seconds for the others. One thread at a time, const calls included. Errors carry the file's path:
/// those of SqliteFile.
class Campaign {
 public:
  /// Opens or creates the file, and tests whether it can be written. Upgrades a file of an older Saccade: its runs
  /// stay, with 0 for values not recorded then. Answers invalid_argument for another program's database; unsupported
  /// for one of a newer Saccade.
  [[nodiscard]] static Result<Campaign> open(const std::filesystem::path& path);

  /// Opens a file that exists, to read it. Only merge() writes to it then, but for undoing what a killed process left
  /// half done. An empty file is a campaign without runs: check_whole(), for_each_stored() and merge() read it. Answers
  /// not_found; invalid_argument for another program's database; unsupported for one of another version of Saccade.
  [[nodiscard]] static Result<Campaign> open_to_read(const std::filesystem::path& path);
  /// Reads the file from end to end. corrupt_data for one that is damaged or was cut short, that has a value which no
  /// run can have (another type, not finite, a coverage outside 0 … 1, JSON that cannot be read), that lacks views of a
  /// run, or whose runs end with other figures than their last views; the error names the run.
  [[nodiscard]] Status check_whole() const;

  [[nodiscard]] Result<bool> has(const CampaignKey& key) const;
  /// @return whether the run was stored; false when a run with its key exists, which stays. invalid_argument for a seed
  /// of 2⁶³ or more, and for a measure that is not finite.
  [[nodiscard]] Result<bool> add(const CampaignEntry& entry) const;
  /// Returns nullopt where there is no such run.
  [[nodiscard]] Result<std::optional<CampaignEntry>> find(const CampaignKey& key) const;
  /// Returns all runs in the order in which they were stored.
  [[nodiscard]] Result<std::vector<CampaignEntry>> runs() const;
  /// Returns the runs for which `wanted` is true, in the order in which they were stored, with their measures but
  /// without the poses of their views, which stay the identity: one pass over the file, for statistics of many runs.
  [[nodiscard]] Result<std::vector<CampaignEntry>> figures(
      const std::function<bool(const CampaignKey& key)>& wanted) const;
  /// Calls `take` with each run, without its measures, in the order in which they were stored; ends at the first error.
  [[nodiscard]] Status for_each_stored(const TakeRun& take) const;

  /// Adds the runs of other campaign files as they stand there, times included, in one transaction: after an error the
  /// campaign is as it was. `accept` is asked about each run that the campaign lacks. A run that it has stays; where it
  /// has other measures (times aside), invalid_argument names it. invalid_argument also for a file of which all runs
  /// are left out, with the first `why_not`. Further errors: those of open_to_read and check_whole, and of `accept`; an
  /// empty context becomes the file's path. Each file is opened and checked once. The order of the files changes no
  /// measure.
  [[nodiscard]] Result<CampaignMerge> merge(std::span<const std::filesystem::path> files,
                                            const AcceptRun& accept) const;

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  explicit Campaign(SqliteFile file, bool made = true) : file_{std::move(file)}, made_{made} {}
  /// Reads every run with its views.
  [[nodiscard]] Status parse_all() const;
  /// Within the caller's transaction.
  [[nodiscard]] Status take_runs(const Campaign& shard, const AcceptRun& accept, CampaignMerge& merged) const;
  SqliteFile file_;
  bool made_;  ///< it has tables; an empty file that is open to be read has none
};

}  // namespace saccade
