// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/internal/hand_smoothing.hpp"

#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace saccade {

namespace {

constexpr double kMedianOfChi3{1.5381722544};  // median length of a Gaussian vector in space, unit variance per axis
constexpr double kLeastSpread_m{0.02};
constexpr double kTie{1e-7};      // keeps rounding from deciding bins or medoids
constexpr double kLargest{1e12};  // limit of times and positions, so that no sum overflows
constexpr int kBinsPerKernel{5};
constexpr int kReach_bins{16};  // radius of the truncated kernel, 3.2 standard deviations

/// Distances among the samples of a window, [a][b] for a < b.
using WindowDistances = std::array<std::array<double, kOutlierWindow>, kOutlierWindow>;

bool is_outlier(const WindowDistances& distances_m, std::size_t index, double noise_m, double limit) {
  const auto distance_m = [&](std::size_t a, std::size_t b) { return distances_m[std::min(a, b)][std::max(a, b)]; };
  std::array<double, kOutlierWindow> sums_m{};
  for (std::size_t a = 0; a < kOutlierWindow; ++a) {
    for (std::size_t b = a + 1; b < kOutlierWindow; ++b) {
      sums_m[a] += distances_m[a][b];
      sums_m[b] += distances_m[a][b];
    }
  }
  std::size_t medoid{0};
  for (std::size_t a = 1; a < kOutlierWindow; ++a) {
    if (sums_m[a] < (1.0 - kTie) * sums_m[medoid]) medoid = a;
  }
  double nearest_m{std::numeric_limits<double>::infinity()};
  for (std::size_t other = 0; other < kOutlierWindow; ++other) {
    if (other != medoid) nearest_m = std::min(nearest_m, distance_m(medoid, other));
  }
  return index != medoid &&
         distance_m(medoid, index) > limit * std::max({nearest_m, kMedianOfChi3 * noise_m, kLeastSpread_m});
}

/// Samples summed up by their nearest step, with kReach_bins empty bins on both sides. Times are in steps, from the
/// middle of the bin.
class Bins {
 public:
  Bins(std::span<const TimedPoint> samples, double step_s, std::size_t count)
      : begin_s_{samples.front().time_s}, step_s_{step_s}, origin_m_{samples.front().position_m} {
    for (auto& column : columns_) column.assign(count + 2 * kReach_bins, 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i > 0) fill_gap(samples[i - 1], samples[i]);
      add(samples[i]);
    }
  }

  [[nodiscard]] std::vector<SmoothedPoint> smoothed(double noise_m) const {
    const std::size_t count = columns_[0].size() - 2 * kReach_bins;
    Columns<kSums> sums;
    for (auto& column : sums) column.assign(count, 0.0);
    for (int offset = -kReach_bins; offset <= kReach_bins; ++offset) add_bins_at(offset, sums);
    std::vector<SmoothedPoint> motion;
    motion.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const LocalLinearSums at{sums[0][i],
                               sums[1][i],
                               sums[2][i],
                               {sums[3][i], sums[4][i], sums[5][i]},
                               {sums[6][i], sums[7][i], sums[8][i]},
                               sums[9][i],
                               sums[10][i],
                               sums[11][i]};
      SmoothedPoint point = solve(at, begin_s_ + step_s_ * static_cast<double>(i), noise_m);
      point.position_m += origin_m_;
      point.speed_mps /= step_s_;
      motion.push_back(point);
    }
    return motion;
  }

 private:
  static constexpr std::size_t kSums{12};
  template <std::size_t N>
  using Columns = std::array<std::vector<double>, N>;

  void add(const TimedPoint& sample) {
    const double at = (sample.time_s - begin_s_) / step_s_;
    const auto last = static_cast<double>(columns_[0].size() - 2 * kReach_bins - 1);
    const double bin = std::clamp(std::floor(at + 0.5 + kTie), 0.0, last);
    const std::size_t i = static_cast<std::size_t>(bin) + kReach_bins;
    const double time = at - bin;
    const Eigen::Vector3d position = sample.position_m - origin_m_;
    columns_[0][i] += 1.0;
    columns_[1][i] += time;
    columns_[2][i] += time * time;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      columns_[3 + static_cast<std::size_t>(axis)][i] += position[axis];
      columns_[6 + static_cast<std::size_t>(axis)][i] += time * position[axis];
    }
  }
  void fill_gap(const TimedPoint& from, const TimedPoint& to) {
    const double gap = (to.time_s - from.time_s) / step_s_;
    if (gap <= kBinsPerKernel + kTie) return;
    for (double step = 1.0; step < gap - kTie; step += 1.0) {
      const double share = step / gap;
      add({from.time_s + step * step_s_, (1.0 - share) * from.position_m + share * to.position_m});
    }
  }
  void add_bins_at(int offset, Columns<kSums>& sums) const {
    const double o = offset;
    const double w = std::exp(-0.5 * o * o / (kBinsPerKernel * kBinsPerKernel));
    const std::size_t count = sums[0].size();
    const auto shift = static_cast<std::size_t>(offset + kReach_bins);
    const double* const n = columns_[0].data() + shift;
    const double* const t = columns_[1].data() + shift;
    const double* const tt = columns_[2].data() + shift;
    for (std::size_t i = 0; i < count; ++i) {
      const double time = o * n[i] + t[i];
      const double time_squared = o * o * n[i] + 2.0 * o * t[i] + tt[i];
      sums[0][i] += w * n[i];
      sums[1][i] += w * time;
      sums[2][i] += w * time_squared;
      sums[9][i] += w * w * n[i];
      sums[10][i] += w * w * time;
      sums[11][i] += w * w * time_squared;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* const p = columns_[3 + axis].data() + shift;
      const double* const tp = columns_[6 + axis].data() + shift;
      for (std::size_t i = 0; i < count; ++i) {
        sums[3 + axis][i] += w * p[i];
        sums[6 + axis][i] += w * (o * p[i] + tp[i]);
      }
    }
  }

  double begin_s_;
  double step_s_;
  Eigen::Vector3d origin_m_;
  Columns<9> columns_;
};

}  // namespace

