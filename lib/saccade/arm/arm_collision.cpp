// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_collision.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "saccade/arm/arm_mesh.hpp"
#include "saccade/arm/internal/arm_cover.hpp"
#include "saccade/arm/internal/cover_separation.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kBarely_m{1e-6};
constexpr double kFloatSlack{1e-5};  ///< a float's relative rounding is 6e-8; it accumulates along an arm
constexpr int kSelfSamples{200};
constexpr std::uint32_t kSelfSeed{1};

Vector3d half_edges(const Eigen::AlignedBox3d& box) { return 0.5 * box.sizes() + Vector3d::Constant(kBarely_m); }

/// Returns the largest distance between the origins of a joint and of the previous one.
double longest_offset_m(const ArmJoint& joint) {
  const double slide_m =
      joint.kind == JointKind::prismatic ? std::max(std::fabs(joint.limits.lower), std::fabs(joint.limits.upper)) : 0.0;
  return joint.T_parent_joint.translation().norm() + slide_m;
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
  const auto bodies = std::make_shared<CoveredBodies>();
  std::vector<std::vector<Eigen::AlignedBox3d>> upright_boxes;
  for (const ArmLink& link : arm.links()) {
    std::vector<SphereTree>& covers = bodies->covers.emplace_back();
    std::vector<BodyBox>& boxes = bodies->boxes.emplace_back();
    std::vector<Eigen::AlignedBox3d>& upright = upright_boxes.emplace_back();
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
      Eigen::AlignedBox3d along_link;
      const Pose T_body_link = body.T_link_body.inverse(Eigen::Isometry);
      for (const Eigen::Vector3f& p : surface.vertices) {
        box.extend(T_body_link * p.cast<double>());
        along_link.extend(p.cast<double>());
      }
      boxes.push_back({body.T_link_body * Eigen::Translation3d{box.center()}, half_edges(box)});
      upright.push_back(along_link);
    }
  }
  collision.bodies_ = bodies;
  collision.find_levers();
  collision.find_self_pairs();
  const double farthest_m = arm.T_world_base().translation().norm() + reach_bound_m(arm) +
                            *std::max_element(collision.reach_m_.begin(), collision.reach_m_.end());
  collision.front_ = std::make_shared<const ArmCover>(arm, bodies->covers, upright_boxes, collision.self_pairs_,
                                                      kFloatSlack * farthest_m);
  return collision;
}

/// Computes upper bounds of the distances from a joint's origin to the links behind it, and of their reach.
void ArmCollision::find_levers() {
  const ArmModel& arm = *arm_;
  const auto links = bodies_->covers.size();
  reach_m_.assign(links, 0.0);
  for (std::size_t link = 0; link < links; ++link) {
    for (const SphereTree& cover : bodies_->covers[link]) {
      const TreeBall& whole = cover.balls().front();
      reach_m_[link] = std::max(reach_m_[link], static_cast<double>(whole.center.norm() + whole.radius_m));
    }
  }
  offsets_m_.assign(links * links, 0.0);
  for (int i = 0; i < arm.dof(); ++i) {
    double offset_m = 0.0;
    for (int behind = i; behind < arm.dof(); ++behind) {
      if (behind > i) offset_m += longest_offset_m(arm.joint(behind));
      offsets_m_[static_cast<std::size_t>(i) * links + static_cast<std::size_t>(behind) + 1] = offset_m;
    }
  }
}

void ArmCollision::find_self_pairs() {
  const int links = static_cast<int>(bodies_->covers.size());
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < links; ++a) {
    for (int b = a + 2; b < links; ++b) {
      if (!cover(a).empty() && !cover(b).empty()) pairs.emplace_back(a, b);
    }
  }
  std::vector<int> touched(pairs.size(), 0);
  SeededRandom random{kSelfSeed};
  for (int sample = 0; sample < kSelfSamples; ++sample) {
    const ArmPoses poses = forward_kinematics(*arm_, sample_configuration(*arm_, random));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& [a, b] = pairs[i];
      const Pose& T_world_a = poses.T_world_link[static_cast<std::size_t>(a)];
      const Pose& T_world_b = poses.T_world_link[static_cast<std::size_t>(b)];
      if (touched[i] == sample && separation_m(T_world_a, T_world_b, a, b, 0.0) <= 0.0) ++touched[i];
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (touched[i] < kSelfSamples) self_pairs_.push_back(pairs[i]);
  }
}

double ArmCollision::separation_m(const Pose& T_world_a, const Pose& T_world_b, int a, int b, double enough_m) const {
  const auto link_a = static_cast<std::size_t>(a);
  const auto link_b = static_cast<std::size_t>(b);
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < bodies_->boxes[link_a].size(); ++i) {
    const PlacedBody body_a{bodies_->covers[link_a][i], bodies_->boxes[link_a][i], T_world_a};
    for (std::size_t j = 0; j < bodies_->boxes[link_b].size(); ++j) {
      const PlacedBody body_b{bodies_->covers[link_b][j], bodies_->boxes[link_b][j], T_world_b};
      least_m = std::min(least_m, saccade::separation_m(body_a, body_b, enough_m));
    }
  }
  return least_m;
}

