// SPDX-License-Identifier: Apache-2.0
#include <open3d/core/EigenConverter.h>
#include <open3d/t/geometry/VoxelBlockGrid.h>
#include <open3d/utility/Logging.h>

#include "peers.hpp"

namespace saccade::bench {

namespace o3d = open3d;

struct Open3dGrid::Impl {
  PinholeCamera camera;
  float truncation_vox;
  o3d::core::Tensor intrinsic;
  o3d::t::geometry::VoxelBlockGrid grid;

  [[nodiscard]] o3d::core::Tensor extrinsic(const Pose& T_world_camera) const {
    return o3d::core::eigen_converter::EigenMatrixToTensor(T_world_camera.inverse().matrix());
  }
  [[nodiscard]] static o3d::t::geometry::Image image(const DepthImage& depth) {
    return o3d::t::geometry::Image{
        o3d::core::Tensor{depth.pixels(), {depth.height(), depth.width(), 1}, o3d::core::Float32}};
  }
  [[nodiscard]] o3d::core::Tensor blocks(const o3d::t::geometry::Image& depth, const o3d::core::Tensor& pose) {
    return grid.GetUniqueBlockCoordinates(depth, intrinsic, pose, 1.0F, max_range(), truncation_vox);
  }
  [[nodiscard]] float max_range() const { return static_cast<float>(camera.max_range_m); }
};

Open3dGrid::Open3dGrid(const PinholeCamera& camera, double voxel_size_m, double truncation_vox) {
  o3d::utility::SetVerbosityLevel(o3d::utility::VerbosityLevel::Error);
  Eigen::Matrix3d K;
  K << camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0;
  impl_.reset(new Impl{camera,
                       static_cast<float>(truncation_vox),
                       o3d::core::eigen_converter::EigenMatrixToTensor(K),
                       {{"tsdf", "weight"},
                        {o3d::core::Float32, o3d::core::Float32},
                        {{1}, {1}},
                        static_cast<float>(voxel_size_m),
                        8,
                        60000,
                        o3d::core::Device{"CPU:0"}}});
}
Open3dGrid::~Open3dGrid() = default;

void Open3dGrid::integrate(const DepthImage& depth, const Pose& T_world_camera) {
  const auto image = Impl::image(depth);
  const auto pose = impl_->extrinsic(T_world_camera);
  impl_->grid.Integrate(impl_->blocks(image, pose), image, impl_->intrinsic, pose, 1.0F, impl_->max_range(),
                        impl_->truncation_vox);
}

DepthImage Open3dGrid::raycast(const DepthImage& depth_there, const Pose& T_world_camera) {
  const auto pose = impl_->extrinsic(T_world_camera);
  const auto blocks = impl_->blocks(Impl::image(depth_there), pose);
  auto cast = impl_->grid.RayCast(blocks, impl_->intrinsic, pose, impl_->camera.width, impl_->camera.height,
                                  {"depth", "normal"}, 1.0F, static_cast<float>(impl_->camera.min_range_m),
                                  impl_->max_range(), 1.0F, impl_->truncation_vox);
  return {impl_->camera.width, impl_->camera.height, cast["depth"].ToFlatVector<float>()};
}

}  // namespace saccade::bench
