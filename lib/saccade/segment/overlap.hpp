// SPDX-License-Identifier: Apache-2.0
#pragma once
// SegmentOverlap, score_segments: how well segments match labelled objects. consistency_error: BCE, the difference
// between two segmentations.

#include <cstdint>
#include <span>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Overlap of segments and objects of one cloud. The best segment of an object is the one with the largest overlap.
struct SegmentOverlap {
  std::size_t objects{0};
  std::size_t points{0};           ///< points of all objects
  double over_segmentation{0.0};   ///< F_os = 1 − Σ|object ∩ best| / Σ|object|
  double under_segmentation{0.0};  ///< F_us = Σ|best ∖ object| / Σ|object|
  double weighted_overlap{0.0};    ///< WOv = Σ|object| · max IoU / Σ|object|
};

/// Compares segments with objects, point by point (Stein et al., CVPR 2014, section 4). Points without an object belong
/// to no segment; points without a segment are missed parts of objects.
/// @param segments  one label per point; kUnlabelled: none.
/// @param objects   one label per point; kUnlabelled: none. Objects below `first_object` are not scored, but count as
/// foreign points within a segment.
/// @return size_mismatch for unlike numbers of labels; no objects: all zero.
/// O(points · log points), one thread, deterministic.
[[nodiscard]] Result<SegmentOverlap> score_segments(std::span<const std::uint32_t> segments,
                                                    std::span<const std::uint32_t> objects,
                                                    std::uint32_t first_object = 0);

struct ConsistencyError {
  double bidirectional{0.0};  ///< BCE: 0 for equal segmentations; towards 1 with nothing in common
  std::size_t points{0};      ///< number of points in the mean
};

/// Bidirectional consistency error (thesis §4.1.2; Martin's, for one ground truth): the mean over points p of max(|S(p)
/// ∖ T(p)| / |S(p)|, |T(p) ∖ S(p)| / |T(p)|), where S(p) and T(p) are the segments that contain p. Unlike the local
/// error, which takes the lesser of the two, it grows with over-segmentation.
/// @param segments  one label per point; points without one, kUnlabelled, form one segment.
/// @param truth     one label per point; points without one are ignored.
/// @return size_mismatch for unlike numbers of labels; no points: 0. O(points · log points), one thread, deterministic.
[[nodiscard]] Result<ConsistencyError> consistency_error(std::span<const std::uint32_t> segments,
                                                         std::span<const std::uint32_t> truth);

}  // namespace saccade
