// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/icp.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

namespace saccade {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Sums of the normal equations Σ w JᵀJ x = −Σ w Jᵀ r.
struct NormalEquations {
  Matrix6d JtJ{Matrix6d::Zero()};
  Vector6d Jtr{Vector6d::Zero()};
  double squared_residuals{0.0};
  std::size_t pairs{0};
  std::size_t measured{0};

  NormalEquations& operator+=(const NormalEquations& other) {
    JtJ += other.JtJ;
    Jtr += other.Jtr;
    squared_residuals += other.squared_residuals;
    pairs += other.pairs;
    measured += other.measured;
    return *this;
  }
};

/// Standard deviation of a structured-light depth at z: constant near, growing with z².
float depth_sigma_m(float z) {
  constexpr float kNearest{0.0012F};
  constexpr float kGrowth{0.0019F};
  constexpr float kFrom{0.4F};
  const float beyond = z > kFrom ? z - kFrom : 0.0F;
  return kNearest + kGrowth * beyond * beyond;
}

class Alignment {
 public:
  Alignment(const PointImage& measured, const PointImage& model, const PinholeCamera& camera, const IcpConfig& config,
            const Executor& executor)
      : measured_{measured}, model_{model}, camera_{camera}, config_{config}, executor_{executor} {}

  [[nodiscard]] NormalEquations linearize(const Pose& T_model_camera, int stride) const {
    const auto rows = static_cast<std::size_t>((camera_.height + stride - 1) / stride);
    constexpr std::size_t kRowsPerChunk{8};
    std::vector<NormalEquations> chunks((rows + kRowsPerChunk - 1) / kRowsPerChunk);
    executor_.parallel_for(rows, kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
      NormalEquations& sums = chunks[begin / kRowsPerChunk];
      for (std::size_t row = begin; row < end; ++row)
        add_row(T_model_camera, static_cast<int>(row) * stride, stride, sums);
    });
    NormalEquations total;
    for (const NormalEquations& chunk : chunks) total += chunk;
    return total;
  }

 private:
  void add_row(const Pose& T_model_camera, int v, int stride, NormalEquations& sums) const {
    const Eigen::Matrix3f R = T_model_camera.linear().cast<float>();
    const Eigen::Vector3f t = T_model_camera.translation().cast<float>();
    const auto fx = static_cast<float>(camera_.fx);
    const auto fy = static_cast<float>(camera_.fy);
    const auto cx = static_cast<float>(camera_.cx);
    const auto cy = static_cast<float>(camera_.cy);
    const auto max_distance = static_cast<float>(config_.max_distance_m);
    const auto min_cosine = static_cast<float>(std::cos(config_.max_normal_angle_rad));
    for (int u = 0; u < camera_.width; u += stride) {
      const Eigen::Vector3f& p_camera = measured_.points(u, v);
      if (!(p_camera.z() > 0.0F)) continue;
      ++sums.measured;
      const Eigen::Vector3f p = R * p_camera + t;
      if (!(p.z() > 1e-3F)) continue;
      const float model_u = fx * p.x() / p.z() + cx + 0.5F;
      const float model_v = fy * p.y() / p.z() + cy + 0.5F;
      if (!(model_u >= 0.0F && model_v >= 0.0F && model_u < static_cast<float>(camera_.width) &&
            model_v < static_cast<float>(camera_.height))) {
        continue;
      }
      const Eigen::Vector3f& q = model_.points(static_cast<int>(model_u), static_cast<int>(model_v));
      if (!(q.z() > 0.0F)) continue;
      const Eigen::Vector3f& n = model_.normals(static_cast<int>(model_u), static_cast<int>(model_v));
      const Eigen::Vector3f difference = p - q;
      if (difference.squaredNorm() > max_distance * max_distance) continue;
      const Eigen::Vector3f n_measured = R * measured_.normals(u, v);
      if (!(n.dot(n_measured) > min_cosine)) continue;
      add_pair(p, n, n.dot(difference), p_camera.z(), sums);
    }
  }

  static void add_pair(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float residual, float depth,
                       NormalEquations& sums) {
    const float sigma = depth_sigma_m(depth);
    constexpr float kHuber{1.5F};
    const float scaled = std::fabs(residual) / sigma;
    constexpr float kReference{1e-3F};  // so that the sums are of the order of the number of pairs
    const float weight = (kReference * kReference) / (sigma * sigma) * (scaled > kHuber ? kHuber / scaled : 1.0F);
    Vector6d J;
    J << p.cross(n).cast<double>(), n.cast<double>();
    sums.JtJ.selfadjointView<Eigen::Lower>().rankUpdate(J, weight);
    sums.Jtr += static_cast<double>(weight) * residual * J;
    sums.squared_residuals += static_cast<double>(residual) * residual;
    ++sums.pairs;
  }

  const PointImage& measured_;
  const PointImage& model_;
  const PinholeCamera& camera_;
  const IcpConfig& config_;
  const Executor& executor_;
};

/// Rotation vector and translation applied from the left.
Pose exponential(const Vector6d& x) {
  Pose T{Pose::Identity()};
  const double angle = x.head<3>().norm();
  if (angle > 0.0) T.linear() = Eigen::AngleAxisd{angle, x.head<3>() / angle}.toRotationMatrix();
  T.translation() = x.tail<3>();
  return T;
}

