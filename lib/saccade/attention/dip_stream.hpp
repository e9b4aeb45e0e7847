// SPDX-License-Identifier: Apache-2.0
#pragma once
// DipStreamConfig and DipStream: the dip detector for samples as they come.

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "saccade/attention/hand_smoothing.hpp"
#include "saccade/attention/speed_dips.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

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
  explicit DipStream(const DipStreamConfig& config) : config_{config}, dips_{config.prominence} {}

  std::vector<HandAction> advance();
  void accept(const TimedPoint& sample);
  void store(const TimedPoint& sample);
  void fill_gap(const TimedPoint& from, const TimedPoint& to);
  /// @return whether enough came for the kernel.
  bool update_kernel();
  [[nodiscard]] SmoothedPoint motion_at(double time_s) const;
  std::vector<HandAction> judge_until(double time_s);

  DipStreamConfig config_;
  SpeedDips dips_;
  std::deque<TimedPoint> fresh_{};   ///< the last that differ, outliers included, fewer than a window
  std::deque<TimedPoint> recent_{};  ///< accepted samples, the newest last, and what fills gaps
  std::deque<double> third_differences_m_{};
  double newest_s_{0.0};              ///< of all that came
  std::array<TimedPoint, 4> last_{};  ///< accepted ones alone
  std::size_t accepted_{0};
  PositionSpread spread_{};
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
