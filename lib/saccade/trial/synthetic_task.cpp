// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/simulated_task.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "saccade/core/result.hpp"
#include "saccade/core/seeded_random.hpp"

namespace saccade {
namespace {

/// Returns the share of a minimum-jerk path after a share of its time.
double minimum_jerk(double s) { return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s); }

bool over(const Box& box, const Eigen::Vector3d& p) {
  return p.x() >= box.min.x() && p.x() <= box.max.x() && p.y() >= box.min.y() && p.y() <= box.max.y();
}

class TaskMaker {
 public:
  TaskMaker(std::uint64_t seed, const SyntheticTaskConfig& config, std::span<const Box> obstacles = {})
      : config_{config}, obstacles_{obstacles}, random_{seed} {}

  SyntheticTask make() {
    const Eigen::Vector3d outside{random_.uniform(-0.3, 0.3), -0.8, random_.uniform(0.2, 0.4)};
    return make(outside, static_cast<std::size_t>(config_.actions), [this](std::size_t) { return new_place(); });
  }

  SyntheticTask make(const SyntheticHandPath& way) {
    return make(way.outside_m, way.places_m.size(), [&way](std::size_t i) { return way.places_m[i]; });
  }

 private:
  template <class PlaceOf>
  SyntheticTask make(const Eigen::Vector3d& outside, std::size_t actions, const PlaceOf& place_of) {
    Eigen::Vector3d at = outside;
    for (std::size_t i = 0; i < actions; ++i) {
      const Eigen::Vector3d place = place_of(i);
      reach(at, place);
      at = act(place);
      task_.actions_m.push_back(place);
    }
    reach(at, outside);
    add(outside);
    return std::move(task_);
  }

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
    task_.trajectory.push_back(
        {time_s, repeats ? task_.trajectory.back().position_m : noisy(position_m), std::nullopt});
  }

  Eigen::Vector3d noisy(Eigen::Vector3d position_m) {
    for (int i = 0; config_.noise_m > 0.0 && i < 3; ++i) position_m[i] += config_.noise_m * random_.normal();
    return position_m;
  }

  int samples_in(double time_s) const { return std::max(1, static_cast<int>(std::lround(time_s * config_.rate_hz))); }

  /// Adds an arc over the straight line from `from` towards `to`, without the sample at `to`.
  void reach(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double length_m = (to - from).norm();
    const double speed_m_s = config_.speed_m_s * random_.uniform(2.0 / 3.0, 4.0 / 3.0);
    const Eigen::Vector3d bend{random_.uniform(-0.1, 0.1), 0.0, random_.uniform(0.1, 0.3)};
    const auto arc = [&](double way) -> Eigen::Vector3d {
      return from + way * (to - from) + length_m * std::sin(std::numbers::pi * way) * bend;
    };
    const double lift_m = lift_over_obstacles_m(from, to, arc);
    const int samples = samples_in(length_m / speed_m_s);
    for (int i = 0; i < samples; ++i) {
      const double way = minimum_jerk(static_cast<double>(i) / samples);
      add(arc(way) + lift_m * lifted(way) * Eigen::Vector3d::UnitZ());
    }
  }

  /// Returns the share of the lift after a share of the path: steep at both ends and level between.
  static double lifted(double way) { return 1.0 - std::pow(2.0 * way - 1.0, 4); }

  /// Returns the lift of an arc that must pass over the obstacles between its ends.
  template <class Arc>
  double lift_over_obstacles_m(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Arc& arc) const {
    constexpr int kSteps{1000};
    constexpr double kMost{0.6};  // share of the path's length
    double lift_m = 0.0;
    for (const Box& obstacle : obstacles_) {
      if (over(obstacle, from) || over(obstacle, to)) continue;
      for (int i = 1; i < kSteps; ++i) {
        const double way = static_cast<double>(i) / kSteps;
        const Eigen::Vector3d p = arc(way);
        if (over(obstacle, p)) lift_m = std::max(lift_m, (obstacle.max.z() - p.z()) / lifted(way));
      }
    }
    return std::min(lift_m, kMost * (to - from).norm());
  }

  /// Sways around the place with two slow frequencies; returns the final position.
  Eigen::Vector3d act(const Eigen::Vector3d& place) {
    const int samples = samples_in(config_.action_s * random_.uniform(0.6, 1.4));
    const double most_m = config_.sway_m;
    const double half_m = 0.5 * config_.sway_m;
    const Eigen::Vector3d slow{random_.uniform(-most_m, most_m), random_.uniform(-most_m, most_m),
                               random_.uniform(half_m, most_m)};
    const Eigen::Vector3d fast{random_.uniform(-half_m, half_m), random_.uniform(-half_m, half_m),
                               random_.uniform(0.0, half_m)};
    for (int i = 0; i < samples; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / samples;
      add(place + std::sin(turn) * slow + std::sin(2.0 * turn) * fast);
    }
    return place;
  }

  const SyntheticTaskConfig& config_;
  std::span<const Box> obstacles_;
  SeededRandom random_;
  SyntheticTask task_;
};

}  // namespace

SyntheticTask synthetic_task(std::uint64_t seed, const SyntheticTaskConfig& config) {
  SACCADE_EXPECTS(config.actions >= 1 && config.actions <= 4);
  SACCADE_EXPECTS(config.rate_hz > 0.0 && config.speed_m_s > 0.0 && config.action_s > 0.0);
  return TaskMaker{seed, config}.make();
}

SyntheticTask synthetic_task(const SyntheticHandPath& way, std::uint64_t seed, const SyntheticTaskConfig& config) {
  SACCADE_EXPECTS(!way.places_m.empty() && way.outside_m.allFinite());
  SACCADE_EXPECTS(std::all_of(way.places_m.begin(), way.places_m.end(), [](const auto& p) { return p.allFinite(); }));
  SACCADE_EXPECTS(config.rate_hz > 0.0 && config.speed_m_s > 0.0 && config.action_s > 0.0);
  return TaskMaker{seed, config, way.obstacles}.make(way);
}

}  // namespace saccade
