// SPDX-License-Identifier: Apache-2.0
#pragma once
// Projective point-to-plane ICP of a depth image against the map's ray cast.

#include <array>
#include <optional>
#include <string>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/sensor/point_image.hpp"

namespace saccade {

struct IcpConfig {
  std::array<int, 3> strides{4, 2, 1};      ///< levels, coarse to fine: every n-th pixel of every n-th row
  std::array<int, 3> iterations{10, 6, 4};  ///< limit per level
  double max_distance_m{0.10};              ///< pairs farther apart are rejected
  double max_normal_angle_rad{0.6};         ///< pairs with a larger angle between normals are rejected
  double converged_m{2e-5};        ///< a level ends when a step moves and turns (in rad) less than this · stride
  double min_inlier_share{0.25};   ///< lost: a smaller share of the measured pixels found a partner
  double min_agreement{0.78};      ///< lost: a smaller share of the measured pixels in front of the map's surface lie
                                   ///< at its depth
  double max_rmse_m{0.03};         ///< lost: the weighted residual stays above
  double max_translation_m{0.20};  ///< lost: the camera moved farther from the start
  double max_rotation_rad{0.35};   ///< lost: the camera turned farther from the start
  double min_constraint{1e-5};     ///< lost: smaller ratio of smallest to largest eigenvalue of the normal equations

  [[nodiscard]] Status validate() const;
};

struct IcpResult {
  Pose T_model_camera{Pose::Identity()};  ///< pose of the depth image relative to the model's camera
  bool converged{false};                  ///< false: lost, for the reason in `why`
  std::string why;
  int iterations{0};
  double inlier_share{0.0};  ///< pairs / measured pixels, at the finest level
  double agreement{0.0};     ///< share at the model's depth, among measured pixels where the model has a surface
  double constraint{0.0};    ///< smallest over largest eigenvalue of the normal equations, rotations in arcs of a metre
  double rmse_m{0.0};        ///< root mean square of the point-to-plane distances
};

/// Aligns measured points to a surface seen by the same camera from a known pose. Thesis §2.2.1 "Camera tracking".
/// Pairs by projection into the model; minimises point-to-plane distances, weighted by the depth noise (growing with
/// z²) and a Huber loss, with Gauss–Newton steps on SE(3).
/// Even at a wrong pose ICP finds planes to slide on, and a quarter to a half of the pixels have partners. The decisive
/// measure is the share of the others that contradict the model (agreement), rather than meet space without a surface.
/// @param T_model_camera_start first guess.
/// A failed alignment is a result (converged = false), not an error.
/// O(pixels · iterations). Sums run in fixed lanes and chunks: neither threads nor simd_target() change a bit of the
/// result.
[[nodiscard]] IcpResult align(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                              const Pose& T_model_camera_start, const Executor& executor, const IcpConfig& config = {});

}  // namespace saccade
