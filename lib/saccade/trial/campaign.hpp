// SPDX-License-Identifier: Apache-2.0
#pragma once
// Campaign: the runs of a comparison in one SQLite file, each stored once and atomically. Tables:
// docs/guides/compare.md.

#include <cstdint>
#include <filesystem>
#include <optional>
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

/// Open campaign file. A run is stored in one transaction that reaches the disk before add() returns: it survives any
/// later end of the program, and an unfinished run leaves no trace. Several processes may use one file at once; each
/// waits up to ten seconds for the others. One thread. Errors carry the file's path: those of SqliteFile.
class Campaign {
 public:
  /// Opens or creates the file, and tests whether it can be written. Upgrades a file of an older Saccade: its runs
  /// stay, with 0 for values not recorded then. Answers invalid_argument for another program's database; unsupported
  /// for one of a newer Saccade.
  [[nodiscard]] static Result<Campaign> open(const std::filesystem::path& path);

  [[nodiscard]] Result<bool> has(const CampaignKey& key) const;
  /// @return whether the run was stored; false when a run with its key exists, which stays. invalid_argument for a seed
  /// of 2⁶³ or more, and for a measure that is not finite.
  [[nodiscard]] Result<bool> add(const CampaignEntry& entry) const;
  /// Returns nullopt where there is no such run.
  [[nodiscard]] Result<std::optional<CampaignEntry>> find(const CampaignKey& key) const;
  /// Returns all runs in the order in which they were stored.
  [[nodiscard]] Result<std::vector<CampaignEntry>> runs() const;

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  explicit Campaign(SqliteFile file) : file_{std::move(file)} {}
  SqliteFile file_;
};

}  // namespace saccade
