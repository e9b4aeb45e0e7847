// SPDX-License-Identifier: Apache-2.0
#pragma once
// detect_by_gmm: GMM-AS (Gaussian mixture models, activity saliency). Finds where a hand acted by the shape of a
// mixture.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// Formula for the saliency of a Gaussian by its shape; see docs/design/attention.md.
enum class SaliencyFormula {
  cubed,  ///< σ1 σ2 σ3 / (σ1 + σ2 + σ3)³ · π c*: without unit; gives the figures of the thesis' Tables 2.5, 2.6
  as_printed,  ///< σ1 σ2 σ3 / (σ1 + σ2 + σ3) · π c*: eq. 2.13
};

/// Parameters of fitting mixtures: GmmEm.
struct GmmEmConfig {
  double covariance_floor{1e-5};  ///< added to the diagonal of every covariance, squared units of the samples
  double relative_stop{1e-8};     ///< ends when the log-likelihood rises by less than this share of itself
  int max_iterations{200};

  /// Answers invalid_argument for a value out of range.
  [[nodiscard]] Status validate() const;
};

/// Defaults that reproduce the thesis' Tables 2.2–2.4.
struct GmmAsConfig {
  double bic_threshold{50.0};  ///< BICTh: the search ends at a BIC that exceeds the smallest by more
  int max_gaussians{30};       ///< upper limit of the search for K
  double poi_threshold{2.2};   ///< POITh: multiple of the neighbours' mean saliency
  int neighbours{2};           ///< Λ, on either side
  SaliencyFormula saliency{SaliencyFormula::cubed};
  GmmEmConfig em{};

  /// Returns the printed parameters of the thesis: eq. 2.13 and POITh = 2.5; others as above.
  [[nodiscard]] static GmmAsConfig as_printed();
  /// Answers invalid_argument for a value out of range.
  [[nodiscard]] Status validate() const;
};

/// Gaussian of the best mixture, with the results of Algorithm 3.
struct SalientGaussian {
  double weight{0.0};
  Eigen::Vector3d mean_m{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d covariance_m2{Eigen::Matrix3d::Zero()};  ///< over Cartesian coordinates
  double time_s{0.0};
  double saliency{0.0};
  std::optional<double> threshold;  ///< none for the first and the last, which are never points of interest
  bool is_poi{false};
};

struct GmmAsResult {
  std::vector<HandAction> actions;         ///< points of interest by increasing time
  std::vector<SalientGaussian> gaussians;  ///< by increasing time
  std::vector<double> bic;                 ///< BIC of mixtures with 1, 2, … Gaussians, as far as the search went
  int em_iterations{0};                    ///< sum over all mixtures
};

/// Runs Algorithm 3, eq. 2.12 and 2.13. Time is counted in mean sampling intervals. A trajectory with no or too few
/// samples gives no action.
/// @return invalid_argument for a bad configuration or a bad sample (see usable_samples). One thread; deterministic.
/// O(iterations · samples · Gaussians) for each number of Gaussians tried; about 1 ms for a task of 8 s at 100 Hz.
[[nodiscard]] Result<GmmAsResult> detect_by_gmm(const HandTrajectory& trajectory, const GmmAsConfig& config = {});

/// Returns for each Gaussian the mean saliency of up to `neighbours` (Λ) existing ones on either side; none for the
/// first and the last. POITh times these are Algorithm 3's thresholds. Expects neighbours ≥ 1. O(Gaussians ·
/// neighbours).
[[nodiscard]] std::vector<std::optional<double>> mean_neighbour_saliencies(std::span<const double> saliencies,
                                                                           int neighbours);

}  // namespace saccade
