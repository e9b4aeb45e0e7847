// SPDX-License-Identifier: Apache-2.0
#pragma once
// Alignment of an RGB-D frame to a surface with grey values: ICP with a photometric term.

#include "saccade/core/executor.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/tracking/icp.hpp"

namespace saccade {

struct RgbdConfig {
  /// Strides of both are powers of two. `far` comes first, on small images and with pairs far apart, so that fast
  /// motion is followed; its limits for lost frames do not count.
  IcpConfig far{.strides = {16, 8, 4},
                .iterations = {10, 10, 10},
                .max_distance_m = 0.20,
                .max_normal_angle_rad = 0.9,
                .converged_m = 1e-4};
  bool looks_far{true};  ///< whether `far` comes first at all
  IcpConfig icp{.iterations = {10, 8, 6}};
  double color_sigma{5.0};        ///< standard deviation of the difference of grey values, of 0 to 255
  double color_weight{4.0};       ///< weight of the photometric term beside the geometric one; 0: ICP alone
  double far_color_weight{1.0};   ///< the same, in `far`
  int finest_color_stride{1};     ///< levels finer than this take the grey values of this one
  double min_color_overlap{0.2};  ///< colours are left out where a smaller share of the pairs has them

  [[nodiscard]] Status validate() const;
};

/// Points with grey values; z of both is along the same camera's axis.
struct GreyPoints {
  PointImage points;
  Image<float> grey;  ///< 0 to 255, 0: unknown; empty: the frame has no colours
};

struct RgbdResult {
  IcpResult icp;                ///< measures of the geometric term at the pose that both terms found
  bool used_color{false};       ///< whether the photometric term took part
  double color_agreement{0.0};  ///< share of the compared pixels whose grey values differ by less than two color_sigma
  double gain{1.0};             ///< grey of the model over measured grey
};

/// Aligns measured points to a surface seen by the same camera from a known pose, as align() does, with the grey values
/// of both: Gauss–Newton steps on the sum of the point-to-plane distances and the differences between grey values
/// (Kerl, Sturm and Cremers, IROS 2013; Whelan et al., ICRA 2013), each weighted by its noise and a Huber loss. Grey
/// values are compared on a pyramid. A gain between the two exposures is estimated along. Without grey values on either
/// side this is align().
/// @param T_model_camera_start first guess.
/// A failed alignment is a result (icp.converged = false), not an error. O(pixels · iterations). Neither threads nor
/// simd_target() change a bit of the result.
[[nodiscard]] RgbdResult align_rgbd(const GreyPoints& measured, const GreyPoints& model, const PinholeCamera& camera,
                                    const Pose& T_model_camera_start, const Executor& executor,
                                    const RgbdConfig& config = {});

}  // namespace saccade
