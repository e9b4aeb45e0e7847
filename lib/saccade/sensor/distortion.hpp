// SPDX-License-Identifier: Apache-2.0
#pragma once
// Distortion: Brown–Conrady lens model; Undistorter: images of a real lens → images of the ideal pinhole camera.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Brown–Conrady coefficients in the order of OpenCV and ROS ("plumb bob"): with r² = x² + y² on the plane z = 1,
/// x' = x·(1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²), y' likewise with p1 and p2 exchanged.
struct Distortion {
  double k1{0.0};
  double k2{0.0};
  double p1{0.0};
  double p2{0.0};
  double k3{0.0};

  /// Ideal point (x, y) on the plane z = 1 → where the lens puts it.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  /// The inverse, by Newton's method to 1e-12; nullopt beyond the radius up to which the model is one to one.
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;
  /// Tells whether the model is one to one at this ideal point (its Jacobian is positive there and on the way to it).
  [[nodiscard]] bool regular_at(const Eigen::Vector2d& ideal) const;

  [[nodiscard]] bool is_zero() const { return *this == Distortion{}; }
  /// invalid_argument for NaN or infinity.
  [[nodiscard]] Status validate() const;
  [[nodiscard]] bool operator==(const Distortion&) const = default;
};

/// Precomputed map from each pixel of the ideal camera to the raw image; the same intrinsics on either side. Raw and
/// ideal pixels lie on the same ray, so depth along z keeps its value. const methods are thread-safe.
class Undistorter {
 public:
  /// invalid_argument for a bad camera or distortion. O(pixels).
  [[nodiscard]] static Result<Undistorter> create(const PinholeCamera& camera, const Distortion& distortion);

  /// Nearest raw pixel, so that depths of two surfaces never blend; 0 where the raw image has nothing.
  /// size_mismatch unless the image has the camera's size.
  [[nodiscard]] Result<DepthImage> undistort(const DepthImage& raw) const;
  /// Bilinear; black where the raw image has nothing.
  [[nodiscard]] Result<ColorImage> undistort(const ColorImage& raw) const;

 private:
  Undistorter(int width, int height) : source_{width, height, Eigen::Vector2f::Constant(-1e6F)} {}
  Image<Eigen::Vector2f> source_;  ///< raw image coordinates of each ideal pixel; far outside where there is none
};

}  // namespace saccade
