// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/arm_collision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "saccade/robot/body_surface.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr int kSelfSamples{200};
constexpr std::uint32_t kSelfSeed{1};

Vector3d center_in(const Pose& T_world_link, const TreeBall& ball) { return T_world_link * ball.center.cast<double>(); }

/// Lower bound of the distance between two covered bodies. Balls are looked into until it is more than `enough_m`, or
/// they are of the finest level; at or below 0 they touch.
class Separation {
 public:
  Separation(const SphereTree& a, const Pose& T_a_b, const SphereTree& b, double enough_m)
      : a_{a.balls()}, b_{b.balls()}, T_a_b_{T_a_b}, enough_m_{enough_m} {
    look(0, 0);
  }
  [[nodiscard]] double metres() const { return least_m_; }

 private:
  void look(std::uint32_t i, std::uint32_t j) {
    const TreeBall& a = a_[i];
    const TreeBall& b = b_[j];
    const double gap_m = (a.center.cast<double>() - T_a_b_ * b.center.cast<double>()).norm() -
                         static_cast<double>(a.radius_m) - static_cast<double>(b.radius_m);
    if (gap_m >= least_m_) return;
    if (gap_m > enough_m_ || (a.finest && b.finest)) {
      least_m_ = gap_m;
    } else if (b.finest || (!a.finest && a.radius_m >= b.radius_m)) {
      for (std::uint32_t child = i + 1; child < a.next && least_m_ > 0.0; child = a_[child].next) look(child, j);
    } else {
      for (std::uint32_t child = j + 1; child < b.next && least_m_ > 0.0; child = b_[child].next) look(i, child);
    }
  }

  std::span<const TreeBall> a_;
  std::span<const TreeBall> b_;
  Pose T_a_b_;
  double enough_m_;
  double least_m_{std::numeric_limits<double>::infinity()};
};

/// How far the origin of a joint can be from that of the joint before.
double longest_offset_m(const ArmJoint& joint) {
  const double slide_m =
      joint.kind == JointKind::prismatic ? std::max(std::fabs(joint.limits.lower), std::fabs(joint.limits.upper)) : 0.0;
  return joint.T_parent_joint.translation().norm() + slide_m;
}

Configuration random_configuration(const ArmModel& arm, std::mt19937& random) {
  Configuration q{arm.dof()};
  for (int i = 0; i < arm.dof(); ++i) {
    const JointLimits& limits = arm.joint(i).limits;
    const bool endless = arm.joint(i).kind == JointKind::continuous;
    const double share = static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    const double lower = endless ? -std::numbers::pi : limits.lower;
    const double upper = endless ? std::numbers::pi : limits.upper;
    q[i] = lower + share * (upper - lower);
  }
  return q;
}

}  // namespace

Status ArmCollisionConfig::validate() const {
  const auto sensible = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!sensible(max_excess_m)) return Error{Errc::invalid_argument, "max_excess_m must be positive", "arm collision"};
  if (!sensible(max_step_m)) return Error{Errc::invalid_argument, "max_step_m must be positive", "arm collision"};
  return {};
}

Result<ArmCollision> ArmCollision::create(const ArmModel& arm, const ArmCollisionConfig& config) {
  SACCADE_CHECK(config.validate());
  ArmCollision collision{arm, config};
  for (const ArmLink& link : arm.links()) {
    std::vector<SphereTree>& covers = collision.covers_.emplace_back();
    for (const CollisionBody& body : link.bodies) {
      auto cover = SphereTree::build(body_surface(body), {config.max_excess_m});
      if (!cover) {
        Error error = cover.error();
        error.context += ", link " + body.name;
        return error;
      }
      covers.push_back(std::move(*cover));
    }
  }
  collision.find_travel();
  collision.find_self_pairs();
  return collision;
}

void ArmCollision::find_travel() {
  const ArmModel& arm = *arm_;
  travel_m_.assign(static_cast<std::size_t>(arm.dof()), 0.0);
  for (int i = 0; i < arm.dof(); ++i) {
    double& travel_m = travel_m_[static_cast<std::size_t>(i)];
    double offset_m = 0.0;
    for (int behind = i; behind < arm.dof(); ++behind) {
      if (behind > i) offset_m += longest_offset_m(arm.joint(behind));
      for (const SphereTree& cover : covers_[static_cast<std::size_t>(behind) + 1]) {
        const TreeBall& whole = cover.balls().front();
        travel_m = std::max(travel_m, offset_m + static_cast<double>(whole.center.norm() + whole.radius_m));
      }
    }
    if (arm.joint(i).kind == JointKind::prismatic) travel_m = 1.0;
  }
}

