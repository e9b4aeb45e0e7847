// SPDX-License-Identifier: Apache-2.0
// ArmCollision::motion_contact: halves intervals of a motion as long as a ball could touch something within.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/arm/internal/arm_cover.hpp"
#include "saccade/arm/internal/cover_separation.hpp"

namespace saccade {

/// Check of a motion. In the middle of an interval each ball has its distance from obstacles. A ball that moves less
/// than this until the interval's ends is free throughout and is dropped. The remaining balls are checked in both
/// halves, the first one first; a ball that moves little compared to its size is replaced by the balls below it.
class ArmCollision::Motion {
 public:
  Motion(const ArmCollision& arm, const Configuration& from, const Configuration& to, const ObstacleMap& obstacles)
      : arm_{arm}, covers_{arm.bodies_->covers}, from_{from}, way_{to - from}, obstacles_{obstacles} {
    for (std::size_t link = 0; link < covers_.size(); ++link) travel_[link] = arm.motion_bound_of(0, link, from, to);
    for (std::size_t i = 0; i < arm.self_pairs_.size(); ++i) {
      const auto a = static_cast<std::size_t>(arm.self_pairs_[i].first);
      const auto b = static_cast<std::size_t>(arm.self_pairs_[i].second);
      const MotionBound travel = arm.motion_bound_of(a, b, from, to);
      pair_travel_m_[i] = static_cast<float>(travel.fixed_m + travel.turn_rad * arm.reach_m_[b]);
    }
  }

  [[nodiscard]] std::optional<MotionContact> first() {
    if (const auto found = arm_.contact(from_, obstacles_)) return MotionContact{0.0, *found};
    if (!way_.allFinite()) return at_the_end();  // no half of it would be short enough
    const std::span<const FrontBall> front = arm_.front_->balls();
    balls_.assign(front.begin(), front.end());
    for (std::size_t i = 0; i < arm_.self_pairs_.size(); ++i) pairs_.push_back(i);
    if (auto found = first_between(0.0, 1.0, {0, balls_.size(), 0, pairs_.size()})) return found;
    return at_the_end();
  }

 private:
  [[nodiscard]] std::optional<MotionContact> at_the_end() const {
    if (const auto found = arm_.contact(from_ + way_, obstacles_)) return MotionContact{1.0, *found};
    return std::nullopt;
  }

  /// Remaining checks: parts of balls_ and pairs_.
  struct PendingChecks {
    std::size_t first_ball, end_ball;
    std::size_t first_pair, end_pair;
    [[nodiscard]] bool empty() const { return first_ball == end_ball && first_pair == end_pair; }
  };

  /// Checks an interval; balls and pairs that remain undecided in its middle are appended.
  std::optional<MotionContact> first_between(double begin, double end, const PendingChecks& rest) {
    if (rest.empty()) return std::nullopt;
    const double middle = 0.5 * (begin + end);
    const Configuration q = from_ + middle * way_;
    const PlacedFront placed{*arm_.front_, q};
    half_ = 0.5 * (end - begin);
    touched_ = false;
    PendingChecks left{balls_.size(), 0, pairs_.size(), 0};
    look_at_balls(rest, placed);
    look_at_pairs(rest, placed);
    left.end_ball = balls_.size();
    left.end_pair = pairs_.size();
    std::optional<Contact> here;
    if (touched_) here = arm_.contact(placed, obstacles_);
    auto found = first_between(begin, middle, left);
    if (!found && here) found = MotionContact{middle, *here};
    if (!found) found = first_between(middle, end, left);
    balls_.resize(left.first_ball);
    pairs_.resize(left.first_pair);
    return found;
  }

  void look_at_balls(const PendingChecks& rest, const PlacedFront& placed) {
    constexpr std::size_t kAtOnce{64};
    std::array<float, kAtOnce> x_m;
    std::array<float, kAtOnce> y_m;
    std::array<float, kAtOnce> z_m;
    std::array<float, kAtOnce> radius_m;
    std::array<float, kAtOnce> clearance_m;
    std::size_t link = covers_.size();
    Pose T_world_link = Pose::Identity();
    for (std::size_t begin = rest.first_ball; begin < rest.end_ball; begin += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, rest.end_ball - begin);
      for (std::size_t i = 0; i < count; ++i) {
        const FrontBall& ball = balls_[begin + i];
        if (ball.link != link) T_world_link = placed.T_world_link(link = ball.link);
        const TreeBall& of_cover = covers_[ball.link][ball.body].balls()[ball.index];
        const Eigen::Vector3d center = T_world_link * of_cover.center.cast<double>();
        x_m[i] = static_cast<float>(center.x());
        y_m[i] = static_cast<float>(center.y());
        z_m[i] = static_cast<float>(center.z());
        radius_m[i] = of_cover.radius_m + static_cast<float>(arm_.front_->slack_m());
      }
      const auto first = [&](const std::array<float, kAtOnce>& values) { return std::span{values}.first(count); };
      obstacles_.clearance_bounds({first(x_m), first(y_m), first(z_m), first(radius_m)},
                                  std::span{clearance_m}.first(count));
      for (std::size_t i = 0; i < count; ++i) {
        const FrontBall ball = balls_[begin + i];
        look_at(ball, static_cast<double>(clearance_m[i]), placed);
      }
    }
  }

