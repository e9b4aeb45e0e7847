// SPDX-License-Identifier: Apache-2.0
#pragma once
// explore: the closed loop of looking, fusing and deciding where to look next.

#include <functional>
#include <string_view>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/explore/strategy.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/robot/robot.hpp"
#include "saccade/sensor/camera_source.hpp"

namespace saccade {

struct ExplorationConfig {
  /// IncTh of Algorithm 1, ScoreTH of Algorithm 4, in the strategy's unit: a region whose best view gains less is done.
  double min_gain{200.0};
  /// Views that gain at least this share of the best one's are as good as the best: among these the robot goes to the
  /// one that it reaches soonest. 1: to the best alone.
  double good_enough{1.0};
  int max_views{12};                             ///< in all
  double oscillation_rad{0.087266462599716474};  ///< 5°: at each view the camera is tilted from minus to plus this
  int oscillation_frames{5};                     ///< frames taken on the way; 1: none but the view itself
  /// Seconds of motion between frames that are fused on the way to a view (KFOM of thesis §2.2); 0: none are, the map
  /// learns at views alone (KFOVP). For robots that know their way.
  double frame_on_way_s{0.0};

  [[nodiscard]] Status validate() const;
};

/// How far the camera was tilted at a view, about its x axis.
struct Tilt {
  double least_rad{0.0};
  double greatest_rad{0.0};
};

/// One view that was taken.
struct ExploredView {
  std::size_t region{0};  ///< index of the region it was chosen for
  double gain{0.0};       ///< as predicted
  Pose T_world_camera{Pose::Identity()};
  std::size_t candidates{0};  ///< poses it was chosen from, those that the robot cannot take included
  std::size_t evaluated{0};   ///< of those, the ones that the strategy judged
  RefusalCounts refused{};    ///< of those, by reason; with the ones for which no path was found
  std::size_t frames{0};      ///< fused at the view
  std::size_t frames_on_way{0};
  Tilt tilt{};                 ///< ±oscillation_rad, or as far towards either end as the robot could
  double planner_map_ms{0.0};  ///< what the robot must not touch brought up to date
  double candidates_ms{0.0};
  double segmentation_ms{0.0};
  double saliency_ms{0.0};
  double reachability_ms{0.0};
  double evaluation_ms{0.0};
  double planning_ms{0.0};  ///< of motions, those to views that were not reached included
  double motion_ms{0.0};
  double fusion_ms{0.0};                ///< seeing and fusing all frames
  double motion_s{0.0};                 ///< what motion and oscillation take a real arm; 0 where that is not known
  double retreat_s{0.0};                ///< of these, backing out of what was seen where an arm stood
  std::optional<Configuration> q{};     ///< of an arm that stands at the view
  std::vector<Eigen::Vector3d> path{};  ///< the camera's centre on its way, where the robot knows it
};

enum class StopReason : std::uint8_t {
  regions_done,   ///< no view of any region that the robot can take gains min_gain
  views_used_up,  ///< max_views
  no_candidate,   ///< no view of a region can be reached, or none of those that would gain enough
  cancelled,      ///< the caller's progress, or a hook, said so
};
[[nodiscard]] std::string_view to_string(StopReason reason);

/// How the exploration of one region ended.
enum class RegionEnd : std::uint8_t {
  not_begun,
  done,          ///< no view that was not attempted gains min_gain
  out_of_reach,  ///< some would gain as much, but the robot could not take them
  interrupted,   ///< max_views, or cancelled
};
[[nodiscard]] std::string_view to_string(RegionEnd end);

/// What became of one region.
struct RegionOutcome {
  RegionEnd end{RegionEnd::not_begun};
  double gain_left{0.0};    ///< of the best view that was not attempted, when it was asked for last; 0: there was none
  RefusalCounts refused{};  ///< out_of_reach: why
};

struct ExplorationResult {
  std::vector<ExploredView> views;
  std::vector<RegionOutcome> regions;  ///< one for each
  StopReason stopped_because{StopReason::regions_done};
  RefusalCounts refused_at_end{};  ///< no_candidate: why no view was left, of the last region of which that is so
};

/// Takes a picture from where the camera is.
using Observe = std::function<Result<Frame>(const Pose& T_world_camera)>;

/// What an exploration works with.
struct ExplorationCell {
  PinholeCamera camera;
  Observe observe;
  Robot& robot;
};

/// What a caller may say before the camera moves to a view.
enum class Consent : std::uint8_t { go, pass_over, stop };

/// The caller's part in an exploration; each may be empty.
struct ExplorationHooks {
  /// Asked before each move to a view that was found to be possible, those of the initial scan included.
  std::function<Consent(const Proposal& view)> before_move;
  /// Told when a region is left, however it ended.
  std::function<void(std::size_t region, const RegionOutcome& outcome)> after_region{};
  /// Told after each view, with the map as it is then and what the view was chosen from; false stops.
  std::function<bool(const ExploredView& view, const Proposals& proposals)> after_view;
};

/// What the initial scan came to.
struct ScanResult {
  bool complete{true};  ///< false: a hook or progress stopped it
  std::size_t views{0};
  RefusalCounts refused{};  ///< poses that were passed over
};

/// Moves to each pose that can be reached, looks, and fuses: the initial scan. What the robot sweeps on its way through
/// them is set free before, as nobody would start it otherwise (Robot::swept_by).
/// Errors: those of robot, camera and map.
[[nodiscard]] Result<ScanResult> scan(TsdfMap& map, ExplorationCell& cell, const std::vector<Pose>& T_world_camera,
                                      const ExplorationConfig& config, const Executor& executor,
                                      const ExplorationHooks& hooks = {}, const Progress& progress = {});

/// Thesis Algorithm 1, lines 4–17, for each region in turn. A pose is attempted once per region; after each view the
/// strategy is asked anew, and also when none of what it proposed could be reached but it has more to propose.
/// @param so_far views that an earlier, interrupted call took; the map is as they left it. The exploration goes on
///               after them, and ends as if it had never been interrupted (but asks again for poses that could not be
///               reached).
/// @return all views, so_far included; invalid_argument for a bad configuration or region; errors of strategy, robot,
///         camera and map.
[[nodiscard]] Result<ExplorationResult> explore(TsdfMap& map, ExplorationCell& cell, const std::vector<Region>& regions,
                                                const Strategy& strategy, const ExplorationConfig& config,
                                                const Executor& executor, const ExplorationHooks& hooks = {},
                                                const Progress& progress = {}, std::vector<ExploredView> so_far = {});

/// Unknown voxels whose centre lies in the region and in the map's workspace. O(voxels of the region).
[[nodiscard]] std::size_t count_unknown(const TsdfSnapshot& map, const Region& region);

}  // namespace saccade
