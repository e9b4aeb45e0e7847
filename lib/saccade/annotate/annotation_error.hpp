// SPDX-License-Identifier: Apache-2.0
#pragma once
// score_annotation: labels against the truth; error_regions, region_centre: where to correct them next. Thesis §4.2.3.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Of one label of the truth.
struct ObjectScore {
  std::uint32_t label{0};
  std::size_t points{0};    ///< that have it in truth
  std::size_t labelled{0};  ///< that were given it
  std::size_t shared{0};    ///< both
  [[nodiscard]] double iou() const {
    return static_cast<double>(shared) / static_cast<double>(points + labelled - shared);
  }
};

struct AnnotationScore {
  std::vector<ObjectScore> objects;  ///< in ascending order of labels
  std::size_t points{0};             ///< that have a label in truth
  std::size_t wrong{0};              ///< of these, those with another label or none: the thesis' error score
  double mean_iou{1.0};              ///< over objects; 1 where there is none
};

/// Label 0 in truth: no point, whatever label it was given; otherwise in labels: none was given.
/// @param background  label that none stands for too, as in the thesis' score.
/// @return size_mismatch for unlike numbers of labels. O(n log labels), one thread.
[[nodiscard]] Result<AnnotationScore> score_annotation(std::span<const std::uint32_t> labels,
                                                       std::span<const std::uint32_t> truth,
                                                       std::optional<std::uint32_t> background = std::nullopt);

/// Points with a wrong label that ought to have the same one, and hang together.
struct ErrorRegion {
  std::uint32_t truth{0};
  std::vector<std::uint32_t> points;  ///< in ascending order
};

/// Connected along edges that labels can spread on: those that cost less than Ω_max.
/// @return the largest first, of equals the one with the first point; size_mismatch unless there are as many labels as
/// points in the graph. O(edges of wrong points), one thread.
[[nodiscard]] Result<std::vector<ErrorRegion>> error_regions(const Neighbourhood& neighbourhood,
                                                             std::span<const std::uint32_t> labels,
                                                             std::span<const std::uint32_t> truth,
                                                             std::optional<std::uint32_t> background = std::nullopt);

/// For each point, in the cloud's order, 1 where the cloud ends: what is up to three steps away lies to one side, as
/// seen along the surface. A strip about two points wide along the ends of a cloud; of evenly spread points none
/// inside, of points scattered at random one in fifty, by the holes between them. Once per cloud.
/// @param normals  of unit length, one per position, or none; without them sharp edges count as ends, too.
/// O(edges), one thread.
[[nodiscard]] std::vector<std::uint8_t> cloud_ends(const Neighbourhood& neighbourhood,
                                                   std::span<const Eigen::Vector3f> positions_m,
                                                   std::span<const Eigen::Vector3f> normals);

/// The point of a region that lies deepest inside: where simulated annotators of interactive segmentation click (the
/// greatest distance transform of an image's largest error). Depth counts steps in the graph, as pixels do in an image,
/// along edges of any cost. It is least at points with a neighbour outside the region, and where the cloud ends, as
/// at an image's border. Of equally deep points the first; without any such border the first of all.
/// @param ends  cloud_ends, or none: then these do not count. Expects a region with points.
/// O(points of the cloud + edges of the region), one thread.
[[nodiscard]] std::uint32_t region_centre(const Neighbourhood& neighbourhood, std::span<const std::uint8_t> ends,
                                          const ErrorRegion& region);

/// The same of several regions that share no point, at the cost of their sum.
[[nodiscard]] std::vector<std::uint32_t> region_centres(const Neighbourhood& neighbourhood,
                                                        std::span<const std::uint8_t> ends,
                                                        std::span<const ErrorRegion> regions);

}  // namespace saccade
