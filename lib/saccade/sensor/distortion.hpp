// SPDX-License-Identifier: Apache-2.0
#pragma once
// Distortion: Brown–Conrady lens model; Undistorter: images of a real lens → images of the ideal pinhole camera.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Brown–Conrady coefficients in the order of OpenCV and ROS: with r² = x² + y² on the plane z = 1,
/// x' = x·(1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶) + 2 p1 x y + p2 (r² + 2 x²), y' likewise with p1
/// and p2 exchanged. The first five are the "plumb bob" model, all eight the "rational polynomial" one.
struct Distortion {
  double k1{0.0};
  double k2{0.0};
  double p1{0.0};
  double p2{0.0};
  double k3{0.0};
  double k4{0.0};
  double k5{0.0};
  double k6{0.0};

  /// Number of coefficients that OpenCV and ROS write.
  static constexpr std::size_t kMaxCoefficients{8};
  /// Makes a lens of up to eight coefficients in this order; those left out are 0. nullopt where one beyond the eighth
  /// is not 0 (a thin prism, a tilted sensor).
  [[nodiscard]] static std::optional<Distortion> from_coefficients(std::span<const double> coefficients);

  /// Ideal point (x, y) on the plane z = 1 → where the lens puts it.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  /// The inverse, by Newton's method to 1e-12; nullopt beyond the radius up to which the model is one to one.
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;
  /// Tells whether the model is one to one at this ideal point (its Jacobian is positive there and on the way to it).
  [[nodiscard]] bool regular_at(const Eigen::Vector2d& ideal) const;
  /// Returns a radius on the plane z = 1 within which the model is one to one in every direction, at most 4. O(1), but
  /// thousands of operations.
  [[nodiscard]] double regular_radius() const;

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
