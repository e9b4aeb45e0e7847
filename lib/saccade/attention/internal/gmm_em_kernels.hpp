// SPDX-License-Identifier: Apache-2.0
#pragma once
// expect_mixture: the inner loop of EM for mixtures of 4-D Gaussians, in vectors of samples. For gmm_em.cpp and its
// tests.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace saccade {

/// Partial sums per value: sample i adds to sum i mod 8, whatever the width of a vector.
constexpr std::size_t kMixtureLanes{8};
/// Number of samples processed together.
constexpr std::size_t kMixtureBlock{64};

/// Coordinates in planes, padded with copies of the last sample to whole blocks.
struct MixtureSamples {
  std::array<std::vector<double>, 4> planes;
  std::size_t count{0};
};

/// One Gaussian in the form used for its density: log(π N(x)) = log_scale − ½‖W(x − mean)‖².
struct MixtureDensity {
  std::array<double, 4> mean{};
  std::array<double, 10> W{};  ///< lower triangle row by row: the inverse of the covariance's Cholesky factor
  double log_scale{0.0};
  double time_precision{0.0};  ///< inverse variance of the fourth coordinate
};

/// Sums over samples of a Gaussian's responsibilities r, with d = x − mean: r; r d_i; r d_i d_j for j ≤ i row by row.
struct MixtureMoments {
  static constexpr std::size_t kSums{15};
  alignas(64) std::array<std::array<double, kMixtureLanes>, kSums> lanes{};
  [[nodiscard]] double sum(std::size_t i) const;
};

/// Performs the E-step: adds up moments per Gaussian and returns the log-likelihood of all samples. Within a block,
/// Gaussians whose responsibilities stay below e^-40 for every sample are skipped, which is below rounding.
/// Every simd_target() gives the same bits. O(samples · Gaussians that are near).
[[nodiscard]] double expect_mixture(const MixtureSamples& samples, std::span<const MixtureDensity> mixture,
                                    std::span<MixtureMoments> moments);

}  // namespace saccade
