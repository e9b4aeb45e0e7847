// SPDX-License-Identifier: Apache-2.0
#pragma once
// SegmentedPoints: the points of a cloud, segment by segment. measure_segments: measures for saliency.
// nearest_segments: the segment of the point nearest to a place.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Points in the order of their segments, within a segment in the order given.
class SegmentedPoints {
 public:
  /// @param positions_m  of one frame; entries that are not finite are not points.
  /// @param labels       one per position: a segment below `segments`, or kUnlabelled: in none.
  /// @return size_mismatch for unlike numbers; invalid_argument for a label that is no segment.
  /// O(points).
  [[nodiscard]] static Result<SegmentedPoints> create(std::span<const Eigen::Vector3f> positions_m,
                                                      std::span<const std::uint32_t> labels, std::size_t segments);

  [[nodiscard]] std::size_t segments() const { return starts_.size() - 2; }
  [[nodiscard]] std::span<const Eigen::Vector3f> points_of(std::size_t segment) const {
    return std::span{positions_m_}.subspan(starts_[segment], starts_[segment + 1] - starts_[segment]);
  }
  /// Returns all points; those in no segment come last.
  [[nodiscard]] std::span<const Eigen::Vector3f> positions_m() const { return positions_m_; }
  /// Returns where a segment's points begin among all; for segments(): where those in none begin.
  [[nodiscard]] std::size_t start_of(std::size_t segment) const { return starts_[segment]; }
  /// Returns the segment of each point; segments() for none.
  [[nodiscard]] const std::vector<std::uint32_t>& segment_of() const { return segment_of_; }

 private:
  SegmentedPoints() = default;
  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint32_t> segment_of_;
  std::vector<std::size_t> starts_;  ///< start of each segment, of the points in none, and the end
};

/// Measures of a segment.
struct SegmentMeasures {
  std::size_t points{0};
  Eigen::Vector3d mean_m{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d axes{Eigen::Matrix3d::Identity()};  ///< columns: principal axes, smallest spread first
  Eigen::Vector3d sizes_m{Eigen::Vector3d::Zero()};   ///< sizes of the oriented bounding box along the axes, d of eq.
                                                      ///< 3.8
  Eigen::Vector3d lowest_m{Eigen::Vector3d::Zero()};  ///< corners of the box along x, y, z
  Eigen::Vector3d highest_m{Eigen::Vector3d::Zero()};
  double roundness{0.0};  ///< d_min / d_max; 0 where all points coincide
  double isolation{0.0};  ///< F of eq. 3.11
};

struct MeasureConfig {
  double isolation_distance_m{0.02};  ///< B_th of eq. 3.11

  /// @return invalid_argument for a distance that is not finite and positive.
  [[nodiscard]] Status validate() const;
};

/// Measures segments: oriented bounding boxes by principal axes, and isolation: the share of a segment's points farther
/// than B_th from every point outside it, in another segment or none.  Thesis §3.1.2, eq. 3.8–3.11.
/// @return one entry per segment; all zero for one without points. Errors of the config.
/// O(points) away from where segments meet, O(points · log points) there. The thread count never changes a bit.
[[nodiscard]] Result<std::vector<SegmentMeasures>> measure_segments(const SegmentedPoints& points,
                                                                    const MeasureConfig& config,
                                                                    const Executor& executor);

/// Returns for each place the segment of the nearest point, the first at a tie; kUnlabelled where that point is in no
/// segment, or there is no point. FindNear of thesis Algorithm 4, line 8. Expects finite places. O(points + places) for
/// places within kNearSurface_m of a point, O(points) for each of the others. The thread count never changes the
/// result.
[[nodiscard]] std::vector<std::uint32_t> nearest_segments(const SegmentedPoints& points,
                                                          std::span<const Eigen::Vector3d> places_m,
                                                          const Executor& executor);
constexpr double kNearSurface_m{0.04};

}  // namespace saccade
