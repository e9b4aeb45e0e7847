// SPDX-License-Identifier: Apache-2.0
#pragma once
// SegmentationTruth: the true segments of a surfel cloud, and scores of segmentations; curves over thresholds.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

class BoundaryFinder;

/// Parameters of match_boundaries.
struct BoundaryMatchingConfig {
  double tolerance_m{0.02};  ///< T_eval: largest distance between the two points of a pair (thesis Table 4.2)
  /// Largest cluster of points that could be paired, directly or by way of others, for which the sum of distances is
  /// exactly minimal.
  std::size_t exact_cluster{256};

  /// @return invalid_argument for a tolerance that is not finite and positive, or clusters beyond 4096 points.
  [[nodiscard]] Status validate() const;
};

/// Parameters of SegmentationTruth.
struct SegmentationTruthConfig {
  BoundaryMatchingConfig matching;  ///< T_eval also applies to the boundaries
  bool split{true};                 ///< splits true labels whose surfels do not touch; needs radii
};

/// Score of one segmentation. Thesis §4.1.2.
struct SegmentationScore {
  std::size_t boundary{0};       ///< surfels of its boundary
  std::size_t true_boundary{0};  ///< surfels of the truth's boundary
  std::size_t matched{0};        ///< pairs of them: true positives
  double distance_m{0.0};        ///< mean over the pairs
  double bce{0.0};

  /// Returns the share of its boundary that is matched; none without a boundary.
  [[nodiscard]] std::optional<double> precision() const;
  /// Returns the share of the truth's boundary that is matched; none where the truth has no boundary.
  [[nodiscard]] std::optional<double> recall() const;
  /// Returns the harmonic mean of both: 2 · matched / (boundary + true boundary); none where neither has a boundary.
  [[nodiscard]] std::optional<double> f() const;
};

class SegmentationTruth {
 public:
  /// @param cloud   positions; and radii, where the truth is to be split.
  /// @param labels  one per point; points without a label or a finite position are ignored.
  /// @return an error of the cloud or the config; size_mismatch unless there is one label per point.
  [[nodiscard]] static Result<SegmentationTruth> create(const PointCloud& cloud, std::span<const std::uint32_t> labels,
                                                        const SegmentationTruthConfig& config,
                                                        const Executor& executor);

  /// Returns the number of points that count.
  [[nodiscard]] std::size_t points() const { return points_; }
  /// Returns the number of true segments after splitting.
  [[nodiscard]] std::size_t segments() const { return segments_; }
  [[nodiscard]] std::span<const std::uint32_t> boundary() const { return boundary_; }

  /// @param labels  one per point of the truth; points without one form one segment.
  /// @return size_mismatch for another number of labels. The thread count never changes a bit of the result.
  [[nodiscard]] Result<SegmentationScore> score(std::span<const std::uint32_t> labels, const Executor& executor) const;

 private:
  explicit SegmentationTruth(BoundaryFinder finder);

  SegmentationTruthConfig config_;
  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint32_t> labels_;
  std::size_t points_{0};
  std::size_t segments_{0};
  Hidden<BoundaryFinder> finder_;
  std::vector<std::uint32_t> boundary_;
};

}  // namespace saccade
