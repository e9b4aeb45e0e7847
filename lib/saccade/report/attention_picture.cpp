// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/attention_picture.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "saccade/core/region.hpp"
#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/plot.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kBackground{255, 255, 255};
constexpr Rgb8 kPoiColor{214, 28, 92};
constexpr Rgb8 kLabelColor{20, 20, 24};
constexpr Rgb8 kGaussianColor{150, 156, 168};
constexpr double kNumberSize_px{13.0};

/// Three ellipses through the principal axes at two standard deviations.
void draw_gaussian(Canvas& canvas, const DrawnGaussian& gaussian) {
  constexpr int kSegments{48};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{gaussian.covariance_m2};
  const Eigen::Matrix3d axes = solver.eigenvectors() * (2.0 * solver.eigenvalues().cwiseAbs().cwiseSqrt()).asDiagonal();
  const LineStyle style{gaussian.is_poi ? kPoiColor : kGaussianColor, gaussian.is_poi ? 2.0 : 1.2, 0.5};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d x = axes.col(axis);
    const Eigen::Vector3d y = axes.col((axis + 1) % 3);
    const auto at = [&](int i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / kSegments;
      return Eigen::Vector3d{gaussian.mean_m + std::cos(angle_rad) * x + std::sin(angle_rad) * y};
    };
    for (int i = 0; i < kSegments; ++i) canvas.line(at(i), at(i + 1), style);
  }
}

void draw_way(Canvas& canvas, std::span<const HandSample> trajectory, double start_s, double duration_s) {
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double share = (trajectory[i].time_s - start_s) / duration_s;
    canvas.line(trajectory[i - 1].position_m, trajectory[i].position_m, {depth_colors()(share), 2.2, 1.0});
  }
}

/// Returns a point that falls `pixels` above another in the picture.
Eigen::Vector3d above(const Canvas& canvas, const Eigen::Vector3d& p_world, double pixels) {
  const Viewpoint& view = canvas.view();
  const Eigen::Vector3d up = -view.T_world_camera.linear().col(1);
  const double depth_m = (view.T_world_camera.inverse() * p_world).z();
  return p_world + pixels * depth_m / view.camera.fy * up;
}

/// Numbers of actions, at the place of the first of them.
struct NumberLabel {
  Eigen::Vector3d p_world;
  Eigen::Vector2d at_px;
  std::string numbers;
};

/// One label for each action that is in the picture; where labels would lie on each other, one for all: "1, 2".
std::vector<NumberLabel> number_labels(const Canvas& canvas, std::span<const HandAction> actions) {
  constexpr double kDigit_px{0.7 * kNumberSize_px};
  std::vector<NumberLabel> labels;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const auto at_px = canvas.project(actions[i].position_m);
    if (!at_px) continue;
    const std::string number = std::to_string(i + 1);
    const auto touches = [&](const NumberLabel& other) {
      const Eigen::Vector2d apart_px = (*at_px - other.at_px).cwiseAbs();
      const double widths_px = kDigit_px * static_cast<double>(number.size() + other.numbers.size());
      return apart_px.x() < 0.5 * widths_px + kDigit_px && apart_px.y() < 1.2 * kNumberSize_px;
    };
    const auto beside = std::find_if(labels.begin(), labels.end(), touches);
    if (beside == labels.end()) {
      labels.push_back({actions[i].position_m, *at_px, number});
    } else {
      beside->numbers += ", " + number;
    }
  }
  return labels;
}

}  // namespace

std::vector<Eigen::Vector3d> attention_points(std::span<const HandSample> trajectory, const AttentionFindings& findings,
                                              double region_radius_m) {
  std::vector<Eigen::Vector3d> points;
  for (const HandSample& sample : trajectory) points.push_back(sample.position_m);
  points.insert(points.end(), findings.labels_m.begin(), findings.labels_m.end());
  for (const HandAction& action : findings.actions) {
    const Box around = bounds(Region{Sphere{action.position_m, region_radius_m}});
    points.push_back(around.min);
    points.push_back(around.max);
  }
  return points;
}

AttentionLegend draw_attention(Canvas& canvas, std::span<const HandSample> trajectory,
                               const AttentionFindings& findings, double region_radius_m) {
  AttentionLegend legend;
  if (trajectory.size() > 1) {
    const double start_s = trajectory.front().time_s;
    const double duration_s = trajectory.back().time_s - start_s;
    draw_way(canvas, trajectory, start_s, duration_s);
    legend.time = ColorBar{0.0, duration_s, "time since the start [s]"};
  }
  for (const DrawnGaussian& gaussian : findings.gaussians) draw_gaussian(canvas, gaussian);
  if (!findings.gaussians.empty()) legend.entries.push_back({kGaussianColor, "Gaussians, two standard deviations"});
  for (const Eigen::Vector3d& label : findings.labels_m) canvas.point(label, 11.0, kLabelColor, 0.6);
  if (!findings.labels_m.empty()) legend.entries.push_back({kLabelColor, "labels: where the hand acted"});
  for (std::size_t i = 0; i < findings.actions.size(); ++i) {
    const Eigen::Vector3d& p = findings.actions[i].position_m;
    canvas.outline(Region{Sphere{p, region_radius_m}}, {kPoiColor, 1.0, 0.4});
    canvas.point(p, 9.0, kPoiColor, 0.7);
  }
  for (const NumberLabel& label : number_labels(canvas, findings.actions)) {
    canvas.label(above(canvas, label.p_world, kNumberSize_px), label.numbers, kPoiColor, kNumberSize_px);
  }
  if (!findings.actions.empty()) legend.entries.push_back({kPoiColor, "points of interest and their regions"});
  return legend;
}

Rgb8 poi_color() { return kPoiColor; }

ColorImage attention_picture(std::span<const HandSample> trajectory, const AttentionFindings& findings,
                             const AttentionPictureConfig& config) {
  std::vector<Eigen::Vector3d> shown = attention_points(trajectory, findings, config.region_radius_m);
  if (shown.empty()) shown.emplace_back(Eigen::Vector3d::Zero());
  Canvas canvas{overview_of(shown, config.overview), kBackground};
  AttentionLegend legend = draw_attention(canvas, trajectory, findings, config.region_radius_m);
  Panel panel{canvas.finish(), {}, legend.time, {}, std::move(legend.entries)};
  if (panel.bar) panel.colors = depth_colors();
  return compose({config.title, {std::move(panel)}, trajectory.empty() ? "no samples" : config.note});
}

std::string speed_plot(const AttentionFindings& findings, const std::string& title) {
  if (findings.motion.empty()) return {};
  const double start_s = findings.motion.front().time_s;
  PlotSeries speed{"speed", {}, {}};
  for (const SmoothedPoint& point : findings.motion) {
    speed.x.push_back(point.time_s - start_s);
    speed.y.push_back(point.speed_mps);
  }
  PlotSeries dips{"dips", {}, {}};
  constexpr double kPenUp{std::numeric_limits<double>::quiet_NaN()};
  for (const Dip& dip : findings.dips) {
    const double time_s = dip.at.time_s - start_s;
    dips.x.insert(dips.x.end(), {time_s, time_s, time_s});
    dips.y.insert(dips.y.end(), {dip.speed_mps, std::min(dip.before_mps, dip.after_mps), kPenUp});
  }
  Plot plot;
  plot.title = title;
  plot.x_label = "time since the start, s";
  plot.y_label = "smoothed speed, m/s";
  plot.series.push_back(std::move(speed));
  if (!findings.dips.empty()) plot.series.push_back(std::move(dips));
  return plot_svg(plot);
}

}  // namespace saccade
