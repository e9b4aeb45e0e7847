// SPDX-License-Identifier: Apache-2.0
#pragma once
// OrderedView and order_views: view poses by decreasing gain.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/pose.hpp"

namespace saccade {

/// A view pose, its gain, and its index among the candidates.
struct OrderedView {
  std::size_t index{0};
  std::uint64_t gain{0};
  Pose T_world_camera{Pose::Identity()};
};

/// All poses by decreasing gain, ties by increasing index (OrderViewpointsAndGains, thesis Algorithm 2 line 13).
/// `gains` and `T_world_camera` have the same length. O(n log n).
[[nodiscard]] std::vector<OrderedView> order_views(std::span<const std::uint64_t> gains,
                                                   std::span<const Pose> T_world_camera);

}  // namespace saccade
