// SPDX-License-Identifier: Apache-2.0
#pragma once
// explore: the closed loop of looking, fusing and deciding where to look next.

#include <functional>
#include <string_view>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/robot/robot.hpp"
#include "saccade/sensor/camera_source.hpp"
#include "saccade/view/view_gain.hpp"
#include "saccade/view/view_sphere.hpp"

namespace saccade {

enum class Strategy : std::uint8_t {
  sphere,  ///< the candidates of the view sphere around a region, best gain first (Algorithm 2)
  random,  ///< the same candidates in random order: what choosing is worth
};

struct ExplorationConfig {
  Strategy strategy{Strategy::sphere};
  ViewSphereConfig sphere;
  GainConfig gain;
  std::uint64_t min_gain{500};     ///< IncTh of Algorithm 1: a region whose best view gains less is done
  int max_views{12};               ///< in all
  double oscillation_rad{0.0873};  ///< 5°: at each view the camera is tilted from minus to plus this
  int oscillation_frames{5};       ///< frames taken on the way; 1: none but the view itself
  std::uint64_t seed{1};           ///< of the random strategy

  [[nodiscard]] Status validate() const;
};

/// One view that was taken.
struct ExploredView {
  std::size_t region{0};  ///< index of the region it was chosen for
  std::uint64_t gain{0};  ///< as predicted
  Pose T_world_camera{Pose::Identity()};
  std::size_t candidates{0};  ///< poses it was chosen from
  double candidates_ms{0.0};
  double evaluation_ms{0.0};
  double motion_ms{0.0};
  double fusion_ms{0.0};  ///< seeing and fusing all frames of the oscillation
};

enum class StopReason : std::uint8_t {
  regions_done,   ///< no view of any region gains min_gain
  views_used_up,  ///< max_views
  no_candidate,   ///< views would gain enough, but none of them can be reached
  cancelled,      ///< the caller's progress, or on_view, said so
};
[[nodiscard]] std::string_view to_string(StopReason reason);

struct ExplorationResult {
  std::vector<ExploredView> views;
  StopReason stopped_because{StopReason::regions_done};
};

/// Takes a picture from where the camera is.
using Observe = std::function<Result<Frame>(const Pose& T_world_camera)>;

/// What an exploration works with.
struct ExplorationCell {
  PinholeCamera camera;
  Observe observe;
  Robot& robot;
};

/// Moves to each pose that can be reached, looks, and fuses: the initial scan. Errors: those of robot, camera and map.
[[nodiscard]] Status scan(TsdfMap& map, ExplorationCell& cell, const std::vector<Pose>& T_world_camera,
                          const ExplorationConfig& config, const Executor& executor);

/// Thesis Algorithm 1, lines 4–17, with NextBestView of Algorithm 2 for each region in turn. A pose is attempted once
/// per region; after each view the candidates are judged anew.
/// @param on_view called after each view, with the map as it is then; false stops.
/// @return the views taken; invalid_argument for a bad configuration or region; errors of robot, camera and map.
[[nodiscard]] Result<ExplorationResult> explore(TsdfMap& map, ExplorationCell& cell, const std::vector<Region>& regions,
                                                const ExplorationConfig& config, const Executor& executor,
                                                const std::function<bool(const ExploredView&)>& on_view = {},
                                                const Progress& progress = {});

/// Unknown voxels whose centre lies in the region and in the map's workspace. O(voxels of the region).
[[nodiscard]] std::size_t count_unknown(const TsdfSnapshot& map, const Region& region);

}  // namespace saccade