  /// Returns how far a ball moves until the ends of the interval.
  [[nodiscard]] double moves_m(std::size_t link, const TreeBall& ball) const {
    const MotionBound& travel = travel_[link];
    return half_ * (travel.fixed_m + travel.turn_rad * static_cast<double>(ball.center.norm() + ball.radius_m));
  }

  void look_at(const FrontBall& ball, double clearance_m, const PlacedFront& placed) {
    const auto balls = covers_[ball.link][ball.body].balls();
    const TreeBall& of_cover = balls[ball.index];
    const double moves_m = this->moves_m(ball.link, of_cover);
    if (clearance_m > moves_m) return;
    const auto radius_m = static_cast<double>(of_cover.radius_m);
    const bool shortest = 2.0 * moves_m <= arm_.config_.max_step_m;
    if (!shortest && moves_m > kMostMove * radius_m) {
      balls_.push_back(ball);
      return;
    }
    const Pose T_world_link = placed.T_world_link(ball.link);
    const double slack_m = arm_.front_->slack_m();
    if (of_cover.finest) {
      touched_ = touched_ || (clearance_m <= 0.0 &&
                              !obstacles_.clear(T_world_link * of_cover.center.cast<double>(), radius_m + slack_m));
      if (!shortest) balls_.push_back(ball);
      return;
    }
    for (std::uint32_t i = ball.index + 1; i < of_cover.next; i = balls[i].next) {
      const Eigen::Vector3d center = T_world_link * balls[i].center.cast<double>();
      const double reach_m = static_cast<double>(balls[i].radius_m) + slack_m;
      look_at({ball.link, ball.body, i}, obstacles_.distance_bound_m(center) - reach_m, placed);
    }
  }

  void look_at_pairs(const PendingChecks& rest, const PlacedFront& placed) {
    if (rest.first_pair == rest.end_pair) return;
    std::array<float, kMostPairs> margins_m;
    for (std::size_t i = 0; i < arm_.self_pairs_.size(); ++i)
      margins_m[i] = static_cast<float>(half_) * pair_travel_m_[i];
    for (std::size_t k = rest.first_pair; k < rest.end_pair; ++k) {
      const std::size_t i = pairs_[k];
      if (placed.first_near_pair(i, margins_m) != i) continue;
      const auto& [a, b] = arm_.self_pairs_[i];
      const auto moves_m = static_cast<double>(margins_m[i]);
      if (moves_m <= kMostPairMove_m) {
        const double gap_m = arm_.separation_m(placed, a, b, moves_m);
        if (gap_m > moves_m) continue;
        touched_ = touched_ || gap_m <= 0.0;
      }
      if (2.0 * moves_m > arm_.config_.max_step_m) pairs_.push_back(i);
    }
  }

  /// Largest movement of a ball, in radii, at which it is replaced by those below; otherwise the interval is halved.
  static constexpr double kMostMove{0.5};
  /// Largest movement of links whose balls are compared; beyond it only their boxes are, because too many balls would
  /// be near.
  static constexpr double kMostPairMove_m{0.03};

  const ArmCollision& arm_;
  const std::vector<std::vector<SphereTree>>& covers_;
  Configuration from_;
  Configuration way_;
  const ObstacleMap& obstacles_;
  std::array<MotionBound, kMaxJoints + 1> travel_;
  std::array<float, kMostPairs> pair_travel_m_;
  std::vector<FrontBall> balls_;  ///< stack
  std::vector<std::size_t> pairs_;
  double half_{0.0};  ///< half the current interval
  bool touched_{false};
};

std::optional<ArmCollision::MotionContact> ArmCollision::motion_contact(const Configuration& from,
                                                                        const Configuration& to,
                                                                        const ObstacleMap& obstacles) const {
  SACCADE_EXPECTS(from.size() == arm_->dof() && to.size() == arm_->dof());
  return Motion{*this, from, to, obstacles}.first();
}

}  // namespace saccade
