// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_collision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saccade/arm/arm_mesh.hpp"
#include "saccade/arm/internal/sphere_tree.hpp"
#include "support/effort.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kPi{std::numbers::pi};

CollisionBody box_at(const Vector3d& center, const Vector3d& size_m) {
  return {"box", Pose{Eigen::Translation3d{center}}, BoxBody{size_m}};
}

/// Three bars of 0.5 m in the plane z = 0 that turn about z, one behind the other; the third is a thin one.
ArmModel bars() {
  ArmDescription description;
  description.name = "bars";
  description.links.push_back({"base", {}});
  for (int i = 0; i < 3; ++i) {
    ArmJoint joint;
    joint.name = "joint_" + std::to_string(i + 1);
    if (i > 0) joint.T_parent_joint = Pose{Eigen::Translation3d{0.5, 0.0, 0.0}};
    joint.limits = {-kPi, kPi, 1.0, 1.0};
    description.joints.push_back(joint);
    const double thick_m = i == 2 ? 0.01 : 0.08;
    description.links.push_back({"bar_" + std::to_string(i + 1), {box_at({0.25, 0.0, 0.0}, {0.5, thick_m, thick_m})}});
  }
  return ArmModel::create(description).value();
}

Configuration turned(double a, double b, double c) {
  Configuration q{3};
  q << a, b, c;
  return q;
}

/// Nothing but fixtures.
ObstacleMap fixtures_alone(std::vector<Box> fixtures) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  config.workspace = Box{{-0.1, -0.1, 0.8}, {0.1, 0.1, 1.0}};
  TsdfMap map = TsdfMap::create(config).value();
  EXPECT_TRUE(map.free(*config.workspace).ok());
  ObstacleConfig obstacles;
  obstacles.fixtures = std::move(fixtures);
  return ObstacleMap::create(map.snapshot(), obstacles, {}).value();
}

TEST(ArmCollision, NamesWhatTouches) {
  const ArmCollision arm = ArmCollision::create(bars()).value();
  EXPECT_EQ(arm.self_pairs(), (std::vector<std::pair<int, int>>{{1, 3}}));  // the base has no body
  const ObstacleMap obstacles =
      fixtures_alone({Box{{1.2, -0.1, -0.1}, {1.3, 0.1, 0.1}}, Box{{-0.7, 0.3, -0.1}, {-0.3, 0.4, 0.1}}});
  const auto hand = arm.contact(turned(0.0, 0.0, 0.0), obstacles);
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->link, 3);
  EXPECT_FALSE(hand->other_link);
  const auto elbow = arm.contact(turned(0.0, 0.8 * kPi, 0.0), obstacles);  // beside the second box, folded back
  EXPECT_FALSE(elbow);
  const auto itself = arm.contact(turned(0.0, 0.5 * kPi + 0.9, 0.5 * kPi + 0.3), fixtures_alone({}));
  ASSERT_TRUE(itself);
  EXPECT_EQ(itself->link, 3);
  EXPECT_EQ(itself->other_link, 1);
  EXPECT_FALSE(arm.contact(turned(0.3, 0.4, -0.5), fixtures_alone({})));
}

TEST(ArmCollision, NoLinkStepsThroughAPlate) {
  const ArmCollision arm = ArmCollision::create(bars()).value();
  // The thin bar's tip sweeps across a plate of 2 cm that the ends of the motion lie on both sides of.
  const ObstacleMap plate = fixtures_alone({Box{{1.2, -0.01, -0.1}, {1.49, 0.01, 0.1}}});
  for (const double speed : {0.05, 0.3, 1.0, 2.5}) {
    const Configuration from = turned(-0.5 * speed, 0.0, 0.0);
    const Configuration to = turned(0.5 * speed, 0.0, 0.0);
    ASSERT_FALSE(arm.contact(from, plate)) << speed;
    ASSERT_FALSE(arm.contact(to, plate)) << speed;
    const auto met = arm.motion_contact(from, to, plate);
    ASSERT_TRUE(met) << speed;
    EXPECT_EQ(met->contact.link, 3);
    EXPECT_GT(met->share, 0.0);
    EXPECT_LT(met->share, 0.5);
    EXPECT_FALSE(arm.motion_contact(from, to, fixtures_alone({})));
  }
  EXPECT_FALSE(arm.motion_contact(turned(0.5, 0, 0), turned(0.5, 0, 0), plate));  // no way at all
}

