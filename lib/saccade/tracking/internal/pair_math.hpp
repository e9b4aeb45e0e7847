// SPDX-License-Identifier: Apache-2.0
#pragma once
// pair_products: the terms of one pixel in the normal equations of ICP, in the operations of icp_kernels.cpp and their
// order, so that every back end gives the same bits.

#include <cmath>

#include "saccade/core/host_device.hpp"
#include "saccade/tracking/internal/icp_kernels.hpp"

namespace saccade {

/// Terms of a pixel: the 27 products of PairSums, then the squared residual.
constexpr int kPairTerms{PairSums::kProducts + 1};

/// A measured point's depth and normal.
struct MeasuredPoint {
  float z;
  float nx;
  float ny;
  float nz;
};

namespace pair_math {
[[nodiscard]] SACCADE_HD inline float dot(float ax, float ay, float az, float bx, float by, float bz) {
  return (ax * bx + ay * by) + az * bz;
}

/// Weight of a pair in 1/mm²: depth noise times Huber's loss.
[[nodiscard]] SACCADE_HD inline float weight_of(float depth, float residual) {
  const float over = depth - DepthSigma::kFrom_m;
  const float beyond = over > 0.0F ? over : 0.0F;
  const float sigma = DepthSigma::kNearest_m + DepthSigma::kGrowth_per_m * (beyond * beyond);
  const float linear = std::fabs(residual) * (1.0F / kHuberSigmas);
  const float linear_from = sigma > linear ? sigma : linear;
  return 1e-6F / (sigma * linear_from);
}
}  // namespace pair_math

/// Pairs the point of the level's pixel (column, row) with the model by projection. Returns false, and leaves the
/// terms, where it has no partner.
[[nodiscard]] SACCADE_HD inline bool pair_products(const PairingTask& task, int column, int row,
                                                   const MeasuredPoint& measured, float (&terms)[kPairTerms]) {
  using pair_math::dot;
  const float z = measured.z;
  const float ray_x =
      (static_cast<float>(column) * static_cast<float>(task.measured.stride) - task.cx) * task.inverse_fx;
  const float ray_y = (static_cast<float>(row * task.measured.stride) - task.cy) * task.inverse_fy;
  const float x_camera = ray_x * z;
  const float y_camera = ray_y * z;
  const auto& R = task.R;
  const float px = dot(R[0], R[1], R[2], x_camera, y_camera, z) + task.t[0];
  const float py = dot(R[3], R[4], R[5], x_camera, y_camera, z) + task.t[1];
  const float pz = dot(R[6], R[7], R[8], x_camera, y_camera, z) + task.t[2];
  if (!(z > 0.0F && pz > kMinModelDepth_m)) return false;

  const float inverse_z = 1.0F / pz;
  const float u = (px * inverse_z) * task.fx + (task.cx + 0.5F);
  const float v = (py * inverse_z) * task.fy + (task.cy + 0.5F);
  const bool inside =
      u >= 0.0F && u < static_cast<float>(task.model.width) && v >= 0.0F && v < static_cast<float>(task.model.height);
  if (!inside) return false;
  const auto model_column = static_cast<int>(u);
  const auto model_row = static_cast<int>(v);
  const int index = model_row * task.model.width + model_column;

  const float qz = task.model.z[index];
  const float dx = px - ((static_cast<float>(model_column) - task.cx) * task.inverse_fx) * qz;
  const float dy = py - ((static_cast<float>(model_row) - task.cy) * task.inverse_fy) * qz;
  const float dz = pz - qz;
  if (!(qz > 0.0F && dot(dx, dy, dz, dx, dy, dz) <= task.max_squared_distance_m2)) return false;

  const float nx = task.model.nx[index];
  const float ny = task.model.ny[index];
  const float nz = task.model.nz[index];
  const float cosine = dot(dot(R[0], R[3], R[6], nx, ny, nz), dot(R[1], R[4], R[7], nx, ny, nz),
                           dot(R[2], R[5], R[8], nx, ny, nz), measured.nx, measured.ny, measured.nz);
  if (!(cosine > task.min_normal_cosine)) return false;

  const float r = dot(nx, ny, nz, dx, dy, dz);
  const float w = pair_math::weight_of(z, r);
  const float jacobian[7]{py * nz - pz * ny, pz * nx - px * nz, px * ny - py * nx, nx, ny, nz, r};
  int term{0};
  for (int i = 0; i < 6; ++i) {
    const float weighted = w * jacobian[i];
    for (int j = i; j < 7; ++j) terms[term++] = weighted * jacobian[j];
  }
  terms[term] = r * r;
  return true;
}

}  // namespace saccade
