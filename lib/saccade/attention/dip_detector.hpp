// SPDX-License-Identifier: Apache-2.0
#pragma once
// DipConfig, DipResult and detect_dips: the hand did something where it was slow between two motions.

#include <cstddef>
#include <string>
#include <vector>

#include "saccade/attention/hand_smoothing.hpp"
#include "saccade/attention/speed_dips.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// Parameters of detect_dips; tuned on user 1 of the recorded hands (docs/dip-detector.md).
struct DipConfig {
  KernelConfig kernel{};
  double max_kernel_share{0.1};  ///< of the trajectory's duration
  ProminenceConfig prominence{};
  double speed_floor_share{0.03};  ///< of the mean speed: slower is at rest
  double outlier_limit{2.7};       ///< of is_outlier

  /// @return invalid_argument for a number that is not finite or not positive, or a max_kernel_share above 1.
  [[nodiscard]] Status validate() const;
};

/// What was found, and what pictures need.
struct DipResult {
  std::vector<HandAction> actions;    ///< in time; saliency: the dip's prominence
  std::vector<Dip> dips;              ///< one per action
  std::vector<SmoothedPoint> motion;  ///< as the dips were looked for in it; empty where there was none
  double noise_m{0.0};                ///< estimated standard deviation on each coordinate
  double kernel_s{0.0};               ///< standard deviation of the kernel; 0 where nothing was smoothed
  double mean_speed_mps{0.0};         ///< along the path
  std::size_t repeated_samples{0};
  std::size_t outliers{0};
  std::string why;  ///< one line for people
};

/// The action that a dip stands for.
[[nodiscard]] HandAction action_of(const Dip& dip);

/// Finds the places where the hand changed something, as good as ever at any speed and under much noise
/// (docs/dip-detector.md): actions are dips of the smoothed speed, with a kernel whose width follows noise and mean
/// speed. Thesis §2.2.4 has GMM-AS for this.
/// @param trajectory  world frame, metres, seconds that never decrease; any number of samples.
/// @return invalid_argument for a bad config, or naming a sample that is not finite or runs back in time.
/// O(n), one thread, deterministic.
[[nodiscard]] Result<DipResult> detect_dips(const HandTrajectory& trajectory, const DipConfig& config = {});

}  // namespace saccade
