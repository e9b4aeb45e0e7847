// SPDX-License-Identifier: Apache-2.0
#pragma once
// label_seeds: control points that give existing labels back, to correct these from there.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/neighbourhood.hpp"

namespace saccade {

struct SeedConfig {
  double share{0.99};              ///< of the points with a label, to be reproduced; in (0, 1]
  std::size_t most_per_label{64};  ///< control points, at least 1

  /// invalid_argument for a share or a number out of range.
  [[nodiscard]] Status validate() const;
};

struct LabelSeeds {
  std::vector<SetControlPoints> actions;  ///< one per label, ascending; points ascending, start costs 0
  std::size_t points{0};                  ///< with a label; those without neighbours have none
  std::size_t reproduced{0};              ///< of these, with the same label from the control points
};

/// Control points in the manner of SimulatedAnnotator, many at a time: first at the centre of every region of a label
/// (error_regions), except of regions no larger than a point with its neighbours; of a label's largest region always.
/// Then in rounds at the centres of the largest regions that are still wrong, until the share is reproduced, labels are
/// full or nothing helps any more. Points without a label may be given any.
/// @param labels  one per point of the graph; kNoLabel: none.
/// @return size_mismatch unless graph, cloud and labels have as many points; invalid_argument for a bad configuration,
/// a label above kMaxLabel, or none at all on points that have neighbours.
/// O(edges) at first and per round O(points + edges of what changes), one thread.
[[nodiscard]] Result<LabelSeeds> label_seeds(std::shared_ptr<const Neighbourhood> neighbourhood,
                                             const PointCloud& cloud, std::span<const std::uint32_t> labels,
                                             const SeedConfig& config);

}  // namespace saccade
