// SPDX-License-Identifier: Apache-2.0
#pragma once
// Campaign: the runs of a comparison in one SQLite file, each stored once, whole or not at all. Tables:
// docs/compare.md.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/io/sqlite_file.hpp"
#include "saccade/robot/refusal.hpp"

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

/// A map held against the truth; definitions: docs/metrics.md.
struct CampaignFigures {
  double coverage{0.0};
  std::size_t unknown_left{0};
  std::size_t unknown_near_objects{0};
  std::optional<double> accuracy_m;
  std::optional<double> chamfer_m;
  std::optional<double> f_score;

  [[nodiscard]] bool operator==(const CampaignFigures&) const = default;
};

/// What the wall time of a view is spent on, in the order in which it is done.
inline constexpr std::array<std::string_view, 9> kViewPhases{"planner_map", "candidates",   "segmentation",
                                                             "saliency",    "reachability", "evaluation",
                                                             "planning",    "motion",       "fusion"};
using PhaseTimes = std::array<double, kViewPhases.size()>;  ///< ms

struct CampaignView {
  std::size_t region{0};
  std::optional<double> gain;  ///< as predicted
  Pose T_world_camera{Pose::Identity()};
  std::size_t candidates{0};
  std::size_t evaluated{0};  ///< of these, the poses whose gain was computed
  RefusalCounts refused{};
  std::size_t frames{0};
  CampaignFigures after;
  bool points_at_object{false};  ///< by what the view made known
  bool looks_at_object{false};   ///< by its optical axis
  double path_m{0.0};            ///< of the camera, to the view
  double motion_s{0.0};          ///< of an arm; 0 where that is not known
  PhaseTimes phases_ms{};
};

struct CampaignRun {
  CampaignKey key;
  std::size_t scan_views{0};
  RefusalCounts scan_refused{};  ///< poses of the scan that were passed over
  CampaignFigures initial;       ///< after the initial scan
  std::vector<CampaignView> views;
  std::string stopped_because;
  RefusalCounts refused_at_end{};  ///< where no view could be taken any more: why
  double seconds{0.0};
  std::string program_version;
  std::string finished_at;  ///< UTC, as 2024-06-30T12:00:00Z; set when the run is stored

  [[nodiscard]] const CampaignFigures& final() const { return views.empty() ? initial : views.back().after; }
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
  ///         seed of 2⁶³ or more, and for a figure that is not finite.
  [[nodiscard]] Result<bool> add(const CampaignRun& run) const;
  /// nullopt: no such run.
  [[nodiscard]] Result<std::optional<CampaignRun>> find(const CampaignKey& key) const;
  /// All runs, in the order in which they were stored.
  [[nodiscard]] Result<std::vector<CampaignRun>> runs() const;

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  explicit Campaign(SqliteFile file) : file_{std::move(file)} {}
  SqliteFile file_;
};

}  // namespace saccade
