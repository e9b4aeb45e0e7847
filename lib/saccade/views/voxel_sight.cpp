// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/lines_of_sight.hpp"

namespace saccade {
namespace {

class VoxelOutlook final : public Outlook {
 public:
  VoxelOutlook(const StateVolume& volume, const Eigen::Vector3d& camera_m) : volume_{&volume}, camera_m_{camera_m} {}
  [[nodiscard]] bool sees(const ExpectedPoint& point, double through_m) const override {
    return volume_->is_visible(point.voxel, camera_m_, through_m);
  }

 private:
  const StateVolume* volume_;
  Eigen::Vector3d camera_m_;
};

class VoxelSight final : public LinesOfSight {
 public:
  explicit VoxelSight(std::shared_ptr<const ExpectedSurface> surface) : surface_{std::move(surface)} {}
  [[nodiscard]] std::unique_ptr<const Outlook> from(const Eigen::Vector3d& camera_m,
                                                    std::span<const ExpectedPoint* const> /*points*/) const override {
    return std::make_unique<const VoxelOutlook>(*surface_->volume, camera_m);
  }

 private:
  std::shared_ptr<const ExpectedSurface> surface_;
};

}  // namespace

std::shared_ptr<const LinesOfSight> voxel_sight(std::shared_ptr<const ExpectedSurface> surface) {
  return std::make_shared<const VoxelSight>(std::move(surface));
}

}  // namespace saccade
