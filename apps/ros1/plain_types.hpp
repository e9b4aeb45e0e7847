// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion between the plain types of kinfu_types.hpp and the library's. C++20.

#include "kinfu_types.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::ros1 {

[[nodiscard]] inline Eigen::Vector3d to_vector(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }
[[nodiscard]] inline Box to_box(const PlainBox& box) { return {to_vector(box.min), to_vector(box.max)}; }
[[nodiscard]] inline Sphere to_sphere(const PlainSphere& sphere) { return {to_vector(sphere.center), sphere.radius}; }

[[nodiscard]] inline Eigen::Affine3d to_affine(const PlainPose& pose) {
  Eigen::Affine3d T = Eigen::Affine3d::Identity();
  for (int i = 0; i < 9; ++i) T.linear()(i / 3, i % 3) = pose.linear[static_cast<std::size_t>(i)];
  T.translation() = to_vector(pose.translation);
  return T;
}
/// Answers invalid_argument unless it is rigid.
[[nodiscard]] inline Result<Pose> to_pose(const PlainPose& pose) { return pose_from_matrix(to_affine(pose).matrix()); }

[[nodiscard]] inline PlainPose to_plain(const Pose& T) {
  PlainPose pose;
  for (int i = 0; i < 9; ++i) pose.linear[static_cast<std::size_t>(i)] = T.linear()(i / 3, i % 3);
  for (int i = 0; i < 3; ++i) pose.translation[static_cast<std::size_t>(i)] = T.translation()[i];
  return pose;
}

[[nodiscard]] inline PinholeCamera to_camera(const PlainCamera& camera, double min_range_m, double max_range_m) {
  return {static_cast<int>(camera.width),
          static_cast<int>(camera.height),
          camera.fx,
          camera.fy,
          camera.cx,
          camera.cy,
          min_range_m,
          max_range_m};
}

}  // namespace saccade::ros1
