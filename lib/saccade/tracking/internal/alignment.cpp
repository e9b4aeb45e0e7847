// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace saccade {
namespace {

/// Adds up the lanes of one chunk, in order.
NormalEquations total(const PairSums& sums) {
  NormalEquations equations = equations_of(sums.products);
  equations.squared_residuals = sum_of_lanes(sums.squared_residuals);
  equations.pairs = sums.pairs;
  return equations;
}

LevelPoints all_points(const PointImage& image) {
  return {image.z.data(), image.nx.data(), image.ny.data(), image.nz.data(), image.z.width(), image.z.height(), 1};
}

Image<float> every(const Image<float>& from, int stride, int width, int height) {
  Image<float> to{width, height};
  for (int v = 0; v < height; ++v) {
    const float* row = from.row(v * stride);
    float* out = to.row(v);
    for (int u = 0; u < width; ++u) out[u] = row[u * stride];
  }
  return to;
}

}  // namespace

double sum_of_lanes(const std::array<float, kPairLanes>& lanes) {
  double sum{0.0};
  for (const float lane : lanes) sum += static_cast<double>(lane);
  return sum;
}

NormalEquations equations_of(const PairProducts& products) {
  NormalEquations equations;
  std::size_t product{0};
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) equations.JtJ(j, i) = sum_of_lanes(products[product++]);
    equations.Jtr(i) = sum_of_lanes(products[product++]);
  }
  return equations;
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  JtJ += other.JtJ;
  Jtr += other.Jtr;
  squared_residuals += other.squared_residuals;
  pairs += other.pairs;
  return *this;
}

Level::Level(const PointImage& image, int stride) : points_{all_points(image)} {
  if (stride == 1) return;
  points_.stride = stride;
  points_.width = (image.z.width() + stride - 1) / stride;
  points_.height = (image.z.height() + stride - 1) / stride;
  points_.z = (z_ = every(image.z, stride, points_.width, points_.height)).data();
  points_.nx = (nx_ = every(image.nx, stride, points_.width, points_.height)).data();
  points_.ny = (ny_ = every(image.ny, stride, points_.width, points_.height)).data();
  points_.nz = (nz_ = every(image.nz, stride, points_.width, points_.height)).data();
}

std::size_t Level::measured() const {
  const auto count = static_cast<std::ptrdiff_t>(points_.width) * points_.height;
  return static_cast<std::size_t>(std::count_if(points_.z, points_.z + count, [](float z) { return z > 0.0F; }));
}

Alignment::Alignment(const PointImage& model, const PinholeCamera& camera, const PairLimits& limits) {
  task_.model = all_points(model);
  task_.fx = static_cast<float>(camera.fx);
  task_.fy = static_cast<float>(camera.fy);
  task_.cx = static_cast<float>(camera.cx);
  task_.cy = static_cast<float>(camera.cy);
  task_.inverse_fx = static_cast<float>(1.0 / camera.fx);
  task_.inverse_fy = static_cast<float>(1.0 / camera.fy);
  task_.max_squared_distance_m2 = static_cast<float>(limits.max_distance_m * limits.max_distance_m);
  task_.min_normal_cosine = static_cast<float>(std::cos(limits.max_normal_angle_rad));
}

NormalEquations Alignment::linearize(const Pose& T_model_camera, const Level& level, const Executor& executor) const {
  PairingTask task = this->task(T_model_camera);
  task.measured = level.points();
  const auto rows = static_cast<std::size_t>(task.measured.height);
  std::vector<NormalEquations> chunks((rows + kRowsPerChunk - 1) / kRowsPerChunk);
  executor.parallel_for(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    PairSums sums;
    linearize_rows(task, static_cast<int>(begin), static_cast<int>(end), sums);
    chunks[begin / kRowsPerChunk] = total(sums);
  });
  NormalEquations equations;
  for (const NormalEquations& chunk : chunks) equations += chunk;
  return equations;
}

PairingTask Alignment::task(const Pose& T_model_camera) const {
  PairingTask task = task_;
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>{task.R.data()} = T_model_camera.linear().cast<float>();
  Eigen::Map<Eigen::Vector3f>{task.t.data()} = T_model_camera.translation().cast<float>();
  return task;
}

Pose exponential(const Vector6d& x) {
  Pose T{Pose::Identity()};
  const double angle = x.head<3>().norm();
  if (angle > 0.0) T.linear() = Eigen::AngleAxisd{angle, x.head<3>() / angle}.toRotationMatrix();
  T.translation() = x.tail<3>();
  return T;
}

}  // namespace saccade
