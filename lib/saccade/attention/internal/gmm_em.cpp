// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/internal/gmm_em.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace saccade {
namespace {

/// Returns the lower triangle L with L Lᵀ = Σ. A pivot that rounding made too small counts as a trillionth of its
/// variance.
Eigen::Matrix4d cholesky(const Eigen::Matrix4d& covariance) {
  constexpr double kSmallestShare{1e-12};
  Eigen::Matrix4d L = Eigen::Matrix4d::Zero();
  for (int j = 0; j < 4; ++j) {
    double pivot = covariance(j, j);
    for (int k = 0; k < j; ++k) pivot -= L(j, k) * L(j, k);
    L(j, j) = std::sqrt(std::max(pivot, kSmallestShare * covariance(j, j)));
    for (int i = j + 1; i < 4; ++i) {
      double value = covariance(i, j);
      for (int k = 0; k < j; ++k) value -= L(i, k) * L(j, k);
      L(i, j) = value / L(j, j);
    }
  }
  return L;
}

MixtureDensity density_of(const Gaussian4& gaussian) {
  const Eigen::Matrix4d L = cholesky(gaussian.covariance);
  MixtureDensity density;
  std::size_t at{0};
  double log_determinant{0.0};
  Eigen::Matrix4d W = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 4; ++i) {
    W(i, i) = 1.0 / L(i, i);
    for (int j = 0; j < i; ++j) {
      double value{0.0};
      for (int k = j; k < i; ++k) value -= L(i, k) * W(k, j);
      W(i, j) = value / L(i, i);
    }
    for (int j = 0; j <= i; ++j) density.W[at++] = W(i, j);
    density.mean[static_cast<std::size_t>(i)] = gaussian.mean[i];
    log_determinant += std::log(L(i, i));
  }
  const double weight = std::max(gaussian.weight, std::numeric_limits<double>::min());
  density.log_scale = std::log(weight) - 2.0 * std::log(2.0 * std::numbers::pi) - log_determinant;
  density.time_precision = 1.0 / (L.row(3).squaredNorm());
  return density;
}

/// Performs the M-step for one Gaussian, from sums around its mean.
void maximise(const MixtureMoments& moments, std::size_t samples, double floor, Gaussian4& gaussian) {
  constexpr double kMinResponsibility{1e-9};  // samples
  const double total = moments.sum(0);
  gaussian.weight = total / static_cast<double>(samples);
  if (!(total > kMinResponsibility)) {
    gaussian.weight = 0.0;
    return;
  }
  Eigen::Vector4d shift;
  for (Eigen::Index i = 0; i < 4; ++i) shift[i] = moments.sum(1 + static_cast<std::size_t>(i)) / total;
  std::size_t at{5};
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double value = moments.sum(at++) / total - shift[i] * shift[j];
      gaussian.covariance(i, j) = gaussian.covariance(j, i) = i == j ? std::max(value, 0.0) + floor : value;
    }
  }
  gaussian.mean += shift;
}

}  // namespace

Status GmmEmConfig::validate() const {
  if (!(covariance_floor > 0.0) || !(relative_stop >= 0.0) || max_iterations < 1 || !std::isfinite(covariance_floor)) {
    return Error{Errc::invalid_argument,
                 "covariance_floor and max_iterations must be positive, relative_stop not negative", "GmmEmConfig"};
  }
  return {};
}

double GmmFit::bic(std::size_t samples) const {
  const double parameters = 15.0 * static_cast<double>(gaussians.size()) - 1.0;
  return 0.5 * parameters * std::log(static_cast<double>(samples)) - log_likelihood();
}

