// SPDX-License-Identifier: Apache-2.0
#pragma once
// PlanningContext: what attention, view generators and gains may see while a view is chosen.

#include <cstddef>
#include <functional>

#include "saccade/core/executor.hpp"
#include "saccade/core/phase_times.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

struct PlanningContext {
  const TsdfSnapshot& map;
  const Executor& executor;
  PhaseTimes* times{nullptr};  ///< nullptr: times are not taken
  std::size_t region{0};       ///< RegionOfInterest::index of the region that is looked at
  std::size_t views_taken{0};  ///< views of that region so far
  /// Whether the camera went to the pose, or tried to, for this region. Empty: to none.
  std::function<bool(const Pose& T_world_camera)> attempted{};

  [[nodiscard]] bool was_attempted(const Pose& T_world_camera) const { return attempted && attempted(T_world_camera); }

  /// PhaseTimes::measure, where there are times.
  template <class Work>
  decltype(auto) measure(Phase phase, const Work& work) const {
    return times != nullptr ? times->measure(phase, work) : work();
  }
};

}  // namespace saccade
