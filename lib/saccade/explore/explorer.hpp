// SPDX-License-Identifier: Apache-2.0
#pragma once
// Explorer: the closed loop of choosing a view, going there, looking and fusing. Thesis Algorithms 1 and 4.

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/explore/foresight.hpp"
#include "saccade/explore/recorder.hpp"
#include "saccade/explore/stopping.hpp"
#include "saccade/explore/view_planner.hpp"
#include "saccade/robot/robot.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade {

struct ExplorerConfig {
  /// Views that gain at least this share of the best one's are as good as the best: among these the robot goes to the
  /// one that it reaches soonest. 1: to the best alone.
  double good_enough{1.0};
  int max_views{12};              ///< in all
  double oscillation_rad{5_deg};  ///< at each view the camera is tilted from minus to plus this
  int oscillation_frames{5};      ///< frames taken on the way; 1: none but the view itself
  /// Seconds of motion between frames that are fused on the way to a view (KFOM of thesis §2.2); 0: none are, the map
  /// learns at views alone (KFOVP). For robots that know their way.
  double frame_on_way_s{0.0};
  bool way_counts{true};                    ///< what these frames are expected to show: Foresight; false: the thesis
  int lookahead{1};                         ///< views that are chosen together: Foresight
  Objective objective{Objective::surface};  ///< what a view is chosen by

  /// Where the poses of frames come from: forced takes the robot's; hint lets ICP begin there, and takes the robot's
  /// where ICP refuses; icp lets it begin where the robot's motion leads from the last tracked pose, and does not fuse
  /// what it refuses.
  TrackingMode tracking{TrackingMode::forced};
  /// Added to the camera's times for those of the robot. Frames on the way that have a time are fused where the robot
  /// was then, where that has a clock too.
  double camera_clock_offset_s{0.0};
  IcpConfig icp{.max_translation_m = 0.08, .max_rotation_rad = 0.15};

  [[nodiscard]] Status validate() const;
  [[nodiscard]] Foresight foresight() const {
    return {static_cast<std::size_t>(lookahead), objective, way_counts ? frame_on_way_s : 0.0};
  }
};

/// What the caller answers before the camera moves to a view.
enum class Approval : std::uint8_t { go, skip, stop };
using Approve = std::function<Approval(const RankedView& view)>;

/// What an explorer works with. All of it outlives the explorer.
struct ExplorerParts {
  TsdfMap& map;
  Camera& camera;
  Robot& robot;
  const Executor& executor;
  Recorder* recorder{nullptr};        ///< nullptr: nothing is recorded but what explore() returns
  const Stopping* stopping{nullptr};  ///< besides ExplorerConfig::max_views
  Approve approve{};                  ///< asked before each move to a view or a pose of the scan; empty: go
  const Progress* progress{nullptr};
  std::function<bool()> suspended{};  ///< asked before each frame; true: none is taken. Empty: all are
};

/// Return to the stand-by pose.
struct StandByResult {
  bool at_stand_by{false};
  std::optional<Refusal> refusal{};  ///< where there was no way: why
  double motion_s{0.0};              ///< duration of the way of a real arm
};

/// One caller at a time. What is fused comes from the camera, at poses by ExplorerConfig::tracking.
class Explorer {
 public:
  Explorer(ExplorerParts parts, const ExplorerConfig& config) : parts_{std::move(parts)}, config_{config} {}

  /// The initial scan: moves to each pose that can be reached, looks, and fuses. What the robot sweeps on its way
  /// through them is set free before (Robot::swept_by): the caller vouches for it. Errors:
  /// those of robot, camera, map and recorder.
  /// @param scan  what an earlier, interrupted call did; the map is as it left it
  [[nodiscard]] Result<ScanRecord> scan(std::span<const Pose> T_world_camera, ScanRecord scan = {});

  /// Algorithm 1, lines 4–17, and the exploration of chapter 3: they differ in the planner's attention source. A pose
  /// is attempted once per region; the planner is asked anew after each view, and also when no view of a ranking could
  /// be reached.
  /// @param run views that an earlier, interrupted call took, with its scan; the map is as they left it. The
  /// exploration
  ///            ends as if it had never been interrupted, but tries again poses that could not be reached.
  /// @return the whole run; invalid_argument for a bad configuration; errors of planner, robot, camera, map, recorder.
  [[nodiscard]] Result<RunRecord> explore(ViewPlanner& planner, RunRecord run = {});

  /// Algorithm 1 whole: forgets the regions, explores one after the other, and returns to stand-by unless cancelled.
  [[nodiscard]] Result<RunRecord> update(std::span<const RegionOfInterest> changed, const ViewPlanner& planner);

  /// Lines 1 to 3 of Algorithm 1. invalid_argument for a bad region; those before it were forgotten then.
  [[nodiscard]] Status forget(std::span<const RegionOfInterest> regions);
  /// Line 17. Robots without a stand-by stay where they are. Errors: those of the robot.
  [[nodiscard]] Result<StandByResult> return_to_stand_by();

 private:
  enum class Outcome : std::uint8_t { arrived, nowhere_to_go, stopped_on_way, cancelled };

  [[nodiscard]] PlanningScene scene(PhaseTimes& times) const;
  [[nodiscard]] std::optional<StopReason> stopped(const RunRecord& run) const;
  [[nodiscard]] bool suspended() const { return parts_.suspended && parts_.suspended(); }
  [[nodiscard]] bool cancelled() const { return parts_.progress != nullptr && parts_.progress->cancelled(); }
  /// Ranks and tries until the robot stands at a view or no view is left.
  [[nodiscard]] Result<Outcome> go_to_next(ViewPlanner& planner, RunRecord& run, ViewRecord& view);
  [[nodiscard]] Result<Outcome> go_to_best(Ranking& ranking, ViewRecord& view);
  [[nodiscard]] Result<std::optional<Arrival>> move(const Motion& motion, ViewRecord& view);
  /// Fuses a frame on the way to a view. Returns whether what it shows stands in the way.
  [[nodiscard]] Result<bool> fuse_on_way(Frame frame, const CameraSample& at, const Motion& motion, ViewRecord& view);
  [[nodiscard]] Status look(ViewRecord& view);
  /// Fills in gain_observed.
  void check_promise(ViewRecord& view) const;
  [[nodiscard]] Result<Outcome> scan_from(const Pose& T_world_camera, ScanRecord& scan);
  /// Fuses a frame that the robot's motion has at a pose. Returns whether it was fused.
  [[nodiscard]] Result<bool> fuse(Frame frame, const Pose& T_world_robot, bool keep, TrackedFrames& tracking);
  /// Returns the pose at which a frame is fused; nullopt: ICP refused it.
  [[nodiscard]] Result<std::optional<Pose>> track(const Frame& frame, const Pose& T_world_robot,
                                                  TrackedFrames& tracking);
  [[nodiscard]] Result<double> farthest_tilt_rad(const Pose& T_world_view, double wanted_rad);

  ExplorerParts parts_;
  ExplorerConfig config_;
  Attempts attempts_;
  std::size_t region_{0};      ///< that is being explored; those before it are done
  Promise promise_;            ///< what the view that is being taken is to show
  std::vector<Frame> frames_;  ///< frames of the view that is being taken
  /// Where ICP last found the camera, as seen from where the robot had it.
  Pose T_robot_tracked_{Pose::Identity()};
};

}  // namespace saccade