Result<GmmEm> GmmEm::create(std::span<const Eigen::Vector4d> samples, const GmmEmConfig& config) {
  constexpr double kLargest{1e9};
  SACCADE_CHECK(config.validate());
  if (samples.empty()) return Error{Errc::invalid_argument, "a mixture needs at least one sample", {}};
  GmmEm em;
  em.config_ = config;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!samples[i].allFinite() || samples[i].cwiseAbs().maxCoeff() > kLargest) {
      return Error{Errc::invalid_argument, "a coordinate is not finite or above 1e9", "sample " + std::to_string(i)};
    }
    em.center_ += (samples[i] - em.center_) / static_cast<double>(i + 1);
  }
  em.samples_.count = samples.size();
  const std::size_t padded = (samples.size() + kMixtureBlock - 1) / kMixtureBlock * kMixtureBlock;
  for (std::size_t axis = 0; axis < 4; ++axis) {
    std::vector<double>& plane = em.samples_.planes[axis];
    plane.reserve(padded);
    const auto row = static_cast<Eigen::Index>(axis);
    for (const Eigen::Vector4d& sample : samples) plane.push_back(sample[row] - em.center_[row]);
    plane.resize(padded, plane.back());
  }
  return em;
}

std::vector<Gaussian4> GmmEm::start(std::size_t gaussians) const {
  const auto sample = [&](std::size_t i) {
    const auto& planes = samples_.planes;
    return Eigen::Vector4d{planes[0][i], planes[1][i], planes[2][i], planes[3][i]};
  };
  const std::vector<double>& times = samples_.planes[3];
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  const double begin = *first;
  const double span = *last - begin;
  const auto count = static_cast<double>(gaussians);
  const auto segment_of = [&](std::size_t i) {
    const double at = span > 0.0 ? (times[i] - begin) / span * count : 0.0;
    return std::min(static_cast<std::size_t>(at), gaussians - 1);
  };
  std::vector<Gaussian4> mixture(gaussians);
  for (std::size_t i = 0; i < samples_.count; ++i) {
    Gaussian4& gaussian = mixture[segment_of(i)];
    gaussian.weight += 1.0;
    gaussian.mean += (sample(i) - gaussian.mean) / gaussian.weight;
  }
  for (std::size_t i = 0; i < samples_.count; ++i) {
    Gaussian4& gaussian = mixture[segment_of(i)];
    const Eigen::Vector4d difference = sample(i) - gaussian.mean;
    gaussian.covariance += difference * difference.transpose() / gaussian.weight;
  }
  for (std::size_t k = 0; k < gaussians; ++k) {
    Gaussian4& gaussian = mixture[k];
    if (gaussian.weight == 0.0) {  // a gap: start from the nearest sample, as if it were the only one
      const double middle = begin + (static_cast<double>(k) + 0.5) / count * span;
      const auto end = times.begin() + static_cast<std::ptrdiff_t>(samples_.count);
      const auto nearest = std::min_element(
          times.begin(), end, [middle](double a, double b) { return std::abs(a - middle) < std::abs(b - middle); });
      gaussian.weight = 1.0;
      gaussian.mean = sample(static_cast<std::size_t>(nearest - times.begin()));
    }
    gaussian.covariance.diagonal().array() += config_.covariance_floor;
  }
  double total{0.0};
  for (const Gaussian4& gaussian : mixture) total += gaussian.weight;
  for (Gaussian4& gaussian : mixture) gaussian.weight /= total;
  return mixture;
}

GmmFit GmmEm::fit(int gaussians) const {
  SACCADE_EXPECTS(gaussians >= 1);
  const auto count = static_cast<std::size_t>(gaussians);
  GmmFit fit;
  fit.gaussians = start(count);
  std::vector<MixtureDensity> densities(count);
  std::vector<MixtureMoments> moments(count);
  for (int iteration = 0;; ++iteration) {
    std::transform(fit.gaussians.begin(), fit.gaussians.end(), densities.begin(), density_of);
    std::fill(moments.begin(), moments.end(), MixtureMoments{});
    const double log_likelihood = expect_mixture(samples_, densities, moments);
    if (!fit.log_likelihoods.empty()) {
      fit.converged = log_likelihood - fit.log_likelihood() <= config_.relative_stop * std::abs(log_likelihood);
    }
    fit.log_likelihoods.push_back(log_likelihood);
    if (fit.converged || iteration == config_.max_iterations) break;
    for (std::size_t k = 0; k < count; ++k) {
      maximise(moments[k], samples_.count, config_.covariance_floor, fit.gaussians[k]);
    }
  }
  for (Gaussian4& gaussian : fit.gaussians) gaussian.mean += center_;
  return fit;
}

}  // namespace saccade