Status check_order(const HandSample& sample) {
  const auto usable = [](double value) { return std::abs(value) <= kLargest; };
  if (!usable(sample.time_s)) {
    return Error{Errc::invalid_argument,
                 "a time of the hand is not finite, or beyond 1e12 s; times are seconds: divide nanoseconds by 1e9",
                 ""};
  }
  for (const double coordinate : sample.position_m) {
    if (usable(coordinate)) continue;
    return Error{Errc::invalid_argument,
                 "a position of the hand is not finite, or beyond 1e12 m; leave such samples out", ""};
  }
  return {};
}

Status check_order(std::span<const HandSample> trajectory) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    Status status = check_order(trajectory[i]);
    if (status && i > 0 && trajectory[i].time_s < trajectory[i - 1].time_s) {
      status = Error{Errc::invalid_argument, "a time of the hand lies before the one before", ""};
    }
    if (!status) return Error{status.error().code, status.error().message, "sample " + std::to_string(i)};
  }
  return {};
}

std::vector<TimedPoint> fresh_samples(std::span<const HandSample> trajectory) {
  std::vector<TimedPoint> fresh;
  fresh.reserve(trajectory.size());
  std::size_t of_last_time{0};
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const HandSample& sample = trajectory[i];
    if (i > 0 && sample.position_m == trajectory[i - 1].position_m) continue;
    if (!fresh.empty() && fresh.back().time_s == sample.time_s) {
      ++of_last_time;
      fresh.back().position_m += (sample.position_m - fresh.back().position_m) / static_cast<double>(of_last_time);
    } else {
      fresh.push_back({sample.time_s, sample.position_m});
      of_last_time = 1;
    }
  }
  return fresh;
}

double third_difference_m(std::span<const TimedPoint, 4> samples) {
  const double scale = samples[3].time_s - samples[0].time_s;
  std::array<double, 4> t{};
  for (std::size_t j = 0; j < 4; ++j) t[j] = (samples[j].time_s - samples[0].time_s) / scale;
  // Weights of the divided third difference, multiplied by a common factor that avoids quotients.
  const std::array<double, 4> weights{-(t[2] - t[1]) * (t[3] - t[1]) * (t[3] - t[2]), t[2] * t[3] * (t[3] - t[2]),
                                      -t[1] * t[3] * (t[3] - t[1]), t[1] * t[2] * (t[2] - t[1])};
  double norm_squared{0.0};
  for (const double weight : weights) norm_squared += weight * weight;
  // The weights add up to zero.
  const Eigen::Vector3d& origin = samples[0].position_m;
  Eigen::Vector3d sum{Eigen::Vector3d::Zero()};
  for (std::size_t j = 1; j < 4; ++j) sum += weights[j] * (samples[j].position_m - origin);
  return sum.norm() / std::sqrt(norm_squared);
}

double noise_deviation_m(std::span<const TimedPoint> samples) {
  if (samples.size() < 4) return 0.0;
  std::vector<double> lengths_m(samples.size() - 3);
  for (std::size_t i = 0; i < lengths_m.size(); ++i) {
    lengths_m[i] = third_difference_m(samples.subspan(i).first<4>());
  }
  return noise_of_third_differences_m(std::move(lengths_m));
}

double noise_of_third_differences_m(std::vector<double> lengths_m) {
  return lengths_m.empty() ? 0.0 : upper_median(lengths_m) / kMedianOfChi3;
}

void PositionSpread::add(const Eigen::Vector3d& position_m, double noise_m) {
  count_ += 1.0;
  const Eigen::Vector3d step_m = position_m - mean_m_;
  mean_m_ += step_m / count_;
  squares_m2_ += step_m.dot(position_m - mean_m_);
  noise_squares_m2_ += 3.0 * noise_m * noise_m;
}

