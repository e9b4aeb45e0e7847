// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/view_gain.hpp"

#include <algorithm>

namespace saccade {

std::vector<OrderedView> order_views(std::span<const std::uint64_t> gains, std::span<const Pose> T_world_camera) {
  SACCADE_EXPECTS(gains.size() == T_world_camera.size());
  std::vector<OrderedView> views;
  views.reserve(gains.size());
  for (std::size_t i = 0; i < gains.size(); ++i) views.push_back({i, gains[i], T_world_camera[i]});
  std::stable_sort(views.begin(), views.end(),
                   [](const OrderedView& a, const OrderedView& b) { return a.gain > b.gain; });
  return views;
}

}  // namespace saccade
