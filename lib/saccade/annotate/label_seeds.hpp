// SPDX-License-Identifier: Apache-2.0
#pragma once
// label_seeds: control points that reproduce existing labels, as a start for corrections.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/neighbourhood.hpp"

namespace saccade {

struct SeedConfig {
  double share{0.99};              ///< share of the labelled points to reproduce; in (0, 1]
  std::size_t most_per_label{64};  ///< limit of control points, at least 1

  /// Answers invalid_argument for a share or a number out of range.
  [[nodiscard]] Status validate() const;
};

struct LabelSeeds {
  std::vector<SetControlPoints> actions;  ///< one per label, ascending; points ascending, start costs 0
  std::size_t points{0};                  ///< labelled points; points without neighbours have no label
  std::size_t reproduced{0};              ///< points among these that get their label from the control points
};

/// Places control points like SimulatedAnnotator, many at a time. First at the centre of every region of a label
/// (error_regions), except regions no larger than a point with its neighbours; a label's largest region always gets
/// one. Then in rounds at the centres of the largest wrong regions, until the share is reproduced, labels are full or
/// nothing helps any more. Points without a label may get any.
/// @param labels  one per point of the graph; kNoLabel: none.
/// @return size_mismatch unless graph, cloud and labels have equally many points; invalid_argument for a bad
/// configuration, a label above kMaxLabel, or no label at all on points with neighbours. O(edges) at first and per
/// round O(points + edges of what changes), one thread.
[[nodiscard]] Result<LabelSeeds> label_seeds(std::shared_ptr<const Neighbourhood> neighbourhood,
                                             const PointCloud& cloud, std::span<const std::uint32_t> labels,
                                             const SeedConfig& config);

}  // namespace saccade
