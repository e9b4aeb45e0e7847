// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/dip_detector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saccade/attention/internal/hand_smoothing.hpp"
#include "saccade/attention/internal/speed_dips.hpp"

namespace saccade {

namespace {

constexpr std::size_t kMostSamples{256};
constexpr std::size_t kMostDifferences{64};
constexpr double kIntervalMemory{64.0};  // samples
constexpr std::size_t kJudged{4};        // index in the window of the sample tested as an outlier
constexpr double kReach{3.2};            // kernel widths to where the kernel is cut off
constexpr double kPast{2.5};             // kernel widths that must lie behind the first speed judged
constexpr double kSignificant{3.0};      // multiple of the velocity noise above which a speed enters the mean
constexpr double kStepsPerKernel{4.0};   // in gaps
constexpr int kStepsAtEnd{32};           // steps at each end of a gap

/// Returns times after `from_s`, up to `to_s`, a quarter of a kernel width apart. Of a long gap it returns only those
/// near its ends, since nothing is known about the rest.
std::vector<double> times_within(double from_s, double to_s, double kernel_s) {
  const double steps = std::max(1.0, std::ceil(kStepsPerKernel * (to_s - from_s) / kernel_s));
  const double step_s = steps > 2 * kStepsAtEnd ? kernel_s / kStepsPerKernel : (to_s - from_s) / steps;
  const int count = static_cast<int>(std::min(steps, 2.0 * kStepsAtEnd));
  std::vector<double> times_s;
  for (int step = 1; step <= count / 2; ++step) times_s.push_back(from_s + step_s * step);
  for (int left = count - count / 2 - 1; left >= 0; --left) times_s.push_back(to_s - step_s * left);
  return times_s;
}

}  // namespace

Status DipStreamConfig::validate() const {
  for (const double value : {kernel.length_m, kernel.speed_noise_share, delay, prominence.drop, prominence.rise,
                             speed_floor_share, outlier_limit}) {
    if (!std::isfinite(value) || !(value > 0.0)) {
      return Error{Errc::invalid_argument, "parameters of the dip detector are positive numbers", ""};
    }
  }
  return {};
}

DipStream::DipStream(const DipStreamConfig& config)
    : config_{config}, dips_{SpeedDips{config.prominence}}, spread_{PositionSpread{}} {}

Result<DipStream> DipStream::create(const DipStreamConfig& config) {
  SACCADE_CHECK(config.validate());
  return DipStream{config};
}

void DipStream::accept(const TimedPoint& sample) {
  const double interval_s = accepted_ > 0 ? sample.time_s - last_.back().time_s : 0.0;
  const bool gap = judging_ && interval_s > kernel_s_;
  if (gap) fill_gap(last_.back(), sample);
  if (accepted_ > 0 && !gap) {
    interval_s_ += (interval_s - interval_s_) / std::min(static_cast<double>(accepted_), kIntervalMemory);
  }
  store(sample);
  std::rotate(last_.begin(), last_.begin() + 1, last_.end());
  last_.back() = sample;
  if (++accepted_ < last_.size()) return;
  third_differences_m_.push_back(third_difference_m(last_));
  if (third_differences_m_.size() > kMostDifferences) third_differences_m_.pop_front();
  noise_m_ = noise_of_third_differences_m({third_differences_m_.begin(), third_differences_m_.end()});
}

void DipStream::store(const TimedPoint& sample) {
  recent_.push_back(sample);
  if (recent_.size() > kMostSamples) recent_.pop_front();
}

void DipStream::fill_gap(const TimedPoint& from, const TimedPoint& to) {
  for (const double time_s : times_within(from.time_s, to.time_s, kernel_s_)) {
    const double share = (time_s - from.time_s) / (to.time_s - from.time_s);
    if (share < 1.0) store({time_s, (1.0 - share) * from.position_m + share * to.position_m});
  }
}

bool DipStream::update_kernel() {
  const double stored_s = recent_.back().time_s - recent_.front().time_s;
  const double widest_s = stored_s / (kPast + config_.delay);
  const double speed_mps = mean_speed_mps();
  kernel_s_ = widest_s;
  if (!(speed_mps > 0.0)) return false;
  const double wanted_s = std::max(kernel_width_s(config_.kernel, speed_mps, noise_m_, interval_s_), interval_s_);
  kernel_s_ = std::min(wanted_s, widest_s);
  return wanted_s <= widest_s || recent_.size() == kMostSamples;
}

SmoothedPoint DipStream::motion_at(double time_s) const {
  LocalLinearSums sums;
  const Eigen::Vector3d& origin_m = recent_.back().position_m;
  for (auto sample = recent_.rbegin(); sample != recent_.rend(); ++sample) {
    const double t = sample->time_s - time_s;
    if (t > kReach * kernel_s_) continue;
    if (t < -kReach * kernel_s_) break;
    const double w = std::exp(-0.5 * t * t / (kernel_s_ * kernel_s_));
    const Eigen::Vector3d position = sample->position_m - origin_m;
    sums.weight += w;
    sums.time += w * t;
    sums.time_squared += w * t * t;
    sums.position += w * position;
    sums.time_position += w * t * position;
    sums.weight_squared += w * w;
    sums.squared_time += w * w * t;
    sums.squared_time_squared += w * w * t * t;
  }
  SmoothedPoint point = solve(sums, time_s, noise_m_);
  point.position_m += origin_m;
  return point;
}

std::vector<HandAction> DipStream::judge_until(double time_s) {
  const double noise_mps = velocity_noise_mps(noise_m_, interval_s_, kernel_s_);
  std::vector<HandAction> actions;
  for (const double at_s : times_within(judged_s_.value_or(time_s), time_s, kernel_s_)) {
    const SmoothedPoint now = motion_at(at_s);
    if (now.speed_mps > kSignificant * noise_mps) {
      const double way_m = now.speed_mps * (at_s - judged_s_.value_or(at_s));
      path_m_ += way_m;
      weighted_path_ += now.speed_mps * way_m;
    }
    judged_s_ = at_s;
    spread_->add(now.position_m, position_noise_m(noise_m_, interval_s_, kernel_s_));
    if (!judging_) continue;
    const auto dip = dips_->put(now, config_.speed_floor_share * mean_speed_mps());
    if (dip && spread_->exceeds_noise()) actions.push_back(action_of(*dip));
  }
  return actions;
}

Result<std::vector<HandAction>> DipStream::put(const HandSample& sample) {
  SACCADE_CHECK(check_order(sample));
  const TimedPoint point{sample.time_s, sample.position_m};
  if (!fresh_.empty() && point.time_s < newest_s_) {
    return Error{Errc::invalid_argument, "a time of the hand lies before the one before", ""};
  }
  const bool new_time = fresh_.empty() || point.time_s > newest_s_;
  newest_s_ = point.time_s;
  if (!new_time || (!fresh_.empty() && point.position_m == fresh_.back().position_m)) return std::vector<HandAction>{};
  fresh_.push_back(point);
  if (fresh_.size() < kOutlierWindow) return std::vector<HandAction>{};
  return advance();
}

std::vector<HandAction> DipStream::advance() {
  std::array<TimedPoint, kOutlierWindow> window{};
  std::copy(fresh_.begin(), fresh_.end(), window.begin());
  fresh_.pop_front();
  // In the first window, all samples up to the tested one are new.
  for (std::size_t i = std::exchange(begun_, true) ? kJudged : 0; i <= kJudged; ++i) {
    if (is_outlier(window, i, noise_m_, config_.outlier_limit)) {
      ++outliers_;
    } else {
      accept(window[i]);
    }
  }
  if (accepted_ < last_.size() || last_.back().time_s != window[kJudged].time_s) return {};
  judging_ = update_kernel() || judging_;
  const double time_s = last_.back().time_s - config_.delay * kernel_s_;
  if (judged_s_ && time_s <= *judged_s_) return {};  // the kernel has widened
  return judge_until(time_s);
}

}  // namespace saccade
