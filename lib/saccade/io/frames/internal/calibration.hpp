// SPDX-License-Identifier: Apache-2.0
#pragma once
// Calibrations that layouts of recordings have of their own: YAML of OpenCV, info.txt of BundleFusion and ScanNet, and
// scene_camera.json of BOP.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/io/frames/camera_io.hpp"

namespace saccade {

/// Parses YAML that OpenCV writes: camera_matrix, and where they are there distortion_coefficients (up to eight),
/// image_width, image_height. Answers corrupt_data with the line; unsupported for other lens models.
[[nodiscard]] Result<Intrinsics> parse_opencv_camera(std::string_view text);
/// Returns local_transform of RTAB-Map's YAML, the camera on its robot, where it is there.
[[nodiscard]] Result<std::optional<Pose>> parse_local_transform(std::string_view text);

/// Cameras of an info.txt, with the scale in `depth`.
struct SensorInfo {
  Intrinsics depth;
  std::optional<Intrinsics> color;
  Pose T_color_depth{Pose::Identity()};
  bool is_depth_off_body{false};  ///< the depth camera has a pose of its own on the recording's body
};
/// Parses lines "m_name = values". Answers corrupt_data with the line; not_found without m_calibrationDepthIntrinsic.
[[nodiscard]] Result<SensorInfo> parse_sensor_info(std::string_view text);

/// Camera of one image of a BOP scene.
struct BopCamera {
  Intrinsics intrinsics;  ///< with the scale
  std::optional<Pose> T_world_camera;
};
/// Parses scene_camera.json: an entry per image, with cam_K, depth_scale (mm per sample), cam_R_w2c and cam_t_w2c (mm).
/// An entry that is unusable is kept as its error. Answers corrupt_data for other JSON.
[[nodiscard]] Result<std::map<std::int64_t, Result<BopCamera>>> parse_bop_cameras(std::string_view text);

}  // namespace saccade
