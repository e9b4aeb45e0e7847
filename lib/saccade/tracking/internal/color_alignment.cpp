// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/color_alignment.hpp"

#include <vector>

namespace saccade {

ColorLevel::ColorLevel(const LevelPoints& points, const Image<float>& measured_grey, const Image<float>& model_z,
                       const Image<float>& model_grey, const PinholeCamera& camera, const Executor& executor)
    : z_{model_grey.width(), model_grey.height()}, slopes_{slopes(model_grey, executor)} {
  SACCADE_EXPECTS(measured_grey.width() == points.width && measured_grey.height() == points.height);
  SACCADE_EXPECTS(model_grey.width() == points.width && model_grey.height() == points.height);
  for (int v = 0; v < z_.height(); ++v) {
    const float* from = model_z.row(v * points.stride);
    for (int u = 0; u < z_.width(); ++u) z_(u, v) = slopes_.known(u, v) * from[u * points.stride];
  }
  task_.measured = points;
  task_.measured_grey = measured_grey.data();
  task_.reference = {z_.data(),  model_grey.data(), slopes_.along_u.data(), slopes_.along_v.data(),
                     z_.width(), z_.height()};
  task_.fx = static_cast<float>(camera.fx);
  task_.fy = static_cast<float>(camera.fy);
  task_.cx = static_cast<float>(camera.cx);
  task_.cy = static_cast<float>(camera.cy);
  task_.inverse_fx = static_cast<float>(1.0 / camera.fx);
  task_.inverse_fy = static_cast<float>(1.0 / camera.fy);
}

ColorEquations ColorLevel::linearize(const Pose& T_model_camera, double gain, double sigma,
                                     const Executor& executor) const {
  ColorTask task = task_;
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>{task.R.data()} = T_model_camera.linear().cast<float>();
  Eigen::Map<Eigen::Vector3f>{task.t.data()} = T_model_camera.translation().cast<float>();
  task.gain = static_cast<float>(gain);
  task.sigma = static_cast<float>(sigma);
  const auto rows = static_cast<std::size_t>(task.measured.height);
  std::vector<ColorEquations> chunks((rows + kRowsPerChunk - 1) / kRowsPerChunk);
  executor.parallel_for(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    ColorSums sums;
    linearize_color_rows(task, static_cast<int>(begin), static_cast<int>(end), sums);
    chunks[begin / kRowsPerChunk] = {equations_of(sums.products), sums.pairs, sums.agreeing,
                                     sum_of_lanes(sums.reference), sum_of_lanes(sums.measured)};
  });
  ColorEquations equations;
  for (const ColorEquations& chunk : chunks) {
    equations.sums += chunk.sums;
    equations.pairs += chunk.pairs;
    equations.agreeing += chunk.agreeing;
    equations.reference += chunk.reference;
    equations.measured += chunk.measured;
  }
  return equations;
}

}  // namespace saccade
