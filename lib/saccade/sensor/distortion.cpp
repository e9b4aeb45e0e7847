// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/distortion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace saccade {
namespace {

Eigen::Matrix2d jacobian(const Distortion& d, const Eigen::Vector2d& p) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = p.squaredNorm();
  const double over = 1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  const double under = 1.0 + r2 * (d.k4 + r2 * (d.k5 + r2 * d.k6));
  const double radial = over / under;
  const double over_slope = d.k1 + r2 * (2.0 * d.k2 + r2 * 3.0 * d.k3);
  const double under_slope = d.k4 + r2 * (2.0 * d.k5 + r2 * 3.0 * d.k6);
  const double slope = 2.0 * (over_slope - radial * under_slope) / under;  // ∂radial/∂x = slope·x
  Eigen::Matrix2d j;
  j << radial + slope * x * x + 2.0 * d.p1 * y + 6.0 * d.p2 * x, slope * x * y + 2.0 * d.p1 * x + 2.0 * d.p2 * y,
      slope * x * y + 2.0 * d.p1 * x + 2.0 * d.p2 * y, radial + slope * y * y + 6.0 * d.p1 * y + 2.0 * d.p2 * x;
  return j;
}

Error wrong_size(int width, int height, int camera_width, int camera_height) {
  return {Errc::size_mismatch,
          "image is " + std::to_string(width) + "x" + std::to_string(height) + ", the camera " +
              std::to_string(camera_width) + "x" + std::to_string(camera_height),
          "undistort"};
}

}  // namespace

std::optional<Distortion> Distortion::from_coefficients(std::span<const double> coefficients) {
  for (std::size_t i = kMaxCoefficients; i < coefficients.size(); ++i) {
    if (coefficients[i] != 0.0) return std::nullopt;
  }
  const auto at = [&](std::size_t i) { return i < coefficients.size() ? coefficients[i] : 0.0; };
  return Distortion{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
}

Eigen::Vector2d Distortion::distort(const Eigen::Vector2d& ideal) const {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  const double radial = (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

bool Distortion::regular_at(const Eigen::Vector2d& ideal) const {
  constexpr int kSteps{16};
  for (int i = 1; i <= kSteps; ++i) {
    const Eigen::Vector2d on_the_way = ideal * (static_cast<double>(i) / kSteps);
    const double r2 = on_the_way.squaredNorm();
    if (!(1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)) > 0.0)) return false;  // beyond a pole
    const Eigen::Matrix2d j = jacobian(*this, on_the_way);
    if (!(j.determinant() > 0.0) || !(j.trace() > 0.0)) return false;
  }
  return true;
}

double Distortion::regular_radius() const {
  constexpr int kDirections{16};
  constexpr double kStep{0.02};
  constexpr double kLargest{4.0};
  double radius = 0.0;
  while (radius < kLargest) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      const Eigen::Vector2d edge{std::cos(angle) * (radius + kStep), std::sin(angle) * (radius + kStep)};
      if (!regular_at(edge)) return radius;
    }
    radius += kStep;
  }
  return radius;
}

std::optional<Eigen::Vector2d> Distortion::undistort(const Eigen::Vector2d& distorted) const {
  constexpr int kMaxIterations{50};
  constexpr double kTolerance{1e-12};
  Eigen::Vector2d ideal = distorted;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d residual = distort(ideal) - distorted;
    if (residual.norm() <= kTolerance) return regular_at(ideal) ? std::optional{ideal} : std::nullopt;
    const Eigen::Vector2d full_step = jacobian(*this, ideal).inverse() * residual;
    if (!full_step.allFinite()) return std::nullopt;
    // Halve the step until the residual shrinks, so that a poor start cannot jump past the fold of the model.
    double factor = 1.0;
    constexpr double kSmallestFactor{1e-6};
    while (factor > kSmallestFactor && !((distort(ideal - factor * full_step) - distorted).norm() < residual.norm())) {
      factor *= 0.5;
    }
    if (factor <= kSmallestFactor) return std::nullopt;
    ideal -= factor * full_step;
  }
  return std::nullopt;
}

Status Distortion::validate() const {
  for (const double k : {k1, k2, p1, p2, k3, k4, k5, k6}) {
    if (!std::isfinite(k)) return Error{Errc::invalid_argument, "distortion coefficients must be finite", "camera"};
  }
  return {};
}

Result<Undistorter> Undistorter::create(const PinholeCamera& camera, const Distortion& distortion) {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK(distortion.validate());
  Undistorter result{camera.width, camera.height};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d ideal = camera.ray(u, v).head<2>();
      if (!distortion.regular_at(ideal)) continue;
      const Eigen::Vector2d raw = distortion.distort(ideal);
      result.source_(u, v) = {static_cast<float>(raw.x() * camera.fx + camera.cx),
                              static_cast<float>(raw.y() * camera.fy + camera.cy)};
    }
  }
  return result;
}

Result<DepthImage> Undistorter::undistort(const DepthImage& raw) const {
  const int width = source_.width();
  const int height = source_.height();
  if (raw.width() != width || raw.height() != height) return wrong_size(raw.width(), raw.height(), width, height);
  DepthImage ideal{width, height};
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const float u = std::floor(source_.data()[i].x() + 0.5F);
    const float v = std::floor(source_.data()[i].y() + 0.5F);
    const bool inside = u >= 0.0F && v >= 0.0F && u < static_cast<float>(width) && v < static_cast<float>(height);
    ideal.data()[i] = inside ? raw(static_cast<int>(u), static_cast<int>(v)) : 0.0F;
  }
  return ideal;
}

Result<ColorImage> Undistorter::undistort(const ColorImage& raw) const {
  const int width = source_.width();
  const int height = source_.height();
  if (raw.width() != width || raw.height() != height) return wrong_size(raw.width(), raw.height(), width, height);
  ColorImage ideal{width, height};
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Eigen::Vector2f p = source_.data()[i];
    if (!(p.x() >= -0.5F && p.y() >= -0.5F && p.x() < static_cast<float>(width) - 0.5F &&
          p.y() < static_cast<float>(height) - 0.5F)) {
      continue;
    }
    const float u = std::clamp(p.x(), 0.0F, static_cast<float>(width - 1));
    const float v = std::clamp(p.y(), 0.0F, static_cast<float>(height - 1));
    const int u0 = static_cast<int>(u);
    const int v0 = static_cast<int>(v);
    const int u1 = std::min(u0 + 1, width - 1);
    const int v1 = std::min(v0 + 1, height - 1);
    const float a = u - static_cast<float>(u0);
    const float b = v - static_cast<float>(v0);
    for (std::size_t c = 0; c < 3; ++c) {
      const float top = (1.0F - a) * raw(u0, v0)[c] + a * raw(u1, v0)[c];
      const float bottom = (1.0F - a) * raw(u0, v1)[c] + a * raw(u1, v1)[c];
      ideal.data()[i][c] = static_cast<std::uint8_t>((1.0F - b) * top + b * bottom + 0.5F);
    }
  }
  return ideal;
}

}  // namespace saccade
