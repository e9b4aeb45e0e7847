// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ellipsoid, fitted_ellipsoids, Ellipse, projected: ellipsoids around clusters of points, and their outlines in an
// image.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

struct Ellipsoid {
  Eigen::Vector3d center{Eigen::Vector3d::Zero()};
  /// Shape matrix: p is inside where (p − center)ᵀ shape⁻¹ (p − center) ≤ 1; square metres.
  Eigen::Matrix3d shape{Eigen::Matrix3d::Identity()};
};

/// Fits ellipsoids to clusters of points: k-means from the cells of a lattice of cell_m, then for each cluster the mean
/// and kSpread² times the covariance, enlarged by a cube of point_m around each point. O(points · clusters nearby). In
/// the order of the cells.
[[nodiscard]] std::vector<Ellipsoid> fitted_ellipsoids(std::span<const Eigen::Vector3d> points, double cell_m,
                                                       double point_m);
constexpr double kSpread{2.0};  ///< semi-axes in standard deviations, which gives the outline of a uniform disc

/// Outline of an ellipsoid in an image.
struct Ellipse {
  Eigen::Matrix3d conic{Eigen::Matrix3d::Identity()};  ///< (u, v, 1) conic (u, v, 1)ᵀ is negative inside
  int u_begin{0};                                      ///< pixels around it, within the image
  int u_end{0};
  int v_begin{0};
  int v_end{0};
  double depth_m{0.0};  ///< depth of the ellipsoid's centre

  [[nodiscard]] bool contains(int u, int v) const {
    const Eigen::Vector3d x{static_cast<double>(u), static_cast<double>(v), 1.0};
    return x.dot(conic * x) <= 0.0;
  }
};
/// Projects an ellipsoid; nullopt where it lies outside the image or the range, or reaches behind the camera.
[[nodiscard]] std::optional<Ellipse> projected(const Ellipsoid& ellipsoid, const Pose& T_camera_world,
                                               const PinholeCamera& camera);

}  // namespace saccade
