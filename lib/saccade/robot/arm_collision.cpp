// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/arm_collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <span>

#include "saccade/robot/body_surface.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFrontBalls{96};
constexpr double kBarely_m{1e-6};
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

/// Whether a side of one of two boxes has the other wholly beyond it, by more than margin_m. `half_m` are half edges.
bool boxes_apart(const Pose& T_world_a, const Vector3d& a_half_m, const Pose& T_world_b, const Vector3d& b_half_m,
                 double margin_m) {
  const Eigen::Matrix3d R_a_b = T_world_a.linear().transpose() * T_world_b.linear();
  const Vector3d apart = T_world_b.translation() - T_world_a.translation();
  const Vector3d along_a = (T_world_a.linear().transpose() * apart).cwiseAbs();
  const Vector3d along_b = (T_world_b.linear().transpose() * apart).cwiseAbs();
  const Eigen::Matrix3d turned = R_a_b.cwiseAbs();
  return ((along_a - a_half_m - turned * b_half_m).array() > margin_m).any() ||
         ((along_b - b_half_m - turned.transpose() * a_half_m).array() > margin_m).any();
}

Vector3d half_edges(const Eigen::AlignedBox3d& box) { return 0.5 * box.sizes() + Vector3d::Constant(kBarely_m); }

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
    std::vector<BodyBox>& boxes = collision.boxes_.emplace_back();
    Eigen::AlignedBox3d around;
    for (const CollisionBody& body : link.bodies) {
      const TriangleMesh surface = body_surface(body);
      auto cover = SphereTree::build(surface, {config.max_excess_m});
      if (!cover) {
        Error error = cover.error();
        error.context += ", link " + body.name;
        return error;
      }
      covers.push_back(std::move(*cover));
      Eigen::AlignedBox3d box;
      const Pose T_body_link = body.T_link_body.inverse(Eigen::Isometry);
      for (const Eigen::Vector3f& p : surface.vertices) {
        box.extend(T_body_link * p.cast<double>());
        around.extend(p.cast<double>());
      }
      boxes.push_back({body.T_link_body * Eigen::Translation3d{box.center()}, half_edges(box)});
    }
    collision.link_boxes_.push_back({Pose{Eigen::Translation3d{around.center()}}, half_edges(around)});
  }
  collision.choose_front();
  collision.find_travel();
  collision.find_self_pairs();
  return collision;
}

/// The largest ball is replaced by those below it until there are enough.
void ArmCollision::choose_front() {
  for (std::size_t link = covers_.size() - 1; link > 0; --link) {  // the hand first: it is nearest to things
    for (std::size_t body = 0; body < covers_[link].size(); ++body) {
      front_.push_back({link, body, 0, covers_[link][body].balls().front()});
    }
  }
  const auto worth_less = [](const FrontBall& a, const FrontBall& b) {
    return (a.ball.finest ? 0.0F : a.ball.radius_m) < (b.ball.finest ? 0.0F : b.ball.radius_m);
  };
  while (!front_.empty() && front_.size() < kFrontBalls) {
    const auto largest = std::max_element(front_.begin(), front_.end(), worth_less);
    const FrontBall split = *largest;
    if (split.ball.finest) break;
    front_.erase(largest);
    const auto balls = covers_[split.link][split.body].balls();
    for (std::uint32_t i = split.index + 1; i < split.ball.next; i = balls[i].next) {
      front_.push_back({split.link, split.body, i, balls[i]});
    }
  }
  std::stable_sort(front_.begin(), front_.end(),
                   [](const FrontBall& a, const FrontBall& b) { return a.link > b.link; });
}

