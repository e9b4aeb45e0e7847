// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/ranking.hpp"

namespace saccade {

RefusalCounts PlanningScene::remove_unreachable(std::vector<Pose>& T_world_camera) const {
  RefusalCounts refused;
  if (robot == nullptr) return refused;
  const auto refusals = context().measure(Phase::reachability, [&] { return robot->test(T_world_camera, executor); });
  SACCADE_EXPECTS(refusals.size() == T_world_camera.size());
  refused.add(refusals);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < refusals.size(); ++i) {
    if (!refusals[i]) T_world_camera[kept++] = T_world_camera[i];
  }
  T_world_camera.resize(kept);
  return refused;
}

}  // namespace saccade
