// SPDX-License-Identifier: Apache-2.0
// Arms against obstacles and themselves, beside FCL with a box per obstacle cell and the bodies as they are described.
// SACCADE_COLLISION_CASES: configurations per arm (3000).
#include "saccade/robot/arm_collision.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "support/effort.hpp"
#include "support/shared_arms.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kNear_m{0.05};   ///< of contact
constexpr int kDistanceEvery{8};  ///< distances to meshes take FCL long

int cases() {
  const char* wanted = std::getenv("SACCADE_COLLISION_CASES");
  return wanted != nullptr ? std::atoi(wanted) : test::scaled_cases(3000);
}

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct GeometryOf {
  Geometry operator()(const BoxBody& box) const { return std::make_shared<fcl::Boxd>(box.size_m); }
  Geometry operator()(const SphereBody& sphere) const { return std::make_shared<fcl::Sphered>(sphere.radius_m); }
  Geometry operator()(const CylinderBody& cylinder) const {
    return std::make_shared<fcl::Cylinderd>(cylinder.radius_m, cylinder.length_m);
  }
  Geometry operator()(const MeshBody& body) const {
    auto triangles = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    triangles->beginModel();
    for (const auto& [a, b, c] : body.mesh.triangles) {
      const auto corner = [&](std::uint32_t i) -> Vector3d { return body.mesh.vertices[i].cast<double>(); };
      triangles->addTriangle(corner(a), corner(b), corner(c));
    }
    triangles->endModel();
    return triangles;
  }
};

/// The oracle.
class FclArm {
 public:
  FclArm(const ArmCollision& arm, const ObstacleMap& obstacles) : arm_{arm} {
    for (const Box& box : obstacles.boxes()) {
      fcl::Transform3d T_world_box{fcl::Transform3d::Identity()};
      T_world_box.translation() = 0.5 * (box.min + box.max);
      const Vector3d edges = box.max - box.min;
      boxes_.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(edges), T_world_box));
      world_.registerObject(boxes_.back().get());
    }
    world_.setup();
    for (const ArmLink& link : arm.arm().links()) {
      auto& bodies = links_.emplace_back();
      for (const CollisionBody& body : link.bodies) {
        bodies.push_back(
            {body.T_link_body, std::make_unique<fcl::CollisionObjectd>(std::visit(GeometryOf{}, body.shape))});
      }
    }
  }

  [[nodiscard]] bool collides(const ArmPoses& poses) {
    place(poses);
    for (std::size_t link = 1; link < links_.size(); ++link) {
      for (const Body& body : links_[link]) {
        fcl::DefaultCollisionData<double> data;
        world_.collide(body.object.get(), &data, fcl::DefaultCollisionFunction<double>);
        if (data.result.isCollision()) return true;
      }
    }
    for (const auto& [a, b] : arm_.self_pairs()) {
      for (const Body& of_a : links_[static_cast<std::size_t>(a)]) {
        for (const Body& of_b : links_[static_cast<std::size_t>(b)]) {
          const fcl::CollisionRequestd request;
          fcl::CollisionResultd result;
          if (fcl::collide(of_a.object.get(), of_b.object.get(), request, result) > 0) return true;
        }
      }
    }
    return false;
  }

  /// To the nearest obstacle.
  [[nodiscard]] double distance_m(const ArmPoses& poses) {
    place(poses);
    double least_m = std::numeric_limits<double>::infinity();
    for (std::size_t link = 1; link < links_.size(); ++link) {
      for (const Body& body : links_[link]) {
        fcl::DefaultDistanceData<double> data;
        world_.distance(body.object.get(), &data, fcl::DefaultDistanceFunction<double>);
        least_m = std::min(least_m, data.result.min_distance);
      }
    }
    return least_m;
  }

 private:
  struct Body {
    Pose T_link_body;
    std::unique_ptr<fcl::CollisionObjectd> object;
  };

  void place(const ArmPoses& poses) {
    for (std::size_t link = 0; link < links_.size(); ++link) {
      for (const Body& body : links_[link]) {
        const Pose T_world_body = poses.T_world_link[link] * body.T_link_body;
        body.object->setTransform(T_world_body.linear(), T_world_body.translation());
        body.object->computeAABB();
      }
    }
  }

  const ArmCollision& arm_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> boxes_;
  fcl::DynamicAABBTreeCollisionManagerd world_;
  std::vector<std::vector<Body>> links_;
};

