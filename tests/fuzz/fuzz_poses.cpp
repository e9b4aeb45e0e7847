// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of pose lists; every pose it accepts must be rigid.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/io/frames/trajectory_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto entries = saccade::parse_pose_list({reinterpret_cast<const char*>(data), size});
  if (!entries) return 0;
  for (const saccade::PoseEntry& entry : *entries) {
    if (!entry.T_world_camera) continue;
    const Eigen::Matrix3d r = entry.T_world_camera->linear();
    constexpr double kRigid{1e-9};
    if (!((r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < kRigid) || !(r.determinant() > 0.0)) std::abort();
    if (!entry.T_world_camera->translation().allFinite()) std::abort();
  }
  return 0;
}
