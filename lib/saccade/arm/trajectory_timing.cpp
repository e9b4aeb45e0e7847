// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/motion_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace saccade {
namespace {

/// Steps up to this length, rad or m, are not lines: their rates would be infinite.
constexpr double kSame{1e-12};

bool are_same(const Configuration& a, const Configuration& b) { return (b - a).lpNorm<Eigen::Infinity>() <= kSame; }

/// Straight line of the path, from share 0 to 1, with the rates that its joints allow.
struct Line {
  Configuration step;  ///< from beginning to end
  double max_rate;     ///< shares per second
  double max_acceleration;
};

Line line_between(const ArmModel& arm, const Configuration& from, const Configuration& to) {
  Line line{to - from, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int i = 0; i < arm.dof(); ++i) {
    const double step = std::fabs(line.step[i]);
    if (step == 0.0) continue;
    line.max_rate = std::min(line.max_rate, arm.joint(i).limits.speed / step);
    line.max_acceleration = std::min(line.max_acceleration, arm.joint(i).limits.acceleration / step);
  }
  return line;
}

/// Speed profile over a stretch of a line, `length` in shares: accelerate to a peak, cruise, brake.
struct Profile {
  double peak_rate;
  double accelerate_s;
  double cruise_s;
  double brake_s;
};

Profile profile_of(const Line& line, double length, double rate_in, double rate_out) {
  const double a = line.max_acceleration;
  const double meeting = std::sqrt(std::max(0.0, 0.5 * (rate_in * rate_in + rate_out * rate_out) + a * length));
  const double peak = std::max({std::min(line.max_rate, meeting), rate_in, rate_out});
  const double spent = (2.0 * peak * peak - rate_in * rate_in - rate_out * rate_out) / (2.0 * a);
  return {peak, (peak - rate_in) / a, std::max(0.0, length - spent) / peak, (peak - rate_out) / a};
}

/// Turn at a corner: a parabola from `before` shares ahead of it, on the line that ends here, to `after` shares beyond
/// it, on the next one. Without a duration the arm stops at the corner.
struct Turn {
  double before{0.0};
  double after{0.0};
  double duration_s{0.0};

