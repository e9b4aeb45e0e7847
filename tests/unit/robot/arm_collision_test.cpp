// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/arm_collision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saccade/robot/body_surface.hpp"
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
ObstacleMap only(std::vector<Box> fixtures) {
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
      only({Box{{1.2, -0.1, -0.1}, {1.3, 0.1, 0.1}}, Box{{-0.7, 0.3, -0.1}, {-0.3, 0.4, 0.1}}});
  const auto hand = arm.contact(turned(0.0, 0.0, 0.0), obstacles);
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->link, 3);
  EXPECT_FALSE(hand->other_link);
  const auto elbow = arm.contact(turned(0.0, 0.8 * kPi, 0.0), obstacles);  // beside the second box, folded back
  EXPECT_FALSE(elbow);
  const auto itself = arm.contact(turned(0.0, 0.5 * kPi + 0.9, 0.5 * kPi + 0.3), only({}));
  ASSERT_TRUE(itself);
  EXPECT_EQ(itself->link, 3);
  EXPECT_EQ(itself->other_link, 1);
  EXPECT_FALSE(arm.contact(turned(0.3, 0.4, -0.5), only({})));
}

TEST(ArmCollision, NoLinkStepsThroughAPlate) {
  const ArmCollision arm = ArmCollision::create(bars()).value();
  // The thin bar's tip sweeps across a plate of 2 cm that the ends of the motion lie on both sides of.
  const ObstacleMap plate = only({Box{{1.2, -0.01, -0.1}, {1.49, 0.01, 0.1}}});
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
    EXPECT_FALSE(arm.motion_contact(from, to, only({})));
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
  const ObstacleMap obstacles = only(boxes);
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