TEST(ArmCollision, MotionsCalledFreeAreFreeAtEverySample) {
  std::mt19937_64 random{3};
  const ArmCollision arm = ArmCollision::create(bars()).value();
  std::vector<Box> boxes;
  for (int i = 0; i < 8; ++i) {
    const double angle_rad = 0.8 * i;
    const Vector3d p{1.1 * std::cos(angle_rad), 1.1 * std::sin(angle_rad), 0.0};
    boxes.push_back({p - Vector3d{0.03, 0.01, 0.1}, p + Vector3d{0.03, 0.01, 0.1}});
  }
  const ObstacleMap obstacles = fixtures_alone(boxes);
  int free = 0;
  int met = 0;
  for (int i = 0; i < test::scaled_cases(400); ++i) {
    const Configuration from = test::random_configuration(arm.arm(), random);
    const Configuration to = from + 0.2 * (test::random_configuration(arm.arm(), random) - from);
    const auto found = arm.motion_contact(from, to, obstacles);
    (found ? met : free) += 1;
    if (found) {
      EXPECT_TRUE(arm.contact(from + found->share * (to - from), obstacles));
      continue;
    }
    for (int k = 0; k <= 200; ++k) {
      EXPECT_FALSE(arm.contact(from + 0.005 * k * (to - from), obstacles)) << i << ' ' << k;
    }
  }
  EXPECT_GT(free, test::scaled_cases(400) / 10);
  EXPECT_GT(met, test::scaled_cases(400) / 10);
}

/// The base far away and askew, then a slide, a joint that turns without end, and two bars.
ArmModel slider() {
  ArmDescription description = bars().description();
  description.name = "slider";
  description.T_world_base = Pose{Eigen::Translation3d{60.0, -80.0, 20.0} * Eigen::AngleAxisd{0.7, Vector3d::UnitY()}};
  description.links[0].bodies = {box_at({0.0, 0.0, -0.2}, {0.3, 0.3, 0.3})};
  description.joints[0].kind = JointKind::prismatic;
  description.joints[0].axis_joint = Vector3d{1.0, 0.0, 1.0};
  description.joints[0].limits = {-0.4, 0.4, 1.0, 1.0};
  description.joints[1].kind = JointKind::continuous;
  description.joints[1].axis_joint = Vector3d{0.2, -0.3, 1.0};
  return ArmModel::create(description).value();
}

/// Eight small boxes around an arm's base.
ObstacleMap around(const Vector3d& base) {
  std::vector<Box> boxes;
  for (int i = 0; i < 8; ++i) {
    const double angle_rad = 0.8 * i;
    const Vector3d p = base + Vector3d{1.0 * std::cos(angle_rad), 1.0 * std::sin(angle_rad), 0.1 * (i % 3 - 1)};
    boxes.push_back({p - Vector3d::Constant(0.1), p + Vector3d::Constant(0.1)});
  }
  return fixtures_alone(boxes);
}

struct FinestBall {
  std::size_t link;
  Vector3d center;
  double radius_m;
};

std::vector<FinestBall> finest_balls(const ArmCollision& arm, const Configuration& q) {
  const ArmPoses poses = forward_kinematics(arm.arm(), q);
  std::vector<FinestBall> all;
  for (int link = 0; link <= arm.arm().dof(); ++link) {
    for (const SphereTree& cover : arm.cover(link)) {
      for (const TreeBall& ball : cover.balls()) {
        if (!ball.finest) continue;
        const auto i = static_cast<std::size_t>(link);
        all.push_back({i, poses.T_world_link[i] * ball.center.cast<double>(), static_cast<double>(ball.radius_m)});
      }
    }
  }
  return all;
}

