// SPDX-License-Identifier: Apache-2.0
#pragma once
// Explorer: the closed loop of choosing a view, moving there, taking frames and fusing them. Thesis Algorithms 1 and 4.

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/explore/foresight.hpp"
#include "saccade/explore/recorder.hpp"
#include "saccade/explore/stopping.hpp"
#include "saccade/explore/surface_model.hpp"
#include "saccade/explore/view_planner.hpp"
#include "saccade/robot/robot.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade {

struct ExplorerConfig {
  /// Views whose gain is at least this share of the best one's count as equally good: the robot takes the one that it
  /// reaches soonest. 1: only the best counts.
  double good_enough{1.0};
  int max_views{12};              ///< limit for the run
  double oscillation_rad{5_deg};  ///< at each view the camera is tilted from minus to plus this angle
  int oscillation_frames{5};      ///< frames taken during the oscillation; 1: only the view itself
  /// Seconds of motion between frames that are fused on the way to a view (KFOM of thesis §2.2); 0: only frames at
  /// views are fused (KFOVP). For robots that know their path.
  double frame_on_way_s{0.0};
  bool way_counts{true};                    ///< whether these frames' expected gain counts: Foresight; false: as in the
                                            ///< thesis
  int lookahead{1};                         ///< number of views chosen together: Foresight
  Objective objective{Objective::surface};  ///< criterion for choosing a view

  /// Source of the frames' poses. forced takes the robot's. hint lets ICP start there, and takes the robot's where ICP
  /// fails. icp lets it start where the robot's motion leads from the last tracked pose, and skips frames where it
  /// fails; so does rgbd, with colours.
  TrackingMode tracking{TrackingMode::forced};
  /// Added to the camera's times to get the robot's. Frames with a time are fused where the robot was at that time, if
  /// the robot has a clock too.
  double camera_clock_offset_s{0.0};
  IcpConfig icp{.max_translation_m = 0.08, .max_rotation_rad = 0.15};

  [[nodiscard]] Status validate() const;
  [[nodiscard]] Foresight foresight() const {
    return {static_cast<std::size_t>(lookahead), objective, way_counts ? frame_on_way_s : 0.0};
  }
};

/// Caller's answer before the camera moves to a view.
enum class Approval : std::uint8_t { go, skip, stop };
using Approve = std::function<Approval(const RankedView& view)>;

/// Parts of an explorer, all of which must outlive it.
struct ExplorerParts {
  TsdfMap& map;
  Camera& camera;
  Robot& robot;
  const Executor& executor;
  Recorder* recorder{nullptr};        ///< nullptr: records only the result of explore()
  const Stopping* stopping{nullptr};  ///< in addition to ExplorerConfig::max_views
  Approve approve{};                  ///< asked before each move to a view or a scan pose; empty: go
  const Progress* progress{nullptr};
  std::function<bool()> suspended{};  ///< asked before each frame; true: none is taken. Empty: all are taken
  SurfaceModel* model{nullptr};       ///< fused beside the map; nullptr: the map alone is the model
  ViewDevice* device{nullptr};        ///< computes gains and expected surface; nullptr: the CPU does
};

/// Return to the stand-by pose.
struct StandByResult {
  bool at_stand_by{false};
  std::optional<Refusal> refusal{};  ///< why there was no motion
  double motion_s{0.0};              ///< duration of the motion on a real arm
};

/// Exploration loop. One caller at a time. Fuses the camera's frames, at poses by ExplorerConfig::tracking.
class Explorer {
 public:
  Explorer(ExplorerParts parts, const ExplorerConfig& config)
      : parts_{std::move(parts)}, config_{config}, rgbd_{tracker_config(config)} {}

  /// Performs the initial scan: moves to each reachable pose, takes frames, and fuses them. First sets free the volume
  /// that the robot sweeps on its way (Robot::swept_volume); the caller guarantees that it is free. Errors: those of
  /// robot, camera, map and recorder.
  /// @param scan  result of an earlier, interrupted call, which left the map in its present state
  [[nodiscard]] Result<ScanRecord> scan(std::span<const Pose> T_world_camera, ScanRecord scan = {});

