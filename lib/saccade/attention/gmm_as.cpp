// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/gmm_as.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "saccade/attention/internal/gmm_em.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {
namespace {

/// Conversion of seconds to mean sampling intervals after the start, and back.
struct TimeScale {
  double start_s{0.0};
  double interval_s{1.0};
};

TimeScale time_scale(const HandTrajectory& trajectory) {
  if (trajectory.size() < 2) return {trajectory.front().time_s, 1.0};
  const double span_s = trajectory.back().time_s - trajectory.front().time_s;
  return {trajectory.front().time_s, span_s / static_cast<double>(trajectory.size() - 1)};
}

/// Runs lines 1 to 4.
std::vector<Eigen::Vector4d> augmented(const HandTrajectory& trajectory, const TimeScale& scale) {
  std::vector<Eigen::Vector4d> samples;
  samples.reserve(trajectory.size());
  for (const HandSample& sample : trajectory) {
    const Eigen::Vector3d& p = sample.position_m;
    samples.emplace_back(p.x(), p.y(), p.z(), (sample.time_s - scale.start_s) / scale.interval_s);
  }
  return samples;
}

/// Runs lines 5 to 14: returns the mixture with the smallest BIC before it rises.
GmmFit best_mixture(const GmmEm& em, const GmmAsConfig& config, GmmAsResult& result) {
  const auto most =
      static_cast<int>(std::min<std::size_t>(em.samples(), static_cast<std::size_t>(config.max_gaussians)));
  GmmFit best;
  double least = std::numeric_limits<double>::infinity();
  for (int count = 1; count <= most; ++count) {
    GmmFit fit = em.fit(count);
    const double bic = fit.bic(em.samples());
    result.bic.push_back(bic);
    result.em_iterations += static_cast<int>(fit.log_likelihoods.size());
    if (bic < least) {
      least = bic;
      best = std::move(fit);
    }
    if (bic > least + config.bic_threshold) break;
  }
  return best;
}

/// Returns the saliency by eq. 2.12, 2.13.
double saliency_of(const SalientGaussian& gaussian, std::size_t count, SaliencyFormula formula) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(gaussian.covariance_m2, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d sigma = solver.eigenvalues().cwiseAbs().cwiseSqrt();
  const double sum = sigma.sum();
  if (!(sum > 0.0)) return 0.0;
  const double denominator = formula == SaliencyFormula::cubed ? sum * sum * sum : sum;
  return sigma.prod() / denominator * gaussian.weight * static_cast<double>(count);
}

std::string reason(std::size_t g, std::size_t count, double saliency, double mean) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "Gaussian %zu of %zu: saliency %.4f, %.1f times the mean of its neighbours",
                g + 1, count, saliency, saliency / mean);
  return text.data();
}

}  // namespace

GmmAsConfig GmmAsConfig::as_printed() {
  GmmAsConfig config;
  config.poi_threshold = 2.5;
  config.saliency = SaliencyFormula::as_printed;
  return config;
}

Status GmmAsConfig::validate() const {
  if (!(bic_threshold >= 0.0) || !(poi_threshold > 0.0) || max_gaussians < 1 || neighbours < 1) {
    return Error{Errc::invalid_argument, "thresholds, max_gaussians and neighbours must be positive", "GmmAsConfig"};
  }
  return em.validate();
}

Result<GmmAsResult> detect_by_gmm(const HandTrajectory& trajectory, const GmmAsConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(validate(trajectory));
  GmmAsResult result;
  if (trajectory.empty()) return result;

  const TimeScale scale = time_scale(trajectory);
  SACCADE_TRY(const GmmEm em, GmmEm::create(augmented(trajectory, scale), config.em));
  GmmFit best = best_mixture(em, config, result);

  std::stable_sort(best.gaussians.begin(), best.gaussians.end(),
                   [](const Gaussian4& a, const Gaussian4& b) { return a.mean[3] < b.mean[3]; });
  for (const Gaussian4& fitted : best.gaussians) {
    SalientGaussian gaussian;
    gaussian.weight = fitted.weight;
    gaussian.mean_m = fitted.mean.head<3>();
    gaussian.covariance_m2 = fitted.covariance.topLeftCorner<3, 3>();
    gaussian.time_s = scale.start_s + scale.interval_s * fitted.mean[3];
    gaussian.saliency = saliency_of(gaussian, best.gaussians.size(), config.saliency);
    result.gaussians.push_back(gaussian);
  }
  std::vector<double> saliencies;
  for (const SalientGaussian& gaussian : result.gaussians) saliencies.push_back(gaussian.saliency);
  const auto means = mean_neighbour_saliencies(saliencies, config.neighbours);
  for (std::size_t g = 0; g < result.gaussians.size(); ++g) {
    if (!means[g]) continue;
    SalientGaussian& gaussian = result.gaussians[g];
    gaussian.threshold = config.poi_threshold * *means[g];
    gaussian.is_poi = gaussian.saliency > *gaussian.threshold;
    if (!gaussian.is_poi) continue;
    result.actions.push_back({gaussian.mean_m, gaussian.time_s, gaussian.saliency,
                              reason(g, result.gaussians.size(), gaussian.saliency, *means[g])});
  }
  return result;
}

std::vector<std::optional<double>> mean_neighbour_saliencies(std::span<const double> saliencies, int neighbours) {
  SACCADE_EXPECTS(neighbours >= 1);
  const auto reach = static_cast<std::size_t>(neighbours);
  std::vector<std::optional<double>> means(saliencies.size());
  for (std::size_t g = 1; g + 1 < saliencies.size(); ++g) {
    const std::size_t first = g - std::min(g, reach);
    const std::size_t last = std::min(g + reach, saliencies.size() - 1);
    double sum{0.0};
    for (std::size_t i = first; i <= last; ++i) sum += i == g ? 0.0 : saliencies[i];
    means[g] = sum / static_cast<double>(last - first);
  }
  return means;
}

}  // namespace saccade
