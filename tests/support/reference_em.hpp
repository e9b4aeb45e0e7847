// SPDX-License-Identifier: Apache-2.0
#pragma once
// The plain EM that saccade::GmmEm is held to: one step, straight from the formulas, with Eigen's own decompositions.

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "saccade/attention/internal/gmm_em.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade::test {

inline double log_normal(const Eigen::Vector4d& x, const Gaussian4& gaussian) {
  const Eigen::Vector4d d = x - gaussian.mean;
  const double squared = d.dot(gaussian.covariance.inverse() * d);
  return -0.5 * squared - 0.5 * std::log(gaussian.covariance.determinant()) - 2.0 * std::log(2.0 * std::numbers::pi);
}

/// log π_k N(x_i) of every sample (row) and Gaussian (column).
inline Eigen::MatrixXd log_joint(std::span<const Eigen::Vector4d> samples, std::span<const Gaussian4> mixture) {
  Eigen::MatrixXd joint{static_cast<Eigen::Index>(samples.size()), static_cast<Eigen::Index>(mixture.size())};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t k = 0; k < mixture.size(); ++k) {
      joint(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          std::log(mixture[k].weight) + log_normal(samples[i], mixture[k]);
    }
  }
  return joint;
}

inline double log_likelihood(std::span<const Eigen::Vector4d> samples, std::span<const Gaussian4> mixture) {
  const Eigen::MatrixXd joint = log_joint(samples, mixture);
  double sum{0.0};
  for (Eigen::Index i = 0; i < joint.rows(); ++i) {
    const double largest = joint.row(i).maxCoeff();
    sum += largest + std::log((joint.row(i).array() - largest).exp().sum());
  }
  return sum;
}

/// One E-step and M-step.
inline std::vector<Gaussian4> em_step(std::span<const Eigen::Vector4d> samples, std::span<const Gaussian4> mixture,
                                      double floor) {
  const Eigen::MatrixXd joint = log_joint(samples, mixture);
  Eigen::MatrixXd r = (joint.colwise() - joint.rowwise().maxCoeff()).array().exp();
  r.array().colwise() /= r.rowwise().sum().array().eval();
  std::vector<Gaussian4> next(mixture.size());
  for (std::size_t k = 0; k < mixture.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const double total = r.col(column).sum();
    next[k].weight = total / static_cast<double>(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      next[k].mean += r(static_cast<Eigen::Index>(i), column) / total * samples[i];
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector4d d = samples[i] - next[k].mean;
      next[k].covariance += r(static_cast<Eigen::Index>(i), column) / total * d * d.transpose();
    }
    next[k].covariance.diagonal().array() += floor;
  }
  return next;
}

/// A task of a hand as samples in four dimensions, time in sampling intervals.
inline std::vector<Eigen::Vector4d> augmented_samples(const HandTrajectory& trajectory) {
  std::vector<Eigen::Vector4d> samples;
  for (const HandSample& sample : trajectory) {
    const Eigen::Vector3d& p = sample.position_m;
    samples.emplace_back(p.x(), p.y(), p.z(), static_cast<double>(samples.size()));
  }
  return samples;
}

}  // namespace saccade::test
