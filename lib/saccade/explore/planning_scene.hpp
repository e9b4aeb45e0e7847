// SPDX-License-Identifier: Apache-2.0
#pragma once
// PlanningScene: what a view is planned with: the map, the robot, and what was attempted.

#include "saccade/attention/planning_context.hpp"
#include "saccade/explore/attempts.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

struct PlanningScene {
  const TsdfSnapshot& map;
  const Executor& executor;
  PhaseTimes* times{nullptr};         ///< nullptr: times are not taken
  const Robot* robot{nullptr};        ///< nullptr: every pose may be taken
  const Attempts* attempts{nullptr};  ///< nullptr: there were none
  std::size_t first_region{0};        ///< regions of a lower index are done

  /// What attention, view generator and gain see of it.
  [[nodiscard]] PlanningContext context(std::size_t region = 0) const {
    PlanningContext context{map, executor, times, region, attempts != nullptr ? attempts->views_of(region) : 0, {}};
    if (attempts != nullptr) {
      context.attempted = [tried = attempts, region](const Pose& pose) { return tried->contains(region, pose); };
    }
    return context;
  }

  /// Keeps the poses that the robot may take, in their order. Returns the reasons of the others. Costs microseconds per
  /// pose, less than casting its rays.
  [[nodiscard]] RefusalCounts remove_unreachable(std::vector<Pose>& T_world_camera) const;
};

}  // namespace saccade