  /// Rates on the two lines where the parabola meets them.
  [[nodiscard]] double rate_in() const { return duration_s > 0.0 ? 2.0 * before / duration_s : 0.0; }
  [[nodiscard]] double rate_out() const { return duration_s > 0.0 ? 2.0 * after / duration_s : 0.0; }
};

/// Returns the quickest turn. At most `widest` shares lie before and after, fewer on a longer line: both lines meet the
/// parabola at an equal fraction of their allowed speeds. Narrowing it by a factor preserves the curve's shape and
/// acceleration.
Turn quickest_turn(const ArmModel& arm, const Line& in, const Line& out, double widest) {
  constexpr double kLeast_s{1e-3};  // a straight path needs no turn
  double duration_s = kLeast_s;
  for (int i = 0; i < arm.dof(); ++i) {
    const double change = std::fabs(out.max_rate * out.step[i] - in.max_rate * in.step[i]);
    duration_s = std::max(duration_s, change / arm.joint(i).limits.acceleration);
  }
  const double before = 0.5 * duration_s * in.max_rate;
  const double after = 0.5 * duration_s * out.max_rate;
  const double narrower = std::min(1.0, widest / std::max(before, after));
  return {narrower * before, narrower * after, std::sqrt(narrower) * duration_s};
}

Trajectory::Piece piece_of(const Line& in, const Line& out, const Configuration& corner, const Turn& turn) {
  const Configuration speed_in = turn.rate_in() * in.step;
  return {turn.duration_s, corner - turn.before * in.step, speed_in,
          (turn.rate_out() * out.step - speed_in) / turn.duration_s};
}

/// Slows turns until the lines between them are long enough for the change of speed.
void slow_down(const std::vector<Line>& lines, std::vector<Turn>& turns) {
  const auto slow_to = [](Turn& turn, double rate, double allowed) {
    if (rate > allowed) turn.duration_s *= rate / allowed;
  };
  const auto reachable = [&](std::size_t line, double rate) {
    const double length = 1.0 - turns[line].after - turns[line + 1].before;
    return std::sqrt(rate * rate + 2.0 * lines[line].max_acceleration * std::max(0.0, length));
  };
  // turns[i] lies between lines[i − 1] and lines[i]; the first and the last are at rest.
  for (std::size_t i = 1; i + 1 < turns.size(); ++i) {
    slow_to(turns[i], turns[i].rate_in(), reachable(i - 1, turns[i - 1].rate_out()));
  }
  for (std::size_t i = turns.size() - 1; i-- > 1;) {
    slow_to(turns[i], turns[i].rate_out(), reachable(i, turns[i + 1].rate_in()));
  }
}

std::vector<Trajectory::Piece> pieces_of(const JointPath& path, const std::vector<Line>& lines,
                                         const std::vector<Turn>& turns) {
  std::vector<Trajectory::Piece> pieces;
  const auto append = [&](Trajectory::Piece piece) {
    if (piece.duration_s > 0.0) pieces.push_back(std::move(piece));
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    const Turn& turn_in = turns[i];
    const Turn& turn_out = turns[i + 1];
    const double rate_in = turn_in.rate_out();
    const double rate_out = turn_out.rate_in();
    const double end_share = 1.0 - turn_out.before;
    const Profile profile = profile_of(line, end_share - turn_in.after, rate_in, rate_out);
    const double cruise_share = turn_in.after + 0.5 * (rate_in + profile.peak_rate) * profile.accelerate_s;
    const double brake_share = end_share - 0.5 * (rate_out + profile.peak_rate) * profile.brake_s;
    const Configuration still = Configuration::Zero(line.step.size());
    append({profile.accelerate_s, path[i] + turn_in.after * line.step, rate_in * line.step,
            line.max_acceleration * line.step});
    append({profile.cruise_s, path[i] + cruise_share * line.step, profile.peak_rate * line.step, still});
    append({profile.brake_s, path[i] + brake_share * line.step, profile.peak_rate * line.step,
            -line.max_acceleration * line.step});
    if (turn_out.duration_s > 0.0) append(piece_of(line, lines[i + 1], path[i + 1], turn_out));
  }
  return pieces;
}

}  // namespace

Trajectory parametrise(const ArmModel& arm, const JointPath& path, const PieceIsFree& is_free) {
  constexpr double kWidest{0.5};  // a turn takes at most half of each line
  constexpr int kHalvings{5};
  JointPath corners;
  for (const Configuration& q : path) {
    if (corners.empty() || !are_same(corners.back(), q)) corners.push_back(q);
  }
  if (corners.size() < 2) {
    const Configuration still = Configuration::Zero(arm.dof());
    return corners.empty() ? Trajectory{} : Trajectory{{{0.0, corners.front(), still, still}}};
  }
  std::vector<Line> lines;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) lines.push_back(line_between(arm, corners[i], corners[i + 1]));

  std::vector<Turn> turns(corners.size());
  const Trajectory stopping{pieces_of(corners, lines, turns)};
  if (!is_free || corners.size() < 3) return stopping;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Turn quickest = quickest_turn(arm, lines[i - 1], lines[i], kWidest);
    double widest = std::max(quickest.before, quickest.after);
    for (int halving = 0; halving <= kHalvings; ++halving, widest *= 0.5) {
      const Turn turn = quickest_turn(arm, lines[i - 1], lines[i], widest);
      if (!is_free(piece_of(lines[i - 1], lines[i], corners[i], turn))) continue;
      turns[i] = turn;
      break;
    }
  }
  slow_down(lines, turns);
  Trajectory turning{pieces_of(corners, lines, turns)};
  return turning.duration_s() < stopping.duration_s() ? turning : stopping;
}

double rest_to_rest_s(const ArmModel& arm, const Configuration& from, const Configuration& to) {
  if (are_same(from, to)) return 0.0;
  const Profile profile = profile_of(line_between(arm, from, to), 1.0, 0.0, 0.0);
  return profile.accelerate_s + profile.cruise_s + profile.brake_s;
}

double rest_to_rest_s(const ArmModel& arm, const JointPath& path) {
  double sum_s = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) sum_s += rest_to_rest_s(arm, path[i], path[i + 1]);
  return sum_s;
}

}  // namespace saccade
