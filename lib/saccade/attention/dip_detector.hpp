// SPDX-License-Identifier: Apache-2.0
#pragma once
// detect_dips: the hand did something where it was slow between two motions; DipStream: the same for samples as they
// come.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/hidden.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

class PositionSpread;
class SpeedDips;

/// A position at a time.
struct TimedPoint {
  double time_s{0.0};
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
};

/// The motion at one time.
struct SmoothedPoint {
  double time_s{0.0};
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
  double speed_mps{0.0};  ///< without the share that noise is expected to have in it
};

/// How much to smooth.
struct KernelConfig {
  double length_m{0.1};            ///< the kernel's standard deviation on the path, at the mean speed, without noise
  double speed_noise_share{0.06};  ///< what noise may leave on the smoothed velocity (each axis), of the mean speed
};

/// A moment at which the hand was slow, between faster ones.
struct Dip {
  TimedPoint at;
  double speed_mps{0.0};   ///< never below the floor
  double before_mps{0.0};  ///< the largest speed since the dip before
  double after_mps{0.0};   ///< the largest speed until the dip after, as far as it is known

  /// The smaller of the two ratios to the speed, in logarithms.
  [[nodiscard]] double prominence() const;
};

/// How much faster the hand is around a dip, in log speed.
struct ProminenceConfig {
  double drop{0.9};  ///< from the largest speed before
  double rise{0.9};  ///< to the largest speed after
};

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

/// Parameters of DipStream; tuned on user 1 of the recorded hands (docs/dip-detector.md). The kernel is narrower than
/// that of DipConfig and the rise smaller, so that an action is reported soon.
struct DipStreamConfig {
  KernelConfig kernel{0.06, 0.06};
  double delay{1.5};  ///< how far behind the newest sample the speed is judged, in kernel widths
  ProminenceConfig prominence{0.9, 0.6};
  double speed_floor_share{0.03};  ///< of the mean speed so far: slower is at rest
  double outlier_limit{2.7};       ///< of is_outlier

  /// @return invalid_argument for a number that is not finite or not positive.
  [[nodiscard]] Status validate() const;
};

/// Reports an action while the hand is still in the workspace, as soon as the hand moves away from it. What was
/// reported is never taken back. Mean speed and noise are those of what has come so far. The kernel reaches over 256
/// samples at most: where noise asks for more, it stays narrower. One writer; deterministic.
class DipStream {
 public:
  /// @return invalid_argument for a bad config.
  [[nodiscard]] static Result<DipStream> create(const DipStreamConfig& config = {});

  /// The actions that are certain with this sample: none as a rule, rarely one. Saliency and why hold what was known
  /// then. A sample equal to the one before, or of its time, says nothing new. Across a gap wider than the kernel the
  /// hand moves on a straight line.
  /// @return invalid_argument for a sample that is not finite or lies before the one before; it is left out.
  /// O(1): no more than 256 samples are stored, and the fit reads each of them once (64 times after a gap).
  [[nodiscard]] Result<std::vector<HandAction>> put(const HandSample& sample);

  [[nodiscard]] double noise_m() const { return noise_m_; }
  [[nodiscard]] double kernel_s() const { return kernel_s_; }
  [[nodiscard]] double mean_speed_mps() const { return path_m_ > 0.0 ? weighted_path_ / path_m_ : 0.0; }
  [[nodiscard]] std::size_t outliers() const { return outliers_; }

 private:
  explicit DipStream(const DipStreamConfig& config);

  std::vector<HandAction> advance();
  void accept(const TimedPoint& sample);
  void store(const TimedPoint& sample);
  void fill_gap(const TimedPoint& from, const TimedPoint& to);
  /// @return whether enough came for the kernel.
  bool update_kernel();
  [[nodiscard]] SmoothedPoint motion_at(double time_s) const;
  std::vector<HandAction> judge_until(double time_s);

  DipStreamConfig config_;
  Hidden<SpeedDips> dips_;
  std::deque<TimedPoint> fresh_{};   ///< the last that differ, outliers included, fewer than a window
  std::deque<TimedPoint> recent_{};  ///< accepted samples, the newest last, and what fills gaps
  std::deque<double> third_differences_m_{};
  double newest_s_{0.0};              ///< of all that came
  std::array<TimedPoint, 4> last_{};  ///< accepted ones alone
  std::size_t accepted_{0};
  Hidden<PositionSpread> spread_;
  double interval_s_{0.0};  ///< mean, gaps left out
  bool begun_{false};
  bool judging_{false};  ///< once enough came for the kernel
  std::size_t outliers_{0};
  double noise_m_{0.0};
  double kernel_s_{0.0};
  std::optional<double> judged_s_{};  ///< the time up to which the speed was judged
  double path_m_{0.0};
  double weighted_path_{0.0};  ///< ∫ v² dt, m²/s
};

}  // namespace saccade
