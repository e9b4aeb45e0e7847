// SPDX-License-Identifier: Apache-2.0
#pragma once
// Campaign: the runs of a comparison in one SQLite file, each stored once, whole or not at all. Tables:
// docs/compare.md.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "saccade/explore/run_record.hpp"
#include "saccade/io/files/sqlite_file.hpp"

namespace saccade {

/// Everything that decides a run's figures. Two runs with one key are the same run.
struct CampaignKey {
  std::string scene;
  std::string scene_hash;  ///< of the scene's content (scene_hash): an edited scene is another one
  std::string strategy;
  std::string noise;      ///< of the simulated sensor: none, kinect-v1, …
  std::uint64_t seed{1};  ///< below 2⁶³
  std::string settings;   ///< canonical JSON of all that else changes the figures: keys sorted, no blanks

  [[nodiscard]] bool operator==(const CampaignKey&) const = default;
};

/// A run of a campaign. Of its views the tables keep neither pictures' data nor the arm's configuration.
struct CampaignEntry {
  CampaignKey key;
  RunRecord run;
  double seconds{0.0};
  std::string program_version;
  std::string finished_at;  ///< UTC, as 2024-06-30T12:00:00Z; set when the run is stored
};

/// An open campaign file. A run is stored in one transaction that reaches the disk before add() returns: whatever ends
/// the program later, the run is there, and an unfinished one has left no trace. Several processes may use one file at
/// once; each waits up to ten seconds for the others. One thread. Errors carry the file's path: those of SqliteFile.
class Campaign {
 public:
  /// Opens the file, or creates it, and tries whether it can be written. One of an older Saccade is brought up to date:
  /// its runs stay, and have 0 for what was not recorded then. invalid_argument for another program's database;
  /// unsupported for one of a newer Saccade.
  [[nodiscard]] static Result<Campaign> open(const std::filesystem::path& path);

  [[nodiscard]] Result<bool> has(const CampaignKey& key) const;
  /// @return whether the run was stored: false when there was one with its key, which stays. invalid_argument for a
  ///         seed of 2⁶³ or more, and for a measure that is not finite.
  [[nodiscard]] Result<bool> add(const CampaignEntry& entry) const;
  /// nullopt: no such run.
  [[nodiscard]] Result<std::optional<CampaignEntry>> find(const CampaignKey& key) const;
  /// All runs, in the order in which they were stored.
  [[nodiscard]] Result<std::vector<CampaignEntry>> runs() const;

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  explicit Campaign(SqliteFile file) : file_{std::move(file)} {}
  SqliteFile file_;
};

}  // namespace saccade
