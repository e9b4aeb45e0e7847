// SPDX-License-Identifier: Apache-2.0
#pragma once
// consistency_error: BCE, how far two segmentations are from being each other's.

#include <cstdint>
#include <span>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

struct ConsistencyError {
  double bidirectional{0.0};  ///< BCE: 0, the same; towards 1, nothing in common
  std::size_t points{0};      ///< that it is the mean of
};

/// Bidirectional consistency error (thesis §4.1.2; Martin's, of one truth): the mean over points p of
/// max(|S(p) ∖ T(p)| / |S(p)|, |T(p) ∖ S(p)| / |T(p)|), where S(p) and T(p) are the segments that p is in. Unlike the
/// local error, which takes the lesser of the two, it grows with over-segmentation.
/// @param segments  one label per point; those without one, kUnlabelled, are one segment together.
/// @param truth     as many; points without a label are left out.
/// @return size_mismatch for unlike numbers of labels; no points: 0. O(points · log points), one thread, deterministic.
[[nodiscard]] Result<ConsistencyError> consistency_error(std::span<const std::uint32_t> segments,
                                                         std::span<const std::uint32_t> truth);

}  // namespace saccade
