// SPDX-License-Identifier: Apache-2.0
#pragma once
// detect_dips: finds actions where the hand was slow between two motions. DipStream: finds them as samples arrive.

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

/// Motion at one time.
struct SmoothedPoint {
  double time_s{0.0};
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
  double speed_mps{0.0};  ///< reduced by the share that noise is expected to contribute
};

/// Amount of smoothing.
struct KernelConfig {
  double length_m{0.1};            ///< the kernel's standard deviation on the path, at the mean speed, without noise
  double speed_noise_share{0.06};  ///< noise allowed on the smoothed velocity (each axis), relative to the mean speed
};

/// Moment at which the hand was slow, between faster ones.
struct Dip {
  TimedPoint at;
  double speed_mps{0.0};   ///< never below the floor
  double before_mps{0.0};  ///< largest speed since the previous dip
  double after_mps{0.0};   ///< largest speed until the next dip, as far as known

  /// Returns the smaller of the two ratios to the speed, in logarithms.
  [[nodiscard]] double prominence() const;
};

/// Required rise of log speed around a dip.
struct ProminenceConfig {
  double drop{0.9};  ///< from the largest speed before
  double rise{0.9};  ///< to the largest speed after
};

/// Parameters of detect_dips; tuned on user 1 of the recorded hands (docs/design/dip-detector.md).
struct DipConfig {
  KernelConfig kernel{};
  double max_kernel_share{0.1};  ///< limit relative to the trajectory's duration
  ProminenceConfig prominence{};
  double speed_floor_share{0.03};  ///< share of the mean speed below which the hand is at rest
  double outlier_limit{2.7};       ///< limit for is_outlier

  /// @return invalid_argument for a number that is not finite or not positive, or a max_kernel_share above 1.
  [[nodiscard]] Status validate() const;
};

/// Detected actions, and data for pictures.
struct DipResult {
  std::vector<HandAction> actions;    ///< by time; saliency: the dip's prominence
  std::vector<Dip> dips;              ///< one per action
  std::vector<SmoothedPoint> motion;  ///< smoothed motion searched for dips; empty where there was none
  double noise_m{0.0};                ///< estimated standard deviation on each coordinate
  double kernel_s{0.0};               ///< standard deviation of the kernel; 0 where nothing was smoothed
  double mean_speed_mps{0.0};         ///< along the path
  std::size_t repeated_samples{0};
  std::size_t outliers{0};
  std::string why;  ///< one line for people
};

/// Returns the action of a dip.
[[nodiscard]] HandAction action_of(const Dip& dip);

/// Finds the places where the hand changed something, equally well at any speed and under strong noise
/// (docs/design/dip-detector.md). Actions are dips of the smoothed speed, with a kernel whose width follows noise and
/// mean speed. Thesis §2.2.4 uses GMM-AS for this.
/// @param trajectory  world frame, metres, seconds that never decrease; any number of samples.
/// @return invalid_argument for a bad config, or naming a sample that is not finite or runs back in time.
/// O(n), one thread, deterministic.
[[nodiscard]] Result<DipResult> detect_dips(const HandTrajectory& trajectory, const DipConfig& config = {});

/// Parameters of DipStream; tuned on user 1 of the recorded hands (docs/design/dip-detector.md). The kernel is narrower
/// than that of DipConfig and the rise smaller, so that an action is reported soon.
struct DipStreamConfig {
  KernelConfig kernel{0.06, 0.06};
  double delay{1.5};  ///< delay behind the newest sample at which the speed is judged, in kernel widths
  ProminenceConfig prominence{0.9, 0.6};
  double speed_floor_share{0.03};  ///< share of the mean speed so far below which the hand is at rest
  double outlier_limit{2.7};       ///< limit for is_outlier

  /// @return invalid_argument for a number that is not finite or not positive.
  [[nodiscard]] Status validate() const;
};

/// Stream detector: reports an action while the hand is still in the workspace, as soon as the hand moves away from it.
/// Reports are never taken back. Mean speed and noise are those of the samples so far. The kernel covers 256 samples at
/// most; where noise demands more, it stays narrower. One writer; deterministic.
class DipStream {
 public:
  /// @return invalid_argument for a bad config.
  [[nodiscard]] static Result<DipStream> create(const DipStreamConfig& config = {});

  /// Returns the actions that became certain with this sample: usually none. Saliency and why hold what was known then.
  /// A sample equal to the previous one, or of its time, adds nothing. Across a gap wider than the kernel the hand
  /// moves on a straight line.
  /// @return invalid_argument for a sample that is not finite or earlier than the previous one; it is ignored.
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
  /// @return whether there are enough samples for the kernel.
  bool update_kernel();
  [[nodiscard]] SmoothedPoint motion_at(double time_s) const;
  std::vector<HandAction> judge_until(double time_s);

  DipStreamConfig config_;
  Hidden<SpeedDips> dips_;
  std::deque<TimedPoint> fresh_{};   ///< last distinct samples, outliers included, fewer than a window
  std::deque<TimedPoint> recent_{};  ///< accepted samples, newest last, and samples that fill gaps
  std::deque<double> third_differences_m_{};
  double newest_s_{0.0};              ///< newest time of all samples
  std::array<TimedPoint, 4> last_{};  ///< last accepted ones
  std::size_t accepted_{0};
  Hidden<PositionSpread> spread_;
  double interval_s_{0.0};  ///< mean without gaps
  bool begun_{false};
  bool judging_{false};  ///< set once there are enough samples for the kernel
  std::size_t outliers_{0};
  double noise_m_{0.0};
  double kernel_s_{0.0};
  std::optional<double> judged_s_{};  ///< time up to which the speed was judged
  double path_m_{0.0};
  double weighted_path_{0.0};  ///< ∫ v² dt, m²/s
};

}  // namespace saccade
