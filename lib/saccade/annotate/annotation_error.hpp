// SPDX-License-Identifier: Apache-2.0
#pragma once
// score_annotation: compares labels with the ground truth. error_regions, region_centre: where to correct them next.
// Thesis §4.2.3.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Score of one label of the ground truth.
struct ObjectScore {
  std::uint32_t label{0};
  std::size_t points{0};    ///< points with this label in the ground truth
  std::size_t labelled{0};  ///< points that were given it
  std::size_t shared{0};    ///< points with both
  [[nodiscard]] double iou() const {
    return static_cast<double>(shared) / static_cast<double>(points + labelled - shared);
  }
};

struct AnnotationScore {
  std::vector<ObjectScore> objects;  ///< in ascending order of labels
  std::size_t points{0};             ///< points with a label in the ground truth
  std::size_t wrong{0};              ///< points among these with another label or none: the thesis' error score
  double mean_iou{1.0};              ///< mean over objects; 1 without objects
};

/// Scores labels. Label 0 in the ground truth excludes the point, whatever label it was given; in `labels` it means
/// none.
/// @param background  label that counts as none too, as in the thesis' score.
/// @return size_mismatch for unlike numbers of labels. O(n log labels), one thread.
[[nodiscard]] Result<AnnotationScore> score_annotation(std::span<const std::uint32_t> labels,
                                                       std::span<const std::uint32_t> truth,
                                                       std::optional<std::uint32_t> background = std::nullopt);

/// Connected points with a wrong label that share their true label.
struct ErrorRegion {
  std::uint32_t truth{0};
  std::vector<std::uint32_t> points;  ///< in ascending order
};

/// Finds the regions, connected along edges that labels can spread on: those that cost less than Ω_max.
/// @return the largest first, at a tie the one with the first point; size_mismatch unless there is one label per point
/// of the graph. O(edges of wrong points), one thread.
[[nodiscard]] Result<std::vector<ErrorRegion>> error_regions(const Neighbourhood& neighbourhood,
                                                             std::span<const std::uint32_t> labels,
                                                             std::span<const std::uint32_t> truth,
                                                             std::optional<std::uint32_t> background = std::nullopt);

/// Returns for each point, in the cloud's order, 1 where the cloud ends: where all points up to three steps away lie to
/// one side along the surface. The result is a strip about two points wide along the ends of a cloud. Evenly spread
/// points have none inside; of points scattered at random one in fifty is marked, at the holes between them. Call once
/// per cloud.
/// @param normals  of unit length, one per position, or none; without them sharp edges count as ends, too.
/// O(edges), one thread.
[[nodiscard]] std::vector<std::uint8_t> cloud_ends(const Neighbourhood& neighbourhood,
                                                   std::span<const Eigen::Vector3f> positions_m,
                                                   std::span<const Eigen::Vector3f> normals);

/// Returns the point of a region that lies deepest inside, where simulated annotators of interactive segmentation click
/// (the maximum of the distance transform of an image's largest error). Depth counts steps in the graph, as pixels in
/// an image, along edges of any cost, from points with a neighbour outside the region, and from where the cloud ends,
/// as at an image's border. The first at a tie; without such a border the first of all.
/// @param ends  cloud_ends, or empty: ends of the cloud do not count. Expects a region with points.
/// O(points of the cloud + edges of the region), one thread.
[[nodiscard]] std::uint32_t region_centre(const Neighbourhood& neighbourhood, std::span<const std::uint8_t> ends,
                                          const ErrorRegion& region);

/// Returns the centres of several disjoint regions, at the cost of their sum.
[[nodiscard]] std::vector<std::uint32_t> region_centres(const Neighbourhood& neighbourhood,
                                                        std::span<const std::uint8_t> ends,
                                                        std::span<const ErrorRegion> regions);

}  // namespace saccade
