// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_segments, segments_panel, saliency_panel, marked_panel: a cloud or a mesh coloured by its segments, by their
// saliency, or by labels; saliency_picture: what drew the attention of an exploration. Thesis Figs. 3.6, 3.16 and 3.18.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "saccade/attention/segmented_points.hpp"
#include "saccade/cloud/upright.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/viewpoint.hpp"

namespace saccade {

/// Points with their segments.
struct DrawnSegments {
  std::span<const Eigen::Vector3f> positions_m;             ///< one that is not finite is not drawn
  std::span<const Eigen::Vector3f> normals;                 ///< one per position, or none: no shading
  std::span<const std::uint32_t> labels;                    ///< one per position; kUnlabelled: grey
  std::span<const std::array<std::uint32_t, 3>> triangles;  ///< between them; none: points are drawn as discs
  double spacing_m{0.005};                                  ///< between points: the discs' size
};

/// A colour for each segment, unlike those of the segments numbered next to it.
[[nodiscard]] std::vector<Rgb8> segment_colors(std::size_t segments);

/// Each point in the colour of its segment, shaded by its normal. Expects a colour per segment.
[[nodiscard]] ColorImage draw_segments(const DrawnSegments& segments, const Viewpoint& view,
                                       std::span<const Rgb8> colors, const Executor& executor);

/// The segments, told apart by colour, the largest of them named by their numbers, which begin with 1.
[[nodiscard]] Panel segments_panel(const DrawnSegments& segments, std::span<const SegmentMeasures> measures,
                                   const Viewpoint& view, const Executor& executor);

/// The segments, the more salient the brighter, with a scale from 0 to `most`; `values` has one saliency per segment.
[[nodiscard]] Panel saliency_panel(const DrawnSegments& segments, std::span<const double> values, double most,
                                   const Viewpoint& view, std::string title, const Executor& executor);

/// Each point in the colour of its segment, as given, and some points marked by a dot of that colour with a rim, which
/// shows faintly through what hides it. Expects a colour per segment.
[[nodiscard]] Panel marked_panel(const DrawnSegments& segments, std::span<const Rgb8> colors,
                                 std::span<const std::uint32_t> marked, const Viewpoint& view, std::string title,
                                 const Executor& executor);

/// The view of a camera at the origin that looks along +z with y downwards, wide enough for all points.
[[nodiscard]] Viewpoint camera_view_of(std::span<const Eigen::Vector3f> positions_m, int width, int height);
/// overview_of for points, of which at least one is finite, but for outliers far from the others.
[[nodiscard]] Viewpoint overview_of_points(std::span<const Eigen::Vector3f> positions_m, const OverviewConfig& config);

/// camera_view_of for points in a camera's frame unless `up` was stated, else overview_of_points from the side that
/// they were seen from.
[[nodiscard]] Viewpoint upright_view_of(std::span<const Eigen::Vector3f> positions_m, const Upright& upright, int width,
                                        int height);

/// A point at the border of what is known, and the direction to look at it from.
struct DrawnContour {
  Eigen::Vector3d p_world{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal_world{Eigen::Vector3d::UnitZ()};
  bool chosen{false};  ///< on the segment that the view is to show
};

struct SaliencyScene {
  const TriangleMesh& mesh;               ///< the map's, before the move
  std::span<const std::uint32_t> labels;  ///< segment of each vertex; others than those with a saliency: grey
  std::span<const double> saliency;       ///< one for each segment
  std::span<const DrawnContour> contours;
  const Box& workspace;  ///< all of the surface in it is in the picture
  Pose T_world_chosen{Pose::Identity()};
  PinholeCamera sensor;  ///< shape of the frustum
};

/// The surface from outside, the more salient the brighter; contour points, those of the chosen segment with their
/// normals; the chosen view as a frustum. The thread count does not change the picture.
[[nodiscard]] ColorImage saliency_picture(const SaliencyScene& scene, const Executor& executor,
                                          const OverviewConfig& config = {.width = 720, .height = 540});

}  // namespace saccade