/// Every ball of the finest level, one by one, larger by spare_m.
bool some_ball_touches(const ArmCollision& arm, const Configuration& q, const ObstacleMap& obstacles, double spare_m) {
  const std::vector<FinestBall> balls = finest_balls(arm, q);
  for (const FinestBall& ball : balls) {
    if (ball.link > 0 && !obstacles.clear(ball.center, ball.radius_m + spare_m)) return true;
  }
  for (const auto& [a, b] : arm.self_pairs()) {
    for (const FinestBall& of_a : balls) {
      if (of_a.link != static_cast<std::size_t>(a)) continue;
      for (const FinestBall& of_b : balls) {
        const double reach_m = of_a.radius_m + of_b.radius_m + 2.0 * spare_m;
        if (of_b.link == static_cast<std::size_t>(b) && (of_a.center - of_b.center).norm() <= reach_m) return true;
      }
    }
  }
  return false;
}

/// Corners of the boxes that an arm is made of, and points on their edges.
bool some_point_touches(const ArmCollision& arm, const Configuration& q, const ObstacleMap& obstacles) {
  const ArmPoses poses = forward_kinematics(arm.arm(), q);
  for (std::size_t link = 1; link < arm.arm().links().size(); ++link) {
    for (const CollisionBody& body : arm.arm().links()[link].bodies) {
      const Vector3d half_m = 0.5 * std::get<BoxBody>(body.shape).size_m;
      for (int i = 0; i < 8 * 8 * 8; ++i) {
        const Vector3d share = Eigen::Vector3i{i % 8, i / 8 % 8, i / 64}.cast<double>() / 3.5 - Vector3d::Ones();
        const Vector3d p_world = poses.T_world_link[link] * body.T_link_body * share.cwiseProduct(half_m);
        if (obstacles.distance_m(p_world) <= 0.0) return true;
      }
    }
  }
  return false;
}

TEST(ArmCollision, CoarseBallsDecideAsTheFinestDo) {
  std::mt19937_64 random{17};
  for (const ArmModel& model : {bars(), slider()}) {
    const ArmCollision arm = ArmCollision::create(model, {0.02, 0.01}).value();
    const ObstacleMap obstacles = around(model.T_world_base().translation());
    const int cases = test::scaled_cases(400);
    int contacts = 0;
    int unlike = 0;
    for (int i = 0; i < cases; ++i) {
      Configuration q = test::random_configuration(model, random);
      if (model.name() == "slider") q[1] += 2.0 * kPi * (i % 2000 - 1000);
      const bool contact = arm.contact(q, obstacles).has_value();
      EXPECT_EQ(contact, arm.contact(forward_kinematics(model, q), obstacles).has_value()) << q.transpose();
      if (contact) {
        EXPECT_TRUE(some_ball_touches(arm, q, obstacles, 2e-3)) << q.transpose();
      } else {
        EXPECT_FALSE(some_point_touches(arm, q, obstacles)) << q.transpose();
      }
      contacts += contact ? 1 : 0;
      unlike += contact != some_ball_touches(arm, q, obstacles, 0.0) ? 1 : 0;
    }
    EXPECT_GT(contacts, cases / 10) << model.name();
    EXPECT_LT(contacts, 9 * cases / 10) << model.name();
    EXPECT_LE(unlike, cases / 50 + 4) << model.name();  // a share of few cases scatters
  }
}

TEST(ArmCollision, ReportsTheFirstContactOfAMotion) {
  std::mt19937_64 random{21};
  constexpr double kStep_m{0.002};
  constexpr int kSamples{1000};
  const ArmCollision arm = ArmCollision::create(bars(), {0.005, kStep_m}).value();
  const ObstacleMap obstacles = around(Vector3d::Zero());
  int compared = 0;
  for (int i = 0; i < test::scaled_cases(100); ++i) {
    const Configuration from = test::random_configuration(arm.arm(), random);
    const Configuration to = from + 0.3 * (test::random_configuration(arm.arm(), random) - from);
    const auto found = arm.motion_contact(from, to, obstacles);
    // The first stretch on which the hand touches and moves much farther than a step.
    const double long_enough = 20.0 * kStep_m / arm.travel_bound_m(from, to);
    int touching = 0;
    for (int k = 0; k <= kSamples; ++k) {
      const double share = 1.0 * k / kSamples;
      const auto contact = arm.contact(from + share * (to - from), obstacles);
      touching = contact && contact->link == 3 ? touching + 1 : 0;
      if (touching < long_enough * kSamples) continue;
      ++compared;
      ASSERT_TRUE(found) << i;
      EXPECT_LE(found->share, share) << i;
      break;
    }
  }
  EXPECT_GT(compared, test::scaled_cases(100) / 10);
}

