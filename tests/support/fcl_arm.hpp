// SPDX-License-Identifier: Apache-2.0
#pragma once
// FclArm: the oracle of ArmCollision; clutter_around: something for arms to run into.

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <limits>
#include <memory>
#include <random>
#include <variant>
#include <vector>

#include "saccade/arm/arm_collision.hpp"

namespace saccade::test {

struct FclGeometry {
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const BoxBody& box) const {
    return std::make_shared<fcl::Boxd>(box.size_m);
  }
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const SphereBody& sphere) const {
    return std::make_shared<fcl::Sphered>(sphere.radius_m);
  }
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const CylinderBody& cylinder) const {
    return std::make_shared<fcl::Cylinderd>(cylinder.radius_m, cylinder.length_m);
  }
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const MeshBody& body) const {
    auto triangles = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    triangles->beginModel();
    for (const auto& [a, b, c] : body.mesh.triangles) {
      const auto corner = [&](std::uint32_t i) -> Eigen::Vector3d { return body.mesh.vertices[i].cast<double>(); };
      triangles->addTriangle(corner(a), corner(b), corner(c));
    }
    triangles->endModel();
    return triangles;
  }
};

/// An arm and obstacles in FCL: a box per obstacle cell, and the bodies as they are described.
class FclArm {
 public:
  FclArm(const ArmCollision& arm, const ObstacleMap& obstacles) : arm_{arm} {
    for (const Box& box : obstacles.boxes()) {
      fcl::Transform3d T_world_box{fcl::Transform3d::Identity()};
      T_world_box.translation() = 0.5 * (box.min + box.max);
      const Eigen::Vector3d edges = box.max - box.min;
      boxes_.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(edges), T_world_box));
      world_.registerObject(boxes_.back().get());
    }
    world_.setup();
    for (const ArmLink& link : arm.arm().links()) {
      auto& bodies = links_.emplace_back();
      for (const CollisionBody& body : link.bodies) {
        bodies.push_back(
            {body.T_link_body, std::make_unique<fcl::CollisionObjectd>(std::visit(FclGeometry{}, body.shape))});
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

  /// To the nearest obstacle, or between two links that are held against each other.
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
    for (const auto& [a, b] : arm_.self_pairs()) {
      for (const Body& of_a : links_[static_cast<std::size_t>(a)]) {
        for (const Body& of_b : links_[static_cast<std::size_t>(b)]) {
          const fcl::DistanceRequestd request;
          fcl::DistanceResultd result;
          fcl::distance(of_a.object.get(), of_b.object.get(), request, result);
          least_m = std::min(least_m, result.min_distance);
        }
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
inline ObstacleMap clutter_around(const Eigen::Vector3d& shoulder, std::mt19937_64& random) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  config.workspace = Box{shoulder - Eigen::Vector3d{1.5, 1.5, 0.6}, shoulder + Eigen::Vector3d{1.5, 1.5, 1.5}};
  TsdfMap map = TsdfMap::create(config).value();
  SACCADE_EXPECTS(map.free(*config.workspace).ok());
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d offset{within(-1.4, 1.4), within(-1.4, 1.4), within(-0.4, 1.4)};
    const double radius_m = within(0.03, 0.12);
    if (offset.head<2>().norm() < 0.7) continue;
    SACCADE_EXPECTS(map.forget(Sphere{shoulder + offset, radius_m}).ok());
  }
  ObstacleConfig obstacles;
  obstacles.fixtures = {Box{shoulder + Eigen::Vector3d{0.5, -1.0, -0.6}, shoulder + Eigen::Vector3d{1.4, 1.0, -0.3}}};
  return ObstacleMap::create(map.snapshot(), obstacles, Executor{}).value();
}

}  // namespace saccade::test
