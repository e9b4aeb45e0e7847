// SPDX-License-Identifier: Apache-2.0
#pragma once
// match_boundaries: points of two boundaries one to one, as many and as near as can be.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/segment/segmentation_truth.hpp"

namespace saccade {

struct BoundaryMatching {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  ///< points (of a, of b), by the first
  double distance_m{0.0};                                      ///< sum over the pairs
  std::size_t clusters{0};                                     ///< with points of both
  std::size_t exact_clusters{0};                               ///< of these, those whose sum is the least there is
};

/// Assignment of least distance between two boundaries (thesis §4.1.2, after Martin's): each point of one with at most
/// one of the other, not farther apart than T_eval; as many pairs as can be, and of all such choices the one with the
/// least sum of distances.
///
/// The number of pairs, on which precision and recall depend, is always the greatest possible (Hopcroft and Karp). The
/// sum is the least in clusters up to the size in the config (Hungarian method); in larger ones pairs are made from the
/// nearest one on, and those that must make way for more pairs are made anew.
/// @param a, b  points, which are finite.
/// @return an error of the config; invalid_argument for a point farther than a million T_eval.
/// O((points + those within T_eval) · rounds); rounds grow as √points at worst, and are few. One thread, deterministic.
[[nodiscard]] Result<BoundaryMatching> match_boundaries(std::span<const Eigen::Vector3f> positions_m,
                                                        std::span<const std::uint32_t> a,
                                                        std::span<const std::uint32_t> b,
                                                        const BoundaryMatchingConfig& config = {});

}  // namespace saccade
