// SPDX-License-Identifier: Apache-2.0
#pragma once
// Factory calibration of an Azure Kinect: calibration.json, which its recordings (.mkv) have attached.

#include <optional>
#include <string_view>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/io/frames/camera_io.hpp"

namespace saccade {

/// Camera of the device on its whole sensor. Lengths are in units of the sensor's width and height, from the corner.
struct AzureKinectCamera {
  double cx{0.0};
  double cy{0.0};
  double fx{0.0};
  double fy{0.0};
  Distortion lens;
  Pose T_camera_device{Pose::Identity()};  ///< metres
};

struct AzureKinectCalibration {
  AzureKinectCamera depth;
  AzureKinectCamera color;

  /// Returns intrinsics of the depth camera in the mode of images of this size: 640×576 and 320×288 (narrow), 512×512
  /// and 1024×1024 (wide). nullopt for other sizes.
  [[nodiscard]] std::optional<Intrinsics> of_depth_images(int width, int height) const;
  /// Returns intrinsics of the colour camera: its whole sensor (4:3), or the middle of it (16:9). nullopt for sizes of
  /// other shapes.
  [[nodiscard]] std::optional<Intrinsics> of_color_images(int width, int height) const;
};

/// Tells whether a JSON text is such a file.
[[nodiscard]] bool is_azure_kinect_calibration(std::string_view text);
/// Parses such a file. Answers corrupt_data where a camera or a number is missing or beyond sense; unsupported for
/// another lens model than Brown–Conrady.
[[nodiscard]] Result<AzureKinectCalibration> parse_azure_kinect_calibration(std::string_view text);

}  // namespace saccade
