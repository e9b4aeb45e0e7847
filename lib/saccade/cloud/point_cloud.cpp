// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/point_cloud.hpp"

#include <string>

namespace saccade {

Status PointCloud::validate() const {
  const std::size_t points = positions_m.size();
  const auto fits = [&](std::size_t count) { return count == 0 || count == points; };
  if (!fits(normals.size())) {
    return Error{Errc::size_mismatch,
                 std::to_string(normals.size()) + " normals for " + std::to_string(points) + " points", "point cloud"};
  }
  if (!fits(colors.size())) {
    return Error{Errc::size_mismatch,
                 std::to_string(colors.size()) + " colours for " + std::to_string(points) + " points", "point cloud"};
  }
  if (!fits(radii_m.size())) {
    return Error{Errc::size_mismatch,
                 std::to_string(radii_m.size()) + " radii for " + std::to_string(points) + " points", "point cloud"};
  }
  if (points >= kUnlabelled) return Error{Errc::invalid_argument, "more points than labels", "point cloud"};
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (!colors[i].allFinite()) {
      return Error{Errc::invalid_argument, "a colour is not finite", "point " + std::to_string(i)};
    }
  }
  return {};
}

}  // namespace saccade
