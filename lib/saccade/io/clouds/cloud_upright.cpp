// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/cloud_upright.hpp"

#include <cmath>

namespace saccade {

UprightHints upright_hints_of(const CloudFile& file) {
  constexpr double kTurned{1e-6};
  constexpr double kUnit{1e-3};
  UprightHints hints;
  const auto* pcd = std::get_if<PcdFile>(&file.file);
  if (pcd == nullptr) return hints;
  hints.is_organized = pcd->height > 1;
  const auto& v = pcd->viewpoint;
  const Eigen::Quaterniond turn{v[3], v[4], v[5], v[6]};
  if (turn.vec().norm() > kTurned && std::abs(turn.norm() - 1.0) < kUnit) {
    hints.T_world_cameras = {Eigen::Translation3d{v[0], v[1], v[2]} * turn.normalized()};
  }
  return hints;
}

Upright upright_of(const CloudFile& file, std::span<const Eigen::Vector3f> positions_m,
                   const std::optional<Eigen::Vector3d>& up) {
  UprightHints hints = upright_hints_of(file);
  hints.up = up;
  return find_upright(positions_m, hints);
}

}  // namespace saccade
