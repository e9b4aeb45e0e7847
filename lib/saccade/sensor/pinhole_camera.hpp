// SPDX-License-Identifier: Apache-2.0
#pragma once
// PinholeCamera: intrinsics, image size and range limits; presets; scaling; widening for the tilt of the sensor.

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Pinhole camera. Optical frame: x right, y down, z forward. The centre of pixel (u, v) has image coordinates (u, v),
/// so the image covers [-0.5, width - 0.5) × [-0.5, height - 0.5). No distortion: see Distortion.
struct PinholeCamera {
  int width{640};
  int height{480};
  double fx{525.0};         ///< pixels
  double fy{525.0};         ///< pixels
  double cx{319.5};         ///< pixels
  double cy{239.5};         ///< pixels
  double min_range_m{0.4};  ///< along z; nearer returns are not trusted
  double max_range_m{6.0};  ///< along z; farther returns are not trusted

  /// Answers invalid_argument for sizes, focal lengths, principal points and ranges that no camera has, such as NaN.
  [[nodiscard]] Status validate() const;

  /// Returns the direction through image point (u, v), scaled to z = 1.
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }
  /// Returns the image point of p_camera. Expects p_camera.z() > 0.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    return {fx * p_camera.x() / p_camera.z() + cx, fy * p_camera.y() / p_camera.z() + cy};
  }

  /// Returns the camera with another image size in pixels; field of view and range stay.
  [[nodiscard]] PinholeCamera scaled_to(int new_width, int new_height) const;
  /// Returns the camera with `new_width` ≥ 1 pixels across and the nearest whole number of them down.
  [[nodiscard]] PinholeCamera scaled_to_width(int new_width) const;

  [[nodiscard]] bool operator==(const PinholeCamera&) const = default;
};

/// Named presets: "kinect-v1" (640×480, f = 525, 0.5–6 m as in the thesis), "kinect-v2" (512×424, f = 365.5),
/// "xtion", "realsense".
struct CameraPreset {
  std::string_view name;
  PinholeCamera camera;
};
[[nodiscard]] const std::vector<CameraPreset>& camera_presets();
/// Answers not_found with the known names in the message.
[[nodiscard]] Result<PinholeCamera> camera_preset(std::string_view name);

/// Returns the camera widened by a tilt of ±tilt_rad about its x axis (thesis §2.2): equal focal lengths, more rows
/// above and below, so that the vertical field of view grows by tilt_rad on either side. Range limits are kept.
[[nodiscard]] PinholeCamera widened_vertically(const PinholeCamera& camera, double tilt_rad);

}  // namespace saccade
