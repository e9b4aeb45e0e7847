// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/mode_choice.hpp"

#include <cmath>

#include "saccade/core/result.hpp"

namespace saccade {
namespace {

constexpr int kMostShifts{20};
constexpr double kStill{1e-5};  ///< a shift that changes nothing in 8 bits

/// Mean of the modes' colours under a Gaussian at a point, and the weight there.
struct Density {
  Density(std::span<const SurfelMode> modes, const Eigen::Vector3d& at, double bandwidth) {
    for (const SurfelMode& mode : modes) {
      const Eigen::Vector3d color = mode.color.cast<double>();
      const double weight =
          static_cast<double>(mode.weight) * std::exp(-(color - at).squaredNorm() / (2.0 * bandwidth * bandwidth));
      mean += weight * color;
      sum += weight;
    }
    if (sum > 0.0) mean /= sum;
  }

  Eigen::Vector3d mean{Eigen::Vector3d::Zero()};
  double sum{0.0};
};

/// Finds the densest point. Modes whose colour, in [0, 1], satisfies `favoured` are preferred as start among equally
/// dense ones.
template <class Favoured>
SurfelMode densest_of(std::span<const SurfelMode> modes, double bandwidth, const Favoured& favoured) {
  SACCADE_EXPECTS(bandwidth > 0.0);
  if (modes.size() < 2) return heaviest_mode(modes);
  double most{0.0};
  double weight{0.0};
  Eigen::Vector3d color{Eigen::Vector3d::Zero()};
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
  for (const SurfelMode& mode : modes) {
    const double density = Density{modes, mode.color.cast<double>(), bandwidth}.sum * favoured(mode.color);
    if (density > most) {
      most = density;
      color = mode.color.cast<double>();
    }
    position_m += static_cast<double>(mode.weight) * mode.position_m.cast<double>();
    weight += static_cast<double>(mode.weight);
  }
  for (int shift = 0; shift < kMostShifts; ++shift) {
    const Density density{modes, color, bandwidth};
    const double step = (density.mean - color).norm();
    color = density.mean;
    most = density.sum;
    if (step < kStill) break;
  }
  SurfelMode densest;
  densest.color = color.cast<float>();
  densest.position_m = (position_m / weight).cast<float>();
  densest.weight = static_cast<float>(most);
  return densest;
}

}  // namespace

SurfelMode heaviest_mode(std::span<const SurfelMode> modes) {
  SurfelMode best;
  for (const SurfelMode& mode : modes) {
    if (mode.weight > best.weight) best = mode;
  }
  return best;
}

SurfelMode densest_mode(std::span<const SurfelMode> modes, double bandwidth) {
  return densest_of(modes, bandwidth, [](const Eigen::Vector3f&) { return 1.0; });
}

SurfelMode densest_mode_like(std::span<const SurfelMode> modes, double bandwidth, const Eigen::Vector3f& color,
                             double color_sigma) {
  return densest_of(modes, bandwidth, [&](const Eigen::Vector3f& other) {
    return std::exp(-static_cast<double>((other - color).squaredNorm()) / (2.0 * color_sigma * color_sigma));
  });
}

}  // namespace saccade