  /// Runs Algorithm 1, lines 4–17, or the exploration of chapter 3: they differ in the planner's attention source. A
  /// pose is attempted once per region. The planner is asked again after each view, and also when no view of a ranking
  /// could be reached.
  /// @param run views and scan of an earlier, interrupted call, which left the map in its present state. The
  /// exploration ends as if it had never been interrupted, but tries again poses that could not be reached.
  /// @return the whole run; invalid_argument for a bad configuration; errors of planner, robot, camera, map, recorder.
  [[nodiscard]] Result<RunRecord> explore(ViewPlanner& planner, RunRecord run = {});

  /// Runs the whole of Algorithm 1: forgets the regions, explores one after the other, and returns to stand-by unless
  /// cancelled.
  [[nodiscard]] Result<RunRecord> update(std::span<const RegionOfInterest> changed, const ViewPlanner& planner);

  /// Runs lines 1 to 3 of Algorithm 1. Answers invalid_argument for a bad region; those before it are then already
  /// forgotten.
  [[nodiscard]] Status forget(std::span<const RegionOfInterest> regions);
  /// Runs line 17. Robots without a stand-by pose stay where they are. Errors: those of the robot.
  [[nodiscard]] Result<StandByResult> return_to_stand_by();

 private:
  enum class Outcome : std::uint8_t { arrived, nowhere_to_go, stopped_on_way, cancelled };

  [[nodiscard]] PlanningScene scene(PhaseTimes& times) const;
  [[nodiscard]] std::optional<StopReason> stopped(const RunRecord& run) const;
  [[nodiscard]] bool suspended() const { return parts_.suspended && parts_.suspended(); }
  [[nodiscard]] bool cancelled() const { return parts_.progress != nullptr && parts_.progress->cancelled(); }
  /// Ranks and tries until the robot has reached a view or no view is left.
  [[nodiscard]] Result<Outcome> go_to_next(ViewPlanner& planner, RunRecord& run, ViewRecord& view);
  [[nodiscard]] Result<Outcome> go_to_best(Ranking& ranking, ViewRecord& view);
  [[nodiscard]] Result<std::optional<Arrival>> move(const Motion& motion, ViewRecord& view);
  /// Fuses a frame on the way to a view. Returns whether it shows an obstacle in the rest of the motion.
  [[nodiscard]] Result<bool> fuse_on_way(Frame frame, const MotionSample& at, const Motion& motion, ViewRecord& view);
  [[nodiscard]] Status look(ViewRecord& view);
  /// Computes gain_observed.
  void check_promise(ViewRecord& view) const;
  [[nodiscard]] Result<Outcome> scan_from(const Pose& T_world_camera, ScanRecord& scan);
  /// Fuses a frame for which the robot reports this pose. Returns whether it was fused.
  [[nodiscard]] Result<bool> fuse(Frame frame, const Pose& T_world_robot, bool keep, TrackedFrames& tracking);
  /// Returns the pose at which a frame is fused; nullopt: ICP rejected it.
  [[nodiscard]] Result<std::optional<Pose>> track(const Frame& frame, const Pose& T_world_robot,
                                                  TrackedFrames& tracking);
  [[nodiscard]] Result<double> farthest_tilt_rad(const Pose& T_world_view, double wanted_rad);

  [[nodiscard]] static RgbdTrackerConfig tracker_config(const ExplorerConfig& config) {
    RgbdTrackerConfig tracker;
    tracker.alignment.icp = config.icp;
    return tracker;
  }

  ExplorerParts parts_;
  ExplorerConfig config_;
  Attempts attempts_;
  std::size_t region_{0};      ///< region being explored; those before it are done
  Promise promise_;            ///< promise of the view being taken
  std::vector<Frame> frames_;  ///< frames of the view being taken
  /// Last pose found by ICP, relative to the robot's.
  Pose T_robot_tracked_{Pose::Identity()};
  RgbdTracker rgbd_;  ///< used in TrackingMode::rgbd
};

}  // namespace saccade
