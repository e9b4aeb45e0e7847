// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_ternary, ternary_picture, ternary_figure: the map of occupied, empty and unknown as a camera would see it;
// view_picture: where the next best views are, around the region they are to see.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/viewpoint.hpp"

namespace saccade {

class Canvas;

struct TernaryPictureConfig {
  std::vector<Region> unknown_within;  ///< if any: unknown voxels outside all are transparent, and they are outlined
  std::optional<Box> crop;             ///< what lies outside is not drawn at all
  double start_m{0.1};                 ///< depth where rays start: no depth camera sees the space around its own centre
  bool outline_workspace{false};
  int samples{2};  ///< per pixel and direction
  Rgb8 background{236, 239, 243};
};

/// Draws the first voxel along each ray that is not empty (eq. 2.11): occupied in the fused colour (grey without one),
/// shaded by the gradient of the TSDF; unknown as a dark veil through which the surface behind it shows, its faces told
/// apart; empty to the end of the map:
/// background. Unknown voxels are drawn inside the workspace, without one up to a voxel beyond known_bounds(). Exact
/// traversal, the same picture for every thread count. The canvas can be drawn on further.
[[nodiscard]] Canvas draw_ternary(const TsdfSnapshot& map, const Viewpoint& view, const Executor& executor,
                                  const TernaryPictureConfig& config = {});

/// The finished picture alone.
[[nodiscard]] ColorImage ternary_picture(const TsdfSnapshot& map, const Viewpoint& view, const Executor& executor,
                                         const TernaryPictureConfig& config = {});

/// The picture with a title and what its colours mean.
[[nodiscard]] ColorImage ternary_figure(const TsdfSnapshot& map, const Viewpoint& view, const Executor& executor,
                                        const std::string& title, const TernaryPictureConfig& config = {});
/// Meaning of the colours.
[[nodiscard]] std::vector<LegendEntry> ternary_legend(const TernaryPictureConfig& config = {});

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
