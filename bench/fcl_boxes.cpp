// SPDX-License-Identifier: Apache-2.0
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <vector>

#include "peers.hpp"

namespace saccade::bench {

struct FclBoxes::Impl {
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  fcl::DynamicAABBTreeCollisionManagerd tree;
};

FclBoxes::FclBoxes(std::span<const Box> boxes) : impl_{std::make_unique<Impl>()} {
  std::vector<fcl::CollisionObjectd*> pointers;
  for (const Box& box : boxes) {
    const Eigen::Vector3d edges = box.max - box.min;
    fcl::Transform3d T_world_box{fcl::Transform3d::Identity()};
    T_world_box.translation() = 0.5 * (box.min + box.max);
    impl_->objects.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(edges), T_world_box));
    pointers.push_back(impl_->objects.back().get());
  }
  impl_->tree.registerObjects(pointers);
  impl_->tree.setup();
}
FclBoxes::~FclBoxes() = default;

std::size_t FclBoxes::size() const { return impl_->objects.size(); }

bool FclBoxes::touches(const Sphere& sphere) const {
  fcl::Transform3d T_world_sphere{fcl::Transform3d::Identity()};
  T_world_sphere.translation() = sphere.center;
  fcl::CollisionObjectd object{std::make_shared<fcl::Sphered>(sphere.radius_m), T_world_sphere};
  fcl::DefaultCollisionData<double> data;
  impl_->tree.collide(&object, &data, fcl::DefaultCollisionFunction<double>);
  return data.result.isCollision();
}

}  // namespace saccade::bench