bool is_outlier(std::span<const TimedPoint, kOutlierWindow> window, std::size_t index, double noise_m, double limit) {
  WindowDistances distances_m{};
  for (std::size_t a = 0; a < kOutlierWindow; ++a) {
    for (std::size_t b = a + 1; b < kOutlierWindow; ++b) {
      distances_m[a][b] = (window[b].position_m - window[a].position_m).norm();
    }
  }
  return is_outlier(distances_m, index, noise_m, limit);
}

std::vector<TimedPoint> without_outliers(std::span<const TimedPoint> samples, double noise_m, double limit) {
  constexpr std::size_t kSide{kOutlierWindow / 2};
  const std::size_t n = samples.size();
  if (n < kOutlierWindow) return {samples.begin(), samples.end()};
  std::vector<std::array<double, kOutlierWindow>> ahead_m(n);  // distances to the samples that follow
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 1; k < kOutlierWindow && i + k < n; ++k) {
      ahead_m[i][k] = (samples[i + k].position_m - samples[i].position_m).norm();
    }
  }
  std::vector<TimedPoint> kept;
  kept.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t first = std::min(i < kSide ? 0 : i - kSide, n - kOutlierWindow);
    WindowDistances distances_m{};
    for (std::size_t a = 0; a < kOutlierWindow; ++a) {
      for (std::size_t b = a + 1; b < kOutlierWindow; ++b) distances_m[a][b] = ahead_m[first + a][b - a];
    }
    if (!is_outlier(distances_m, i - first, noise_m, limit)) kept.push_back(samples[i]);
  }
  return kept;
}

SmoothedPoint solve(const LocalLinearSums& sums, double time_s, double noise_m) {
  const double determinant = sums.weight * sums.time_squared - sums.time * sums.time;
  SmoothedPoint point{time_s, Eigen::Vector3d::Zero(), 0.0};
  if (!(sums.weight > 0.0)) return point;
  if (!(determinant > 1e-12 * sums.weight * sums.time_squared)) {
    point.position_m = sums.position / sums.weight;
    return point;
  }
  point.position_m = (sums.time_squared * sums.position - sums.time * sums.time_position) / determinant;
  const Eigen::Vector3d velocity = (sums.weight * sums.time_position - sums.time * sums.position) / determinant;
  const double variance =
      (sums.weight * sums.weight * sums.squared_time_squared - 2.0 * sums.weight * sums.time * sums.squared_time +
       sums.time * sums.time * sums.weight_squared) /
      (determinant * determinant);
  point.speed_mps = std::sqrt(std::max(0.0, velocity.squaredNorm() - 3.0 * noise_m * noise_m * variance));
  return point;
}

std::vector<SmoothedPoint> smooth(std::span<const TimedPoint> samples, double kernel_s, double noise_m) {
  const double duration_s = samples.back().time_s - samples.front().time_s;
  const auto most = static_cast<double>(8 * samples.size() + 4096);
  const double steps = std::clamp(std::ceil(duration_s * kBinsPerKernel / kernel_s - kTie), 1.0, most);
  return Bins{samples, duration_s / steps, static_cast<std::size_t>(steps) + 1}.smoothed(noise_m);
}

double interval_s(std::span<const TimedPoint> samples) {
  std::vector<double> intervals_s(samples.size() - 1);
  for (std::size_t i = 0; i < intervals_s.size(); ++i) intervals_s[i] = samples[i + 1].time_s - samples[i].time_s;
  const double longest_s = 8.5 * upper_median(intervals_s);
  double sum_s{0.0};
  double count{0.0};
  for (const double interval_s : intervals_s) {
    if (interval_s > longest_s) continue;
    sum_s += interval_s;
    count += 1.0;
  }
  return sum_s / count;
}

double path_speed_mps(std::span<const SmoothedPoint> motion) {
  double path{0.0};
  double weighted{0.0};
  for (const SmoothedPoint& point : motion) {
    path += point.speed_mps;
    weighted += point.speed_mps * point.speed_mps;
  }
  return path > 0.0 ? weighted / path : 0.0;
}

double position_noise_m(double noise_m, double interval_s, double kernel_s) {
  return noise_m * std::sqrt(interval_s / (2.0 * std::sqrt(std::numbers::pi) * kernel_s));
}

double velocity_noise_mps(double noise_m, double interval_s, double kernel_s) {
  return noise_m * std::sqrt(interval_s / (4.0 * std::sqrt(std::numbers::pi) * kernel_s * kernel_s * kernel_s));
}

double kernel_width_s(const KernelConfig& config, double speed_mps, double noise_m, double interval_s) {
  const double still_s = config.length_m / speed_mps;
  const double noise_to_speed_s = noise_m / (config.speed_noise_share * speed_mps);
  const double noisy_s =
      std::cbrt(noise_to_speed_s * noise_to_speed_s * interval_s / (4.0 * std::sqrt(std::numbers::pi)));
  return std::hypot(still_s, noisy_s);
}

}  // namespace saccade