std::string describe(const ArmModel& arm, const Contact& contact) {
  const auto link = [&arm](int i) { return "link \"" + arm.links()[static_cast<std::size_t>(i)].name + "\""; };
  return link(contact.link) + " touches " + (contact.other_link ? link(*contact.other_link) : "an obstacle");
}

double ArmCollision::separation_m(const PlacedFront& placed, int a, int b, double enough_m) const {
  const double slack_m = 2.0 * front_->slack_m();
  return separation_m(placed.T_world_link(static_cast<std::size_t>(a)),
                      placed.T_world_link(static_cast<std::size_t>(b)), a, b, enough_m + slack_m) -
         slack_m;
}

std::optional<Contact> ArmCollision::contact(const Configuration& q, const ObstacleMap& obstacles) const {
  SACCADE_EXPECTS(q.size() == arm_->dof());
  return contact(PlacedFront{*front_, q}, obstacles);
}

std::optional<Contact> ArmCollision::contact(const ArmPoses& poses, const ObstacleMap& obstacles) const {
  return contact(PlacedFront{*front_, poses}, obstacles);
}

std::optional<Contact> ArmCollision::contact(const PlacedFront& placed, const ObstacleMap& obstacles) const {
  const std::size_t count = front_->balls().size();
  constexpr std::size_t kAtOnce{64};
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    std::uint64_t perhaps{0};
    obstacles.perhaps_touching(placed.spheres(first, std::min(kAtOnce, count - first)), {&perhaps, 1});
    for (; perhaps != 0; perhaps &= perhaps - 1) {
      const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(perhaps));
      std::uint64_t finer = placed.perhaps_touching_finer(i, obstacles);
      for (; finer != 0; finer &= finer - 1) {
        const FrontBall& ball = front_->finer(i)[static_cast<std::size_t>(std::countr_zero(finer))];
        if (touches_obstacle(ball, placed, obstacles)) {
          return Contact{static_cast<int>(ball.link), std::nullopt};
        }
      }
    }
  }
  constexpr std::array<float, kMostPairs> kNoMargins{};
  for (std::size_t i = 0; (i = placed.first_near_pair(i, kNoMargins)) < self_pairs_.size(); ++i) {
    const auto& [a, b] = self_pairs_[i];
    if (separation_m(placed, a, b, 0.0) <= 0.0) return Contact{b, a};
  }
  return std::nullopt;
}

const std::vector<SphereTree>& ArmCollision::cover(int link) const {
  return bodies_->covers[static_cast<std::size_t>(link)];
}

bool ArmCollision::clear(const ArmPoses& poses, const BallIsClear& is_clear) const {
  for (std::size_t link = 1; link < bodies_->covers.size(); ++link) {
    for (const SphereTree& cover : bodies_->covers[link]) {
      const bool clear = cover.clear([&](const TreeBall& ball) {
        const Vector3d center = poses.T_world_link[link] * ball.center.cast<double>();
        return is_clear(center, static_cast<double>(ball.radius_m), ball.finest);
      });
      if (!clear) return false;
    }
  }
  return true;
}

bool ArmCollision::touches_obstacle(const FrontBall& of_front, const PlacedFront& placed,
                                    const ObstacleMap& obstacles) const {
  const Pose T_world_link = placed.T_world_link(of_front.link);
  const auto is_clear = [&](const TreeBall& ball) {
    const Vector3d center = T_world_link * ball.center.cast<double>();
    const double radius_m = static_cast<double>(ball.radius_m) + front_->slack_m();
    // The exact answer costs more than testing the balls below.
    return ball.finest ? obstacles.clear(center, radius_m) : obstacles.distance_bound_m(center) > radius_m;
  };
  return !bodies_->covers[of_front.link][of_front.body].clear(is_clear, of_front.index);
}

double ArmCollision::travel_bound_m(const Configuration& from, const Configuration& to) const {
  double bound_m = 0.0;
  for (std::size_t link = 1; link < bodies_->covers.size(); ++link) {
    if (bodies_->covers[link].empty()) continue;
    const MotionBound travel = motion_bound_of(0, link, from, to);
    bound_m = std::max(bound_m, travel.fixed_m + travel.turn_rad * reach_m_[link]);
  }
  return bound_m;
}

ArmCollision::MotionBound ArmCollision::motion_bound_of(std::size_t first, std::size_t link, const Configuration& from,
                                                        const Configuration& to) const {
  MotionBound travel;
  for (std::size_t joint = first; joint < link; ++joint) {
    const auto i = static_cast<int>(joint);
    const double change = std::fabs(to[i] - from[i]);
    if (arm_->joint(i).kind == JointKind::prismatic) {
      travel.fixed_m += change;
    } else {
      travel.fixed_m += change * offsets_m_[joint * bodies_->covers.size() + link];
      travel.turn_rad += change;
    }
  }
  return travel;
}

}  // namespace saccade
