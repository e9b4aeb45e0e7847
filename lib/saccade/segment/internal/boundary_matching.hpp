// SPDX-License-Identifier: Apache-2.0
#pragma once
// match_boundaries: matches points of two boundaries one to one, as many and as near as possible.

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
  std::size_t clusters{0};                                     ///< clusters with points of both
  std::size_t exact_clusters{0};                               ///< clusters among these with the minimal sum
};

/// Optimal assignment between two boundaries (thesis §4.1.2, after Martin's). Each point of one matches at most one of
/// the other, not farther apart than T_eval. The number of pairs is maximal, and of all such choices the sum of
/// distances is minimal.
///
/// The number of pairs, on which precision and recall depend, is always maximal (Hopcroft and Karp). The sum is minimal
/// in clusters up to the size in the config (Hungarian method). In larger ones pairs are formed greedily from the
/// nearest one on; pairs that must give way for more pairs are formed anew.
/// @param a, b  finite points.
/// @return an error of the config; invalid_argument for a point farther than a million T_eval.
/// O((points + neighbours within T_eval) · rounds); rounds grow as √points at worst, and are few. One thread,
/// deterministic.
[[nodiscard]] Result<BoundaryMatching> match_boundaries(std::span<const Eigen::Vector3f> positions_m,
                                                        std::span<const std::uint32_t> a,
                                                        std::span<const std::uint32_t> b,
                                                        const BoundaryMatchingConfig& config = {});

}  // namespace saccade
