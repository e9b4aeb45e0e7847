// SPDX-License-Identifier: Apache-2.0
#pragma once
// view_picture: where the next best views are, around the region they are to see.

#include <span>
#include <string>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/report/ternary_picture.hpp"
#include "saccade/report/viewpoint.hpp"

namespace saccade {

/// A view pose and its gain.
struct ScoredPose {
  Pose T_world_camera{Pose::Identity()};
  double gain{0.0};
};

struct ViewPictureConfig {
  std::string title{"Next best views"};
  std::string gain_unit{"rays"};
  std::size_t best{5};   ///< views drawn as frusta with their rank
  PinholeCamera sensor;  ///< shape of the frusta
  OverviewConfig overview;
  double margin_m{0.1};  ///< shown around the candidates and the region
  int samples{2};
};

/// The ternary map around the region as seen from outside, cut to what lies among the candidates; unknown voxels of the
/// region black, all candidates' centres coloured by the best gain there, and the best views as frusta with ranks.
/// @param ranked all evaluated views, best first.
[[nodiscard]] ColorImage view_picture(const TsdfSnapshot& map, const Region& region, std::span<const ScoredPose> ranked,
                                      const Executor& executor, const ViewPictureConfig& config = {});

}  // namespace saccade
