// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/orientation_marks.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace saccade {
namespace {

constexpr double kMarkDepth_m{0.02};  // before everything else
constexpr double kCorner_px{16.0};
constexpr double kAxis_px{30.0};
constexpr double kBarShare{0.16};  // at most, as a share of the picture's width
constexpr Rgb8 kMarkColor{58, 58, 62};

/// The point of a pixel, in front of all that is drawn.
Eigen::Vector3d mark_point(const Canvas& canvas, double u, double v) {
  const PinholeCamera& camera = canvas.view().camera;
  const Eigen::Vector3d ray{(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0};
  return canvas.view().T_world_camera * (kMarkDepth_m * ray);
}

void draw_triad(Canvas& canvas, double u, double v) {
  constexpr std::array<Rgb8, 3> kAxes{{{204, 51, 51}, {46, 139, 64}, {48, 96, 204}}};
  const Eigen::Matrix3d R_camera_world = canvas.view().T_world_camera.linear().transpose();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = R_camera_world.col(axis);
    canvas.line(mark_point(canvas, u, v), mark_point(canvas, u + kAxis_px * along.x(), v + kAxis_px * along.y()),
                {kAxes[static_cast<std::size_t>(axis)], 2.4, 1.0});
  }
}

void draw_bar(Canvas& canvas, double u, double v, const Eigen::Vector3d& p_world_scale) {
  const double depth_m = (canvas.view().T_world_camera.inverse(Eigen::Isometry) * p_world_scale).z();
  if (!(depth_m > 0.0)) return;
  const PinholeCamera& camera = canvas.view().camera;
  const double length_m = round_length(kBarShare * camera.width * depth_m / camera.fx);
  const double length_px = length_m * camera.fx / depth_m;
  constexpr double kTick_px{4.0};
  const LineStyle style{kMarkColor, 2.0, 1.0};
  const auto stroke = [&](double u0, double v0, double u1, double v1) {
    canvas.line(mark_point(canvas, u0, v0), mark_point(canvas, u1, v1), style);
  };
  stroke(u, v, u + length_px, v);
  stroke(u, v - kTick_px, u, v + kTick_px);
  stroke(u + length_px, v - kTick_px, u + length_px, v + kTick_px);
  canvas.label(mark_point(canvas, u + 0.5 * length_px, v - 12.0), length_text(length_m), kMarkColor, 10.0);
}

}  // namespace

double round_length(double length_m) {
  SACCADE_EXPECTS(length_m > 0.0);
  const double power = std::pow(10.0, std::floor(std::log10(length_m) + 1e-9));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= length_m * (1.0 + 1e-9)) return step * power;
  }
  return power;
}

std::string length_text(double length_m) {
  std::array<char, 32> text{};
  if (length_m >= 0.9995) {
    std::snprintf(text.data(), text.size(), "%g m", length_m);
  } else if (length_m >= 0.00995) {
    std::snprintf(text.data(), text.size(), "%g cm", 100.0 * length_m);
  } else {
    std::snprintf(text.data(), text.size(), "%g mm", 1000.0 * length_m);
  }
  return text.data();
}

void draw_orientation(Canvas& canvas, const Eigen::Vector3d& p_world_scale) {
  const double v = canvas.view().camera.height - kCorner_px - kAxis_px;
  const double u = kCorner_px + kAxis_px;
  draw_triad(canvas, u, v);
  draw_bar(canvas, u + kAxis_px + kCorner_px, canvas.view().camera.height - 1.5 * kCorner_px, p_world_scale);
}

}  // namespace saccade
