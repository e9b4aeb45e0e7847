// SPDX-License-Identifier: Apache-2.0
#pragma once
// ColorAlignment: normal equations of the differences between measured grey values and those of a model.

#include "saccade/tracking/internal/alignment.hpp"
#include "saccade/tracking/internal/color_kernels.hpp"
#include "saccade/tracking/internal/intensity.hpp"

namespace saccade {

struct ColorEquations {
  NormalEquations sums;  ///< JtJ and Jtr alone, weights as in linearize_color_rows
  std::size_t pairs{0};
  std::size_t agreeing{0};
  double reference{0.0};  ///< sums of grey over the pairs
  double measured{0.0};
};

/// Grey values of a model and a frame, both seen by one camera, at one stride.
class ColorLevel {
 public:
  /// @param points        measured points of the level, which must outlive this
  /// @param measured_grey of the level
  /// @param model_z       depth of the model at full size
  /// @param model_grey    of the level
  ColorLevel(const LevelPoints& points, const Image<float>& measured_grey, const Image<float>& model_z,
             const Image<float>& model_grey, const PinholeCamera& camera, const Executor& executor);
  ColorLevel(const ColorLevel&) = delete;
  ColorLevel& operator=(const ColorLevel&) = delete;

  /// Sums in fixed lanes and chunks, so that threads change no bit. O(points of the level).
  [[nodiscard]] ColorEquations linearize(const Pose& T_model_camera, double gain, double sigma,
                                         const Executor& executor) const;

 private:
  ColorTask task_;
  Image<float> z_;  ///< depth of the model at the level, 0 where grey or slopes are unknown
  Slopes slopes_;
};

}  // namespace saccade
