// SPDX-License-Identifier: Apache-2.0
#pragma once
// GmmEm: mixtures of 4-D Gaussians with full covariances, fitted by expectation maximisation.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "saccade/attention/gmm_as.hpp"
#include "saccade/attention/internal/gmm_em_kernels.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// π N(μ, Σ) over (x, y, z, t).
struct Gaussian4 {
  double weight{0.0};
  Eigen::Vector4d mean{Eigen::Vector4d::Zero()};
  Eigen::Matrix4d covariance{Eigen::Matrix4d::Zero()};
};

struct GmmFit {
  std::vector<Gaussian4> gaussians;     ///< in the order of the time spans that they started from
  std::vector<double> log_likelihoods;  ///< before each iteration's update; the last belongs to `gaussians`
  bool converged{false};                ///< ended before max_iterations

  [[nodiscard]] double log_likelihood() const { return log_likelihoods.back(); }
  /// Returns −log L + ½ n ln N with n = 15 K − 1 free parameters; lower is better.
  [[nodiscard]] double bic(std::size_t samples) const;
};

/// Samples of a trajectory, ready for fitting any number of Gaussians. Thesis §2.2.4, Algorithm 3 line 8.
class GmmEm {
 public:
  /// @param samples  (x, y, z, t), in any unit; best near 1 in size, and in order of time.
  /// @return invalid_argument for no sample, one that is not finite or above 1e9, or a bad configuration. O(n).
  [[nodiscard]] static Result<GmmEm> create(std::span<const Eigen::Vector4d> samples, const GmmEmConfig& config = {});

  /// Fits a mixture, starting with mean and covariance of the samples in each of `gaussians` equal spans of t. Never
  /// NaN: covariances keep their floor, and a Gaussian without samples stays in place with weight 0. Expects gaussians
  /// ≥ 1. Shifting all samples shifts the result, up to rounding; every instruction set gives equal bits. O(iterations
  /// · samples · Gaussians), less where few Gaussians are near. Safe to call concurrently.
  [[nodiscard]] GmmFit fit(int gaussians) const;

  [[nodiscard]] std::size_t samples() const { return samples_.count; }

 private:
  GmmEm() = default;
  [[nodiscard]] std::vector<Gaussian4> start(std::size_t gaussians) const;

  GmmEmConfig config_;
  MixtureSamples samples_;  ///< around center_
  Eigen::Vector4d center_{Eigen::Vector4d::Zero()};
};

}  // namespace saccade
