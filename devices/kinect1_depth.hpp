// SPDX-License-Identifier: Apache-2.0
#pragma once
// Geometry that a Kinect v1 stores: ZeroPlane (raw depth to millimetres, focal length of its infrared camera) and
// focal_of_color_px, for the colour camera.

#include <cmath>
#include <cstdint>

namespace saccade::devices {

/// Reference plane of the projected pattern, from the device's memory. The values here are the nominal ones.
struct ZeroPlane {
  double base_cm{7.5};        ///< from the projector to the infrared camera
  double distance_cm{120.0};  ///< from the infrared camera to that plane
  double pixel_cm{0.1042};    ///< size of an infrared pixel (sensor 1280 wide) on the plane
  double shift{200.0};        ///< offset that the device adds to the shift of the pattern, pixels

  /// Returns the focal length of the 640 x 480 depth image.
  [[nodiscard]] double focal_px() const { return distance_cm / (2.0 * pixel_cm); }

  /// Converts the device's 11 bits, quarters of a pixel, by triangulation; 0: nothing seen.
  [[nodiscard]] std::uint16_t millimetres(std::uint16_t raw) const {
    if (raw >= 2047) return 0;
    const double moved_cm = pixel_cm * ((raw - 4.0 * shift) / 4.0 - 0.375);
    const double z_mm = 10.0 * distance_cm * base_cm / (base_cm - moved_cm);
    return moved_cm < base_cm && z_mm < 65534.0 ? static_cast<std::uint16_t>(z_mm + 0.5) : std::uint16_t{0};
  }
};

constexpr int kKinectWidth{640};
constexpr int kKinectHeight{480};

/// Returns the focal length of the colour image, which registered depth shares: registration scales rows of the depth
/// image by the ratio of the two. Its table has a column and a row of the colour image for each pixel of depth. Only
/// rows in the middle of the image are used, where distortion is small.
inline double focal_of_color_px(double depth_focal_px, const std::int32_t (*table)[2]) {
  double spread = 0.0;
  int rows = 0;
  for (int column = 200; column < 440; ++column) {
    for (int row = 100; row < 240; ++row) {
      spread += table[(row + 140) * kKinectWidth + column][1] - table[row * kKinectWidth + column][1];
      rows += 140;
    }
  }
  return depth_focal_px * spread / rows;
}

}  // namespace saccade::devices
