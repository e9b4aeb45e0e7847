// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/pinhole_camera.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "saccade/core/angle.hpp"

namespace saccade {

Status PinholeCamera::validate() const {
  const auto fail = [](std::string what) { return Error{Errc::invalid_argument, std::move(what), "camera"}; };
  constexpr int kMaxSize{1 << 14};
  if (width <= 0 || height <= 0 || width > kMaxSize || height > kMaxSize) {
    return fail("image size must be within 1 and " + std::to_string(kMaxSize) + ", not " + std::to_string(width) + "x" +
                std::to_string(height));
  }
  if (!std::isfinite(fx) || !std::isfinite(fy) || fx <= 0.0 || fy <= 0.0) return fail("focal lengths must be positive");
  constexpr double kMaxRatio{1000.0};  // focal length divided by image size; fields of view from 0.06° to 179.9°
  const auto sensible = [](double f, int size) { return f * kMaxRatio >= size && f <= size * kMaxRatio; };
  if (!sensible(fx, width) || !sensible(fy, height)) {
    return fail("focal lengths must be from a thousandth of the image's size to a thousand times it, pixels");
  }
  if (!std::isfinite(cx) || !std::isfinite(cy)) return fail("the principal point must be finite");
  if (!(std::abs(cx) <= width * kMaxRatio && std::abs(cy) <= height * kMaxRatio)) {
    return fail("the principal point must be within a thousand image sizes of the corner, pixels");
  }
  if (!(min_range_m >= 0.0) || !(max_range_m > min_range_m) || !std::isfinite(max_range_m)) {
    return fail("ranges must satisfy 0 <= min < max");
  }
  constexpr double kMaxRange_m{1e6};
  if (max_range_m > kMaxRange_m) return fail("the maximum range must be at most a million metres");
  return {};
}

PinholeCamera PinholeCamera::scaled_to(int new_width, int new_height) const {
  const double across = static_cast<double>(new_width) / width;
  const double down = static_cast<double>(new_height) / height;
  return {new_width,   new_height, fx * across, fy * down, (cx + 0.5) * across - 0.5, (cy + 0.5) * down - 0.5,
          min_range_m, max_range_m};
}

PinholeCamera PinholeCamera::scaled_to_width(int new_width) const {
  SACCADE_EXPECTS(new_width >= 1);
  const double scale = static_cast<double>(new_width) / width;
  return scaled_to(new_width, std::max(1, static_cast<int>(std::lround(height * scale))));
}

const std::vector<CameraPreset>& camera_presets() {
  static const std::vector<CameraPreset> presets{
      {"kinect-v1", {640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 6.0}},
      {"kinect-v2", {512, 424, 365.5, 365.5, 255.5, 211.5, 0.5, 4.5}},
      {"xtion", {640, 480, 570.3, 570.3, 319.5, 239.5, 0.8, 3.5}},
      {"realsense", {640, 480, 615.0, 615.0, 319.5, 239.5, 0.2, 4.0}},
  };
  return presets;
}

Result<PinholeCamera> camera_preset(std::string_view name) {
  for (const CameraPreset& preset : camera_presets()) {
    if (preset.name == name) return preset.camera;
  }
  const std::string known = joined(camera_presets(), ", ", &CameraPreset::name);
  return Error{Errc::not_found, "no camera preset '" + std::string{name} + "'; known: " + known, {}};
}

PinholeCamera widened_vertically(const PinholeCamera& camera, double tilt_rad) {
  SACCADE_EXPECTS(tilt_rad >= 0.0);
  // Half fields of view above and below the optical axis, each enlarged by the tilt.
  const double up_rad = std::atan((camera.cy + 0.5) / camera.fy) + tilt_rad;
  const double down_rad = std::atan((camera.height - 0.5 - camera.cy) / camera.fy) + tilt_rad;
  SACCADE_EXPECTS(up_rad < 90_deg && down_rad < 90_deg);
  const int added_above = static_cast<int>(std::lround(camera.fy * std::tan(up_rad) - (camera.cy + 0.5)));
  const int added_below =
      static_cast<int>(std::lround(camera.fy * std::tan(down_rad) - (camera.height - 0.5 - camera.cy)));
  PinholeCamera wide{camera};
  wide.height += added_above + added_below;
  wide.cy += added_above;
  return wide;
}

}  // namespace saccade
