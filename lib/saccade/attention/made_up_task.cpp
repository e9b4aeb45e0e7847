// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/made_up_task.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/attention/seeded_random.hpp"
#include "saccade/core/result.hpp"

namespace saccade {
namespace {

/// Share of a minimum-jerk way after a share of its time.
double minimum_jerk(double s) { return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s); }

class TaskMaker {
 public:
  TaskMaker(std::uint64_t seed, const MadeUpTaskConfig& config) : config_{config}, random_{seed} {}

  MadeUpTask make() {
    const Eigen::Vector3d outside{random_.uniform(-0.3, 0.3), -0.8, random_.uniform(0.2, 0.4)};
    Eigen::Vector3d at = outside;
    for (int i = 0; i < config_.actions; ++i) {
      const Eigen::Vector3d place = new_place();
      reach(at, place);
      at = act(place);
      task_.actions_m.push_back(place);
    }
    reach(at, outside);
    add(outside);
    return std::move(task_);
  }

 private:
  Eigen::Vector3d new_place() {
    constexpr double kApart_m{0.35};
    for (;;) {
      const Eigen::Vector3d place{random_.uniform(-0.5, 0.5), random_.uniform(-0.4, 0.4), random_.uniform(0.02, 0.2)};
      const auto is_near = [&](const Eigen::Vector3d& other) { return (place - other).norm() < kApart_m; };
      if (std::none_of(task_.actions_m.begin(), task_.actions_m.end(), is_near)) return place;
    }
  }

  void add(const Eigen::Vector3d& position_m) {
    const bool repeats = !task_.trajectory.empty() && random_.uniform(0.0, 1.0) < config_.repeat_share;
    const double time_s = static_cast<double>(task_.trajectory.size()) / config_.rate_hz;
    task_.trajectory.push_back({time_s, repeats ? task_.trajectory.back().position_m : position_m, std::nullopt});
  }

  int samples_in(double time_s) const { return std::max(1, static_cast<int>(std::lround(time_s * config_.rate_hz))); }

  /// An arc over the straight line from `from` towards `to`, without the sample at `to`.
  void reach(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double length_m = (to - from).norm();
    const double speed_m_s = config_.speed_m_s * random_.uniform(2.0 / 3.0, 4.0 / 3.0);
    const Eigen::Vector3d bend{random_.uniform(-0.1, 0.1), 0.0, random_.uniform(0.1, 0.3)};
    const int samples = samples_in(length_m / speed_m_s);
    for (int i = 0; i < samples; ++i) {
      const double way = minimum_jerk(static_cast<double>(i) / samples);
      add(from + way * (to - from) + length_m * std::sin(std::numbers::pi * way) * bend);
    }
  }

  /// Sways around the place with two slow frequencies; returns where the hand is in the end.
  Eigen::Vector3d act(const Eigen::Vector3d& place) {
    const int samples = samples_in(config_.action_s * random_.uniform(0.6, 1.4));
    const Eigen::Vector3d slow{random_.uniform(-0.02, 0.02), random_.uniform(-0.02, 0.02), random_.uniform(0.01, 0.02)};
    const Eigen::Vector3d fast{random_.uniform(-0.01, 0.01), random_.uniform(-0.01, 0.01), random_.uniform(0.0, 0.01)};
    for (int i = 0; i < samples; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / samples;
      add(place + std::sin(turn) * slow + std::sin(2.0 * turn) * fast);
    }
    return place;
  }

  const MadeUpTaskConfig& config_;
  SeededRandom random_;
  MadeUpTask task_;
};

}  // namespace

MadeUpTask made_up_task(std::uint64_t seed, const MadeUpTaskConfig& config) {
  SACCADE_EXPECTS(config.actions >= 1 && config.actions <= 4);
  SACCADE_EXPECTS(config.rate_hz > 0.0 && config.speed_m_s > 0.0 && config.action_s > 0.0);
  return TaskMaker{seed, config}.make();
}

}  // namespace saccade
