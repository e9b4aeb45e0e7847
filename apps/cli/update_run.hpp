// SPDX-License-Identifier: Apache-2.0
#pragma once
// UpdateRun: one user-driven update of a simulated scene, from the scan before the task to the figures after it.

#include "explore_devices.hpp"
#include "saccade/trial/metrics.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "update_options.hpp"

namespace saccade::cli {

/// The scene that a user changes.
struct UpdateCase {
  ExploreSetup before;
  ExploreSetup after;
  std::vector<SceneChange> changes;
};
/// Errors: those of find_scene, RayScene::build and scene_changes.
[[nodiscard]] Result<UpdateCase> open_update_case(const UpdateOptions& options);

/// The hand's task, as the detector has it.
struct WatchedTask {
  HandTrajectory trajectory;
  SampleReport report;
  AttentionFindings findings;  ///< with the true places of a simulated hand
  std::vector<RegionOfInterest> regions;
  double ms{0.0};  ///< time of the detector
};
/// Reads or simulates the hand. Errors: those of reader, detector and simulated_hand, and invalid_argument for a region
/// that no map can hold; a hand without an action has no regions.
[[nodiscard]] Result<WatchedTask> watch_task(const UpdateOptions& options, const UpdateCase& subject);

/// An update as far as it came.
struct UpdateFigures {
  TsdfSnapshot before;  ///< after the scan
  ScanRecord scan;
  StandByResult after_scan;
  std::optional<Configuration> stand_by{};           ///< configuration in which an arm waits
  TsdfSnapshot forgotten;                            ///< the regions are unknown
  double forgetting_ms{0.0};                         ///< time for all regions
  UnknownOfRegions unknown_after_task;               ///< as soon as they were forgotten
  std::vector<UnknownOfRegions> unknown_after_view;  ///< one for each view
  RunRecord run;
  StandByResult back;  ///< without regions the robot came back from the scan
  TsdfSnapshot after;
  std::optional<Configuration> at_end{};  ///< where an arm stands; after an interruption not at its stand-by
  bool interrupted{false};
  std::size_t instants{0};  ///< instants of all motions at which contacts were looked for
  std::size_t contacts{0};  ///< instants at which the arm touched what was really there
};

/// Counts the unknown voxels of the workspace after each view, and keeps the views so far.
class UpdateMeter final : public Recorder {
 public:
  explicit UpdateMeter(const Box& workspace) : workspace_{workspace} {}
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;
  [[nodiscard]] const std::vector<ViewRecord>& views() const { return views_; }

 private:
  Box workspace_;
  std::vector<ViewRecord> views_;
};

/// Scans the scene before the task, returns to stand-by, lets the user change the scene, and runs Algorithm 1.
/// @param pictures  told of the views after the task, and before that of the map as it is then; may be nullptr
[[nodiscard]] Result<UpdateFigures> run_update(const UpdateOptions& options, const UpdateCase& subject,
                                               const WatchedTask& task, ExploreDevices& devices,
                                               const Executor& executor, const Progress& progress,
                                               Recorder* pictures = nullptr);

/// Opens the devices of the case, as they are before the task. `bar` shows what had to be chosen.
[[nodiscard]] Result<ExploreDevices> open_update_devices(const UpdateOptions& options, const UpdateCase& subject,
                                                         const Executor& executor, ProgressBar* bar = nullptr);

}  // namespace saccade::cli
