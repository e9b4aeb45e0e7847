// SPDX-License-Identifier: Apache-2.0
#pragma once
// made_up_task: a hand that reaches, acts and leaves, made from a seed; for those without recordings.

#include <cstdint>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

struct MadeUpTaskConfig {
  int actions{2};             ///< places where the hand acts, one after the other
  double rate_hz{100.0};      ///< samples per second
  double speed_m_s{0.8};      ///< mean of a reach; each differs by up to a third
  double action_s{0.3};       ///< mean time at a place
  double sway_m{0.02};        ///< by how much the hand sways there, at most
  double repeat_share{0.15};  ///< samples that repeat the position before, as those of magnetic sensors do
  double noise_m{0.0};        ///< standard deviation of a position that is no repeat, on each coordinate
};

/// A trajectory and the places that the hand went to.
struct MadeUpTask {
  HandTrajectory trajectory;
  std::vector<Eigen::Vector3d> actions_m;
};

/// Enters from the side of the user, reaches to each place on bent minimum-jerk ways (Flash and Hogan 1985), sways
/// there and leaves the way it came. Places lie on a table of 1 m × 0.8 m around the origin at z = 0, 0.35 m apart at
/// least. The seed decides everything, on every platform. Expects 1 to 4 actions and positive rates. O(samples).
[[nodiscard]] MadeUpTask made_up_task(std::uint64_t seed, const MadeUpTaskConfig& config = {});

/// Where a hand is to go.
struct MadeUpWay {
  Eigen::Vector3d outside_m{Eigen::Vector3d::Zero()};  ///< where it comes from and leaves to
  std::vector<Eigen::Vector3d> places_m;               ///< where it acts, one after the other
  std::vector<Box> obstacles;                          ///< it passes over those that lie between two places
};

/// The same for given places, whose number takes the place of `config.actions`. A way is lifted as far as it takes
/// to pass over the obstacles, but by no more than 0.6 of its length; those that it begins or ends over do not count.
/// Expects a place at least, finite points and positive rates. O(samples · obstacles).
[[nodiscard]] MadeUpTask made_up_task(const MadeUpWay& way, std::uint64_t seed, const MadeUpTaskConfig& config = {});

}  // namespace saccade
