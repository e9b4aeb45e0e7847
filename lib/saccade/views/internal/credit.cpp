// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/credit.hpp"

#include <algorithm>

namespace saccade {
namespace {

bool in_picture(const Eigen::Vector3d& p_camera, const PinholeCamera& camera) {
  if (p_camera.z() < camera.min_range_m || p_camera.z() > camera.max_range_m) return false;
  const double u = camera.fx * p_camera.x() / p_camera.z() + camera.cx;
  const double v = camera.fy * p_camera.y() / p_camera.z() + camera.cy;
  return u >= -0.5 && u < camera.width - 0.5 && v >= -0.5 && v < camera.height - 0.5;
}

}  // namespace

Credit::Credit(std::span<const CheckedView> checked, const PinholeCamera& sensor, const StateVolume& volume,
               double through_m)
    : sensor_{sensor}, volume_{&volume}, through_m_{through_m} {
  for (const CheckedView& view : checked) {
    if (view.kept_share >= kKept) continue;
    broken_.push_back({view.T_world_camera.inverse(Eigen::Isometry), view.T_world_camera.translation(),
                       std::clamp(view.kept_share, 0.0, 1.0)});
  }
  constexpr std::size_t kMost{64};
  if (broken_.size() > kMost) broken_.erase(broken_.begin(), broken_.end() - kMost);
}

Credit::InSight Credit::seen_from(std::size_t voxel) const {
  const Eigen::Vector3d p = voxel_center(volume_->voxel(voxel), volume_->voxel_size_m());
  InSight seen{0};
  for (std::size_t i = 0; i < broken_.size(); ++i) {
    const Broken& view = broken_[i];
    if (!in_picture(view.T_camera_world * p, sensor_)) continue;
    if (volume_->is_visible(voxel, view.center_m, through_m_)) seen |= InSight{1} << i;
  }
  return seen;
}

double Credit::of(const Eigen::Vector3d& place_m, InSight seen_from, const Eigen::Vector3d& camera_m) const {
  double credit{1.0};
  if (seen_from == 0) return credit;
  const Eigen::Vector3d towards = (camera_m - place_m).normalized();
  for (std::size_t i = 0; i < broken_.size(); ++i) {
    if ((seen_from >> i & 1U) == 0) continue;
    const bool from_same_side = (broken_[i].center_m - place_m).normalized().dot(towards) >= kSameSide;
    credit *= from_same_side ? broken_[i].kept_share : kElsewhere + (1.0 - kElsewhere) * broken_[i].kept_share;
  }
  return credit;
}

}  // namespace saccade