template <class Visit>
bool ArmCollision::visit_front(const ArmPoses& poses, const ObstacleMap& obstacles, const Visit& visit) const {
  constexpr std::size_t kAtOnce{128};
  std::array<float, kAtOnce> x_m;
  std::array<float, kAtOnce> y_m;
  std::array<float, kAtOnce> z_m;
  std::array<float, kAtOnce> radius_m;
  std::array<float, kAtOnce> clearance_m;
  for (std::size_t begin = 0; begin < front_.size(); begin += kAtOnce) {
    const std::span<const FrontBall> some = std::span{front_}.subspan(begin, std::min(kAtOnce, front_.size() - begin));
    for (std::size_t i = 0; i < some.size(); ++i) {
      const Vector3d center = center_in(poses.T_world_link[some[i].link], some[i].ball);
      x_m[i] = static_cast<float>(center.x());
      y_m[i] = static_cast<float>(center.y());
      z_m[i] = static_cast<float>(center.z());
      radius_m[i] = some[i].ball.radius_m;
    }
    const auto first = [&](const std::array<float, kAtOnce>& values) { return std::span{values}.first(some.size()); };
    obstacles.clearance_bounds({first(x_m), first(y_m), first(z_m), first(radius_m)},
                               std::span{clearance_m}.first(some.size()));
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (!visit(some[i], static_cast<double>(clearance_m[i]))) return false;
    }
  }
  return true;
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
  const auto link_a = static_cast<std::size_t>(a);
  const auto link_b = static_cast<std::size_t>(b);
  const Pose& T_world_a = poses.T_world_link[link_a];
  const Pose& T_world_b = poses.T_world_link[link_b];
  if (boxes_apart(T_world_a * link_boxes_[link_a].T_link_box, link_boxes_[link_a].half_m,
                  T_world_b * link_boxes_[link_b].T_link_box, link_boxes_[link_b].half_m, enough_m)) {
    return enough_m + kBarely_m;
  }
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < boxes_[link_a].size(); ++i) {
    const BodyBox& box_a = boxes_[link_a][i];
    const TreeBall& ball_a = covers_[link_a][i].balls().front();
    for (std::size_t j = 0; j < boxes_[link_b].size(); ++j) {
      const BodyBox& box_b = boxes_[link_b][j];
      const TreeBall& ball_b = covers_[link_b][j].balls().front();
      const double gap_m = (center_in(T_world_a, ball_a) - center_in(T_world_b, ball_b)).norm() -
                           static_cast<double>(ball_a.radius_m) - static_cast<double>(ball_b.radius_m);
      if (gap_m > enough_m) {
        least_m = std::min(least_m, gap_m);
      } else if (boxes_apart(T_world_a * box_a.T_link_box, box_a.half_m, T_world_b * box_b.T_link_box, box_b.half_m,
                             enough_m)) {
        least_m = std::min(least_m, enough_m + kBarely_m);
      } else {
        const Pose T_a_b = T_world_a.inverse(Eigen::Isometry) * T_world_b;
        least_m = std::min(least_m, Separation{covers_[link_a][i], T_a_b, covers_[link_b][j], enough_m}.metres());
      }
    }
  }
  return least_m;
}

std::optional<Contact> ArmCollision::contact(const Configuration& q, const ObstacleMap& obstacles) const {
  return contact(forward_kinematics(*arm_, q), obstacles);
}

std::optional<Contact> ArmCollision::contact(const ArmPoses& poses, const ObstacleMap& obstacles) const {
  int touching{0};
  const bool clear = visit_front(poses, obstacles, [&](const FrontBall& front, double clearance_m) {
    if (clearance_m > 0.0) return true;
    touching = static_cast<int>(front.link);
    const auto is_clear = [&](const TreeBall& ball) {
      const Vector3d center = center_in(poses.T_world_link[front.link], ball);
      const auto radius_m = static_cast<double>(ball.radius_m);
      // The exact answer costs more than a look at the balls below.
      return obstacles.distance_bound_m(center) > radius_m || (ball.finest && obstacles.clear(center, radius_m));
    };
    return covers_[front.link][front.body].clear(is_clear, front.index);
  });
  if (!clear) return Contact{touching, std::nullopt};
  for (const auto& [a, b] : self_pairs_) {
    if (separation_m(poses, a, b, 0.0) <= 0.0) return Contact{b, a};
  }
  return std::nullopt;
}

/// Lower bound of how far the arm is from obstacles and from itself, looked for until it is more than max_step_m.
double ArmCollision::clearance_m(const ArmPoses& poses, const ObstacleMap& obstacles) const {
  double least_m = std::numeric_limits<double>::infinity();
  visit_front(poses, obstacles, [&](const FrontBall& front, double clearance_m) {
    if (clearance_m > config_.max_step_m) {
      least_m = std::min(least_m, clearance_m);
      return true;
    }
    return covers_[front.link][front.body].clear(
        [&](const TreeBall& ball) {
          const double gap_m = obstacles.distance_bound_m(center_in(poses.T_world_link[front.link], ball)) -
                               static_cast<double>(ball.radius_m);
          const bool enough = gap_m > config_.max_step_m || ball.finest;
          if (enough) least_m = std::min(least_m, gap_m);
          return enough;
        },
        front.index);
  });
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
