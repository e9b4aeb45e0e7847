// SPDX-License-Identifier: Apache-2.0
#pragma once
// carry_labels: the labels of one cloud for the next of a sequence.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/annotation.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"

namespace saccade {

struct CarryConfig {
  /// How far a point's label reaches, in distances to the `neighbours`-th nearest point of its own cloud.
  double spacings{1.0};
  std::size_t neighbours{10};

  /// Answers invalid_argument unless spacings is finite and positive, and neighbours is 1 to 64.
  [[nodiscard]] Status validate() const;
};

/// Cloud whose labels are carried.
struct CarrySource {
  std::span<const Eigen::Vector3f> positions_m;
  std::span<const std::uint32_t> labels;  ///< per point, kNoLabel where it has none
  Pose T_to_from{Pose::Identity()};       ///< from its frame into that of the cloud that takes the labels
};

struct CarriedLabels {
  PaintLabels paint;      ///< may name no point
  std::size_t kept{0};    ///< points in reach that keep the label they have, be it the same
  std::size_t locked{0};  ///< points in reach that take none, since the label is locked
};

/// Finds the labels that a cloud takes from the one before it. Not in the thesis. A point without a label takes that of
/// the nearest point of the source, moved into its frame, if it lies within that point's reach (CarryConfig). Points of
/// the source without a label count as nearest points, too, so that a label does not spread beyond its own border.
/// Points with a label keep it, locked labels take no point, and points without neighbours take no label.
/// @param positions_m  points of `annotation`.
/// @return invalid_argument for a bad configuration, or labels of the source that are not as many as its points.
/// Cost: as nearest_neighbours of the source and nearest_points. The thread count never changes the result.
[[nodiscard]] Result<CarriedLabels> carry_labels(const CarrySource& source,
                                                 std::span<const Eigen::Vector3f> positions_m,
                                                 const Annotation& annotation, const CarryConfig& config,
                                                 const Executor& executor);

}  // namespace saccade