/// Free space around the first joint with unknown clutter in it, and a table under it.
ObstacleMap clutter_around(const Vector3d& shoulder, std::mt19937_64& random) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  config.workspace = Box{shoulder - Vector3d{1.5, 1.5, 0.6}, shoulder + Vector3d{1.5, 1.5, 1.5}};
  TsdfMap map = TsdfMap::create(config).value();
  EXPECT_TRUE(map.free(*config.workspace).ok());
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (int i = 0; i < 60; ++i) {
    const Vector3d offset{within(-1.4, 1.4), within(-1.4, 1.4), within(-0.4, 1.4)};
    const double radius_m = within(0.03, 0.12);
    if (offset.head<2>().norm() < 0.7) continue;
    EXPECT_TRUE(map.forget(Sphere{shoulder + offset, radius_m}).ok());
  }
  ObstacleConfig obstacles;
  obstacles.fixtures = {Box{shoulder + Vector3d{0.5, -1.0, -0.6}, shoulder + Vector3d{1.4, 1.0, -0.3}}};
  return ObstacleMap::create(map.snapshot(), obstacles, Executor{}).value();
}

struct Tally {
  int free{0};        ///< by FCL
  int called{0};      ///< of these, contacts by ours
  int collisions{0};  ///< by FCL
  int missed{0};      ///< of these, free by ours
};

void compare(const ArmModel& model) {
  ArmCollisionConfig config;
  if (test::kSanitized) config.max_excess_m = 0.02;  // fewer balls
  const auto arm = ArmCollision::create(model, config);
  ASSERT_TRUE(arm.ok()) << arm.error().to_string();
  std::mt19937_64 random{11};
  const ObstacleMap obstacles =
      clutter_around(forward_kinematics(model, model.middle()).T_world_link[1].translation(), random);
  FclArm fcl{*arm, obstacles};
  Tally all;
  Tally near;
  for (int i = 0; i < cases(); ++i) {
    const Configuration q = test::random_configuration(model, random);
    const ArmPoses poses = forward_kinematics(model, q);
    const bool ours = arm->contact(poses, obstacles).has_value();
    if (fcl.collides(poses)) {
      ++all.collisions;
      all.missed += ours ? 0 : 1;
      EXPECT_TRUE(ours) << model.name() << " at " << q.transpose();
      continue;
    }
    ++all.free;
    all.called += ours ? 1 : 0;
    if (i % kDistanceEvery != 0 || fcl.distance_m(poses) > kNear_m) continue;
    ++near.free;
    near.called += ours ? 1 : 0;
  }
  const double share = static_cast<double>(all.collisions) / cases();
  std::cout << model.name() << ": " << cases() << " configurations, " << 100.0 * share << " % collide; of " << all.free
            << " free ones " << all.called << " are called contacts; within " << 100.0 * kNear_m << " cm "
            << near.called << " of " << near.free << '\n';
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 0.7);
  if (!test::kSanitized) {
    EXPECT_LE(all.called, 0.05 * all.free);
  }
}

TEST(ArmCollisionParity, BuiltInComauIsNeverFreeWhereFclCollides) { compare(find_robot("comau_smart_six")->arm); }

TEST(ArmCollisionParity, RecordedHullsAreNeverFreeWhereFclCollides) {
  if (!std::filesystem::exists(test::shared_robots())) GTEST_SKIP() << "no " << test::shared_robots();
  compare(test::shared_comau(true)->arm);
}

}  // namespace
}  // namespace saccade
