// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lens: the camera of a CameraInfo, and removal of its distortion from images.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace saccade::ros1 {

/// The needed fields of a sensor_msgs/CameraInfo.
struct CalibratedCamera {
  int width{0};
  int height{0};
  std::string model;  ///< "plumb_bob"
  std::vector<double> D;
  std::array<double, 9> K{};
  std::array<double, 12> P{};
};

class Lens {
 public:
  /// @param rectified the images are already undistorted: P describes them, where it is given, instead of K and D.
  /// Throws an error text.
  Lens(const CalibratedCamera& camera, bool rectified);
  ~Lens();

  [[nodiscard]] double fx() const { return fx_; }
  [[nodiscard]] double fy() const { return fy_; }
  [[nodiscard]] double cx() const { return cx_; }
  [[nodiscard]] double cy() const { return cy_; }
  /// Tells whether images must be undistorted.
  [[nodiscard]] bool bends() const { return map_ != nullptr; }
  /// Undistorts depth by the nearest pixel, so that two surfaces never blend.
  void undistort(std::vector<float>& depth) const;
  /// Undistorts colour bilinearly, three bytes per pixel.
  void undistort(std::string& rgb) const;

 private:
  struct Map;
  int width_, height_;
  double fx_{0.0}, fy_{0.0}, cx_{0.0}, cy_{0.0};
  std::unique_ptr<Map> map_;
};

}  // namespace saccade::ros1