/// Smallest over largest eigenvalue, with rotations measured in arcs of a metre: 0 when a motion is not constrained.
double constraint(const Matrix6d& JtJ) {
  const Matrix6d full = JtJ.selfadjointView<Eigen::Lower>();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver{full, Eigen::EigenvaluesOnly};
  const double largest = solver.eigenvalues()[5];
  return largest > 0.0 ? solver.eigenvalues()[0] / largest : 0.0;
}

std::string judge(const NormalEquations& sums, const IcpResult& result, const Pose& start, const IcpConfig& config) {
  const auto percent = [](double share) { return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %"; };
  if (sums.measured == 0) return "the depth image has no valid pixel";
  if (result.inlier_share < config.min_inlier_share) {
    return "only " + percent(result.inlier_share) + " of the measured pixels agree with the map";
  }
  if (result.rmse_m > config.max_rmse_m) return "the measured surface stays off the map's";
  if (constraint(sums.JtJ) < config.min_constraint) return "the visible surface does not determine the camera's motion";
  const Pose moved = start.inverse() * result.T_model_camera;
  if (moved.translation().norm() > config.max_translation_m || rotation_angle_rad(moved) > config.max_rotation_rad) {
    return "the motion found is larger than a camera makes between two frames";
  }
  return {};
}

}  // namespace

Status IcpConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "ICP configuration"}; };
  for (std::size_t level = 0; level < strides.size(); ++level) {
    if (strides[level] < 1) return fail("strides must be at least 1");
    if (iterations[level] < 0) return fail("iterations must not be negative");
  }
  if (!(max_distance_m > 0.0) || !(max_normal_angle_rad > 0.0)) return fail("pair limits must be positive");
  if (!(max_translation_m > 0.0) || !(max_rotation_rad > 0.0)) return fail("motion limits must be positive");
  return {};
}

PointImage to_points(const DepthImage& depth, const PinholeCamera& camera, const Executor& executor) {
  SACCADE_EXPECTS(depth.width() == camera.width && depth.height() == camera.height);
  PointImage image{Image<Eigen::Vector3f>{camera.width, camera.height, Eigen::Vector3f::Zero()},
                   Image<Eigen::Vector3f>{camera.width, camera.height, Eigen::Vector3f::Zero()}};
  const auto rows = static_cast<std::size_t>(camera.height);
  executor.parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const float d = depth(u, v);
        if (!(d >= static_cast<float>(camera.min_range_m) && d <= static_cast<float>(camera.max_range_m))) continue;
        image.points(u, v) = camera.ray(u, v).cast<float>() * d;
      }
    }
  });
  // The baseline spans a few pixels: depth is quantised, and neighbouring pixels alone give steps for normals.
  constexpr int kHalfBaseline{3};
  constexpr float kLargestStep{0.03F};  // relative to depth
  const auto difference = [&](int u0, int v0, int u1, int v1, const Eigen::Vector3f& p) -> Eigen::Vector3f {
    const Eigen::Vector3f& a = image.points(u0, v0);
    const Eigen::Vector3f& b = image.points(u1, v1);
    const float limit = kLargestStep * p.z();
    const bool a_near = a.z() > 0.0F && std::fabs(a.z() - p.z()) < limit;
    const bool b_near = b.z() > 0.0F && std::fabs(b.z() - p.z()) < limit;
    if (a_near && b_near) return b - a;
    if (a_near) return p - a;
    if (b_near) return b - p;
    return Eigen::Vector3f::Zero();
  };
  executor.parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const int v0 = std::max(0, v - kHalfBaseline);
      const int v1 = std::min(camera.height - 1, v + kHalfBaseline);
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3f& p = image.points(u, v);
        if (!(p.z() > 0.0F)) continue;
        const int u0 = std::max(0, u - kHalfBaseline);
        const int u1 = std::min(camera.width - 1, u + kHalfBaseline);
        const Eigen::Vector3f n = difference(u, v0, u, v1, p).cross(difference(u0, v, u1, v, p));  // towards −z
        const float norm = n.norm();
        if (norm > 0.0F) image.normals(u, v) = n / norm;
      }
    }
  });
  return image;
}

IcpResult align(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                const Pose& T_model_camera_start, const Executor& executor, const IcpConfig& config) {
  SACCADE_EXPECTS(measured.points.width() == camera.width && measured.points.height() == camera.height);
  SACCADE_EXPECTS(model.points.width() == camera.width && model.points.height() == camera.height);
  const Alignment alignment{measured, model, camera, config, executor};
  IcpResult result;
  result.T_model_camera = T_model_camera_start;
  for (std::size_t level = 0; level < config.strides.size(); ++level) {
    for (int i = 0; i < config.iterations[level]; ++i) {
      const NormalEquations sums = alignment.linearize(result.T_model_camera, config.strides[level]);
      if (sums.pairs < 6) break;
      const Eigen::LDLT<Matrix6d> factorised{sums.JtJ.selfadjointView<Eigen::Lower>()};
      const Vector6d step = factorised.solve(-sums.Jtr);
      if (factorised.info() != Eigen::Success || !step.allFinite()) break;
      result.T_model_camera = exponential(step) * result.T_model_camera;
      ++result.iterations;
      if (step.norm() < config.converged_m) break;
    }
  }
  const NormalEquations sums = alignment.linearize(result.T_model_camera, config.strides.back());
  if (sums.measured > 0) result.inlier_share = static_cast<double>(sums.pairs) / static_cast<double>(sums.measured);
  if (sums.pairs > 0) result.rmse_m = std::sqrt(sums.squared_residuals / static_cast<double>(sums.pairs));
  result.why = judge(sums, result, T_model_camera_start, config);
  result.converged = result.why.empty();
  return result;
}

}  // namespace saccade