void ArmCollision::find_self_pairs() {
  const int links = static_cast<int>(covers_.size());
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < links; ++a) {
    for (int b = a + 2; b < links; ++b) {
      if (!cover(a).empty() && !cover(b).empty()) pairs.emplace_back(a, b);
    }
  }
  std::vector<int> touched(pairs.size(), 0);
  std::mt19937 random{kSelfSeed};
  for (int sample = 0; sample < kSelfSamples; ++sample) {
    const ArmPoses poses = forward_kinematics(*arm_, random_configuration(*arm_, random));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (touched[i] == sample) touched[i] += separation_m(poses, pairs[i].first, pairs[i].second, 0.0) <= 0.0 ? 1 : 0;
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (touched[i] < kSelfSamples) self_pairs_.push_back(pairs[i]);
  }
}

double ArmCollision::separation_m(const ArmPoses& poses, int a, int b, double enough_m) const {
  const Pose T_a_b = poses.T_world_link[static_cast<std::size_t>(a)].inverse(Eigen::Isometry) *
                     poses.T_world_link[static_cast<std::size_t>(b)];
  double least_m = std::numeric_limits<double>::infinity();
  for (const SphereTree& of_a : cover(a)) {
    for (const SphereTree& of_b : cover(b)) {
      least_m = std::min(least_m, Separation{of_a, T_a_b, of_b, enough_m}.metres());
    }
  }
  return least_m;
}

std::optional<Contact> ArmCollision::contact(const Configuration& q, const ObstacleMap& obstacles) const {
  return contact(forward_kinematics(*arm_, q), obstacles);
}

std::optional<Contact> ArmCollision::contact(const ArmPoses& poses, const ObstacleMap& obstacles) const {
  for (int link = static_cast<int>(covers_.size()) - 1; link > 0; --link) {  // the hand first: it is nearest to things
    const Pose& T_world_link = poses.T_world_link[static_cast<std::size_t>(link)];
    for (const SphereTree& body : cover(link)) {
      const bool clear = body.clear([&](const TreeBall& ball) {
        const Vector3d center = center_in(T_world_link, ball);
        const auto radius_m = static_cast<double>(ball.radius_m);
        // The exact answer costs more than a look at the balls below.
        return obstacles.distance_bound_m(center) > radius_m || (ball.finest && obstacles.clear(center, radius_m));
      });
      if (!clear) return Contact{link, std::nullopt};
    }
  }
  for (const auto& [a, b] : self_pairs_) {
    if (separation_m(poses, a, b, 0.0) <= 0.0) return Contact{b, a};
  }
  return std::nullopt;
}

/// Lower bound of how far the arm is from obstacles and from itself, looked for until it is more than max_step_m.
double ArmCollision::clearance_m(const ArmPoses& poses, const ObstacleMap& obstacles) const {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t link = 1; link < covers_.size(); ++link) {
    for (const SphereTree& body : covers_[link]) {
      body.clear([&](const TreeBall& ball) {
        const double gap_m =
            obstacles.distance_bound_m(center_in(poses.T_world_link[link], ball)) - static_cast<double>(ball.radius_m);
        const bool enough = gap_m > config_.max_step_m || ball.finest;
        if (enough) least_m = std::min(least_m, gap_m);
        return enough;
      });
    }
  }
  for (const auto& [a, b] : self_pairs_) least_m = std::min(least_m, separation_m(poses, a, b, config_.max_step_m));
  return least_m;
}

double ArmCollision::travel_bound_m(const Configuration& from, const Configuration& to) const {
  double bound_m = 0.0;
  for (int i = 0; i < arm_->dof(); ++i) bound_m += std::fabs(to[i] - from[i]) * travel_m_[static_cast<std::size_t>(i)];
  return bound_m;
}

std::optional<ArmCollision::MotionContact> ArmCollision::motion_contact(const Configuration& from,
                                                                        const Configuration& to,
                                                                        const ObstacleMap& obstacles) const {
  const double travel_m = travel_bound_m(from, to);
  for (double share = 0.0;;) {
    const ArmPoses poses = forward_kinematics(*arm_, from + share * (to - from));
    if (const auto found = contact(poses, obstacles)) return MotionContact{share, *found};
    if (share >= 1.0) return std::nullopt;
    const double step_m = std::max(config_.max_step_m, clearance_m(poses, obstacles));
    share = travel_m > 0.0 ? std::min(1.0, share + step_m / travel_m) : 1.0;
  }
}

}  // namespace saccade