TEST(ArmCollision, ConfigurationsThatAreNotFiniteAreContacts) {
  const ArmCollision arm = ArmCollision::create(bars()).value();
  const Configuration good = turned(0.3, 0.4, -0.5);
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const Configuration bad = turned(0.3, value, 0.1);
    EXPECT_TRUE(arm.contact(bad, fixtures_alone({})));
    EXPECT_TRUE(arm.motion_contact(good, bad, fixtures_alone({})));
    EXPECT_TRUE(arm.motion_contact(bad, good, fixtures_alone({})));
  }
}

TEST(ArmCollision, NoPointTravelsFartherThanTheBound) {
  std::mt19937_64 random{9};
  const ArmCollision arm = ArmCollision::create(bars()).value();
  double tightest = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Configuration from = test::random_configuration(arm.arm(), random);
    const Configuration to = test::random_configuration(arm.arm(), random);
    const double bound_m = arm.travel_bound_m(from, to);
    const ArmPoses before = forward_kinematics(arm.arm(), from);
    const ArmPoses after = forward_kinematics(arm.arm(), to);
    for (std::size_t link = 1; link < 4; ++link) {
      for (const Vector3d& corner : {Vector3d{0.5, 0.04, 0.04}, Vector3d{0.0, -0.04, 0.04}}) {
        const double travel_m = (after.T_world_link[link] * corner - before.T_world_link[link] * corner).norm();
        EXPECT_LE(travel_m, bound_m);
        tightest = std::max(tightest, travel_m / bound_m);
      }
    }
  }
  EXPECT_GT(tightest, 0.5);
}

TEST(ArmCollision, RefusesBadSettings) {
  const auto message = [](ArmCollisionConfig config) {
    const auto arm = ArmCollision::create(bars(), config);
    return arm.ok() ? "" : arm.error().to_string();
  };
  EXPECT_NE(message({0.0, 0.01}).find("max_excess_m"), std::string::npos);
  EXPECT_NE(message({std::nan(""), 0.01}).find("max_excess_m"), std::string::npos);
  EXPECT_NE(message({0.005, -1.0}).find("max_step_m"), std::string::npos);
  EXPECT_NE(message({1e-5, 0.01}).find("link box"), std::string::npos);  // too fine, and for which body
}

TEST(BodySurface, LiesAroundRoundBodies) {
  const CollisionBody sphere{"ball", Pose{Eigen::Translation3d{1.0, 2.0, 3.0}}, SphereBody{0.5}};
  const CollisionBody cylinder{"tube", Pose{Eigen::AngleAxisd{0.5 * kPi, Vector3d::UnitX()}}, CylinderBody{0.5, 2.0}};
  for (const CollisionBody& body : {sphere, cylinder}) {
    const TriangleMesh surface = body_surface(body);
    double nearest_m = std::numeric_limits<double>::infinity();
    double volume = 0.0;
    for (const auto& [i, j, k] : surface.triangles) {
      const auto corner = [&](std::uint32_t n) -> Vector3d {
        return body.T_link_body.inverse() * surface.vertices[n].cast<double>();
      };
      const Vector3d a = corner(i);
      const Vector3d b = corner(j);
      const Vector3d c = corner(k);
      volume += a.dot(b.cross(c)) / 6.0;
      const Vector3d normal = (b - a).cross(c - a).normalized();
      if (std::fabs(normal.z()) < 0.999 || body.name == "ball") nearest_m = std::min(nearest_m, normal.dot(a));
    }
    EXPECT_GE(nearest_m, 0.5 - 1e-6) << body.name;
    EXPECT_LT(nearest_m, 0.52) << body.name;
    const double exact = body.name == "ball" ? 4.0 / 3.0 * kPi * 0.125 : kPi * 0.25 * 2.0;
    EXPECT_GT(volume, exact) << body.name;  // closed, normals outwards
    EXPECT_LT(volume, 1.05 * exact) << body.name;
  }
}

}  // namespace
}  // namespace saccade
