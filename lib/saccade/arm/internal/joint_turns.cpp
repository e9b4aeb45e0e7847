// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/joint_turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace saccade {
namespace {

constexpr double kTurn{2.0 * std::numbers::pi};

/// Variants of one joint's value.
struct Ways {
  std::array<double, 64> values;
  int count{0};
};

Ways ways_of(const ArmJoint& joint, double value, double reference, int max_turns) {
  const JointLimits& limits = joint.limits;
  Ways ways;
  const double nearest =
      joint.kind == JointKind::prismatic ? value : value + kTurn * std::round((reference - value) / kTurn);
  if (joint.kind != JointKind::revolute) {
    if (nearest >= limits.lower - kLimitSlack && nearest <= limits.upper + kLimitSlack)
      ways.values[static_cast<std::size_t>(ways.count++)] = std::clamp(nearest, limits.lower, limits.upper);
    return ways;
  }
  const double first = std::ceil((limits.lower - kLimitSlack - value) / kTurn);
  const double last = std::floor((limits.upper + kLimitSlack - value) / kTurn);
  if (last < first) return ways;
  // From the turn nearest to the reference outwards, nearer side first.
  double down = std::clamp(std::round((nearest - value) / kTurn), first, last);
  double up = down + 1.0;
  const double most = std::min<double>(max_turns, static_cast<double>(ways.values.size()));
  const auto wanted = static_cast<int>(std::min(most, last - first + 1.0));
  while (ways.count < wanted) {
    const double below = value + kTurn * down;
    const double above = value + kTurn * up;
    const bool take_below =
        up > last || (down >= first && std::fabs(below - reference) <= std::fabs(above - reference));
    (take_below ? down : up) += take_below ? -1.0 : 1.0;
    ways.values[static_cast<std::size_t>(ways.count++)] =
        std::clamp(take_below ? below : above, limits.lower, limits.upper);
  }
  return ways;
}

}  // namespace

bool has_turn_within(double angle_rad, double lower_rad, double upper_rad) {
  // The smallest equivalent angle that is not below the lower limit.
  if (angle_rad >= lower_rad - kLimitSlack && angle_rad <= upper_rad + kLimitSlack) return true;
  const double turns = std::ceil((lower_rad - kLimitSlack - angle_rad) / kTurn);
  return angle_rad + kTurn * turns <= upper_rad + kLimitSlack;
}

void append_turns(const ArmModel& arm, const Configuration& q, const Configuration& reference, int max_turns,
                  std::vector<Configuration>& solutions) {
  SACCADE_EXPECTS(q.size() == arm.dof() && reference.size() == arm.dof() && max_turns >= 1);
  std::array<Ways, kMaxJoints> ways;
  for (int i = 0; i < arm.dof(); ++i) {
    ways[static_cast<std::size_t>(i)] = ways_of(arm.joint(i), q[i], reference[i], max_turns);
    if (ways[static_cast<std::size_t>(i)].count == 0) return;
  }
  std::array<int, kMaxJoints> chosen{};
  for (;;) {
    Configuration& solution = solutions.emplace_back(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      solution[i] = ways[k].values[static_cast<std::size_t>(chosen[k])];
    }
    int i = arm.dof() - 1;
    while (i >= 0 && ++chosen[static_cast<std::size_t>(i)] == ways[static_cast<std::size_t>(i)].count) {
      chosen[static_cast<std::size_t>(i--)] = 0;
    }
    if (i < 0) return;
  }
}

}  // namespace saccade
