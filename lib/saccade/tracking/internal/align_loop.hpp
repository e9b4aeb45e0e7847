// SPDX-License-Identifier: Apache-2.0
#pragma once
// align_by: the steps of ICP around any linearisation.

#include <functional>

#include "saccade/tracking/icp.hpp"
#include "saccade/tracking/internal/alignment.hpp"

namespace saccade {

/// Sums the normal equations at a pose over every stride-th pixel of every stride-th row.
using Linearization = std::function<Result<NormalEquations>(const Pose& T_model_camera, int stride)>;

/// Aligns as saccade::align does, by this linearisation. Answers its errors.
[[nodiscard]] Result<IcpResult> align_by(const Linearization& linearize, const PointImage& measured,
                                         const PointImage& model, const PinholeCamera& camera,
                                         const Pose& T_model_camera_start, const IcpConfig& config);

}  // namespace saccade
