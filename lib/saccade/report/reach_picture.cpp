// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/robot_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

#include "saccade/core/angle.hpp"
#include "saccade/core/convex_hull.hpp"
#include "saccade/report/internal/blend.hpp"
#include "saccade/report/internal/font.hpp"
#include "saccade/report/internal/plane_drawing.hpp"
#include "saccade/report/sheet.hpp"

namespace saccade {
namespace {

using std::numbers::pi;

constexpr Rgb8 kGround{246, 247, 249};
constexpr Rgb8 kPaper{255, 255, 255};
constexpr Rgb8 kInk{70, 74, 82};
constexpr Rgb8 kAxis{150, 155, 164};
constexpr Rgb8 kGrid{226, 229, 234};
constexpr Rgb8 kNone{205, 208, 214};  ///< not one pose
constexpr Rgb8 kUntested{255, 255, 255};
constexpr Rgb8 kFixture{150, 84, 40};
constexpr Rgb8 kWorkspace{20, 22, 28};
constexpr Rgb8 kArm{214, 92, 22};
constexpr Rgb8 kBest{214, 28, 92};

constexpr int kPlot_px{600};  ///< longest side of the plot from above
constexpr int kLeft_px{52};   ///< for the ticks
constexpr int kBottom_px{44};
constexpr int kEdge_px{10};

ColorBar bar() { return {0.0, 100.0, "view poses that can be taken [%]", 0, 6}; }

Rgb8 color_of(double share) { return share > 0.0 ? amount_colors()(share) : kNone; }

/// A step of 1, 2 or 5 times a power of ten that divides the length into few parts.
double tick_step(double length) {
  const double rough = length / 7.0;
  const double magnitude = std::pow(10.0, std::floor(std::log10(rough)));
  const double rest = rough / magnitude;
  return magnitude * (rest <= 1.0 ? 1.0 : rest <= 2.0 ? 2.0 : rest <= 5.0 ? 5.0 : 10.0);
}

std::array<Eigen::Vector2d, 4> corners_from_above(const Box& box) {
  return {Eigen::Vector2d{box.min.x(), box.min.y()}, Eigen::Vector2d{box.max.x(), box.min.y()},
          Eigen::Vector2d{box.max.x(), box.max.y()}, Eigen::Vector2d{box.min.x(), box.max.y()}};
}

/// The plot from above: which part of the world lies where in the panel.
class TopPlot {
 public:
  explicit TopPlot(const ReachScene& scene) : lo_{scene.workspace.min.head<2>()}, hi_{scene.workspace.max.head<2>()} {
    for (const auto& part : scene.arm) {
      for (const Eigen::Vector2d& p : part) {
        lo_ = lo_.cwiseMin(p);
        hi_ = hi_.cwiseMax(p);
      }
    }
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.06 * (hi_ - lo_).maxCoeff());
    lo_ -= margin;
    hi_ += margin;
    px_per_m_ = kPlot_px / (hi_ - lo_).maxCoeff();
    const Eigen::Vector2d size = px_per_m_ * (hi_ - lo_);
    plot_ = ColorImage{static_cast<int>(std::lround(size.x())), static_cast<int>(std::lround(size.y())), kGround};
  }

  [[nodiscard]] ColorImage& plot() { return plot_; }
  [[nodiscard]] Eigen::Vector2d to_px(const Eigen::Vector2d& p) const {
    return {(p.x() - lo_.x()) * px_per_m_ - 0.5, (hi_.y() - p.y()) * px_per_m_ - 0.5};
  }
  [[nodiscard]] std::vector<Eigen::Vector2d> all_to_px(std::span<const Eigen::Vector2d> points) const {
    std::vector<Eigen::Vector2d> out;
    for (const Eigen::Vector2d& p : points) out.push_back(to_px(p));
    return out;
  }

  void draw_grid() {
    for (int axis = 0; axis < 2; ++axis) {
      for (const double at : ticks(axis)) {
        Eigen::Vector2d a = lo_;
        Eigen::Vector2d b = hi_;
        a[axis] = b[axis] = at;
        draw_stroke(plot_, to_px(a), to_px(b), {kGrid, 1.0});
      }
    }
  }

  /// The plot with its axes.
  [[nodiscard]] ColorImage with_axes() const {
    ColorImage panel{kLeft_px + plot_.width() + kEdge_px, kEdge_px + plot_.height() + kBottom_px, kPaper};
    const int bottom = kEdge_px + plot_.height();
    fill_rect(panel, kLeft_px - 1, kEdge_px - 1, plot_.width() + 2, plot_.height() + 2, kAxis);
    paste(panel, kLeft_px, kEdge_px, plot_);
    constexpr double kText_px{9.0};
    for (const double at : ticks(0)) {
      const double u = kLeft_px + to_px(Eigen::Vector2d{at, lo_.y()}).x();
      fill_rect(panel, static_cast<int>(std::lround(u)), bottom + 1, 1, 4, kAxis);
      draw_text(panel, u, bottom + 18, tick_text(at), {kText_px, kInk, TextAnchor::center});
    }
    for (const double at : ticks(1)) {
      const double v = kEdge_px + to_px(Eigen::Vector2d{lo_.x(), at}).y();
      fill_rect(panel, kLeft_px - 5, static_cast<int>(std::lround(v)), 4, 1, kAxis);
      draw_text(panel, kLeft_px - 9, v + 4.0, tick_text(at), {kText_px, kInk, TextAnchor::right});
    }
    draw_text(panel, kLeft_px + 0.5 * plot_.width(), bottom + 37, "x [m]", {9.5, kInk, TextAnchor::center});
    draw_text(panel, 2, kEdge_px + 9, "y [m]", {9.5, kInk, TextAnchor::left});
    return panel;
  }

 private:
  [[nodiscard]] double step() const { return tick_step((hi_ - lo_).maxCoeff()); }
  [[nodiscard]] std::vector<double> ticks(int axis) const {
    std::vector<double> at;
    const auto last = static_cast<int>(std::floor(hi_[axis] / step() + 1e-9));
    for (int i = static_cast<int>(std::ceil(lo_[axis] / step() - 1e-9)); i <= last; ++i) {
      const bool under_title = axis == 1 && to_px(Eigen::Vector2d{lo_.x(), i * step()}).y() < 18.0;
      if (!under_title) at.push_back(i * step());
    }
    return at;
  }
  [[nodiscard]] std::string tick_text(double at) const {
    std::array<char, 32> text{};
    const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step()) + 1e-9)));
    std::snprintf(text.data(), text.size(), "%.*f", decimals, at == 0.0 ? 0.0 : at);
    return text.data();
  }

  Eigen::Vector2d lo_;
  Eigen::Vector2d hi_;
  double px_per_m_{1.0};
  ColorImage plot_;
};

Panel top_panel(const ReachScene& scene) {
  TopPlot top{scene};
  ColorImage& plot = top.plot();
  top.draw_grid();
  bool untested{false};
  for (const ReachScene::Square& square : scene.squares) {
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * scene.square_m);
    const Eigen::Vector2d a = top.to_px(square.middle - half);
    const Eigen::Vector2d b = top.to_px(square.middle + half);
    const auto edge = [](double at) { return static_cast<int>(std::lround(at + 0.5)); };
    fill_rect(plot, edge(a.x()), edge(b.y()), edge(b.x()) - edge(a.x()), edge(a.y()) - edge(b.y()),
              square.share ? color_of(*square.share) : kUntested);
    untested = untested || !square.share;
  }
  for (const Box& box : scene.fixtures) draw_outline(plot, top.all_to_px(corners_from_above(box)), {kFixture, 3.0});
  draw_outline(plot, top.all_to_px(corners_from_above(scene.workspace)), {kWorkspace, 1.5, 7.0});
  for (const auto& part : scene.arm) {
    const std::vector<Eigen::Vector2d> hull = top.all_to_px(convex_hull(part));
    fill_convex(plot, hull, kArm, 0.12);
    draw_outline(plot, hull, {kArm, 1.4});
  }
  if (scene.best) {
    const Eigen::Vector2d at = top.to_px(*scene.best);
    for (const auto& [color, width] : {std::pair{kPaper, 5.0}, std::pair{kBest, 2.4}}) {
      for (const Eigen::Vector2d& arm : {Eigen::Vector2d{6.0, 6.0}, Eigen::Vector2d{6.0, -6.0}}) {
        draw_stroke(plot, at - arm, at + arm, {color, width});
      }
    }
  }
  Panel panel{top.with_axes(), "at each point of interest", bar(), amount_colors(), {}};
  panel.legend = {{kNone, "not one pose"}, {kArm, "arm, joints in the middle"}, {kWorkspace, "workspace (dashed)"}};
  if (!scene.fixtures.empty()) panel.legend.push_back({kFixture, "fixtures"});
  if (scene.best) panel.legend.push_back({kBest, "best point"});
  if (untested) panel.legend.push_back({kUntested, "not tested"});
  return panel;
}

/// The different values of one angle, ascending.
std::vector<double> distinct(const std::vector<ReachScene::Direction>& directions,
                             double ReachScene::Direction::*angle) {
  std::vector<double> values;
  for (const ReachScene::Direction& direction : directions) values.push_back(direction.*angle);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return b - a < 1e-9; }),
               values.end());
  return values;
}

/// Shares over latitude and longitude, as rings and sectors.
class DirectionHemisphere {
 public:
  explicit DirectionHemisphere(const std::vector<ReachScene::Direction>& directions)
      : latitudes_{distinct(directions, &ReachScene::Direction::latitude_rad)},
        longitudes_{distinct(directions, &ReachScene::Direction::longitude_rad)},
        shares_(latitudes_.size() * longitudes_.size(), 0.0) {
    for (const ReachScene::Direction& direction : directions) {
      shares_[nearest(latitudes_, direction.latitude_rad) * longitudes_.size() +
              nearest(longitudes_, direction.longitude_rad)] = direction.share;
    }
  }

  /// Half a step below the lowest latitude.
  [[nodiscard]] double rim_rad() const { return latitudes_.front() - 0.5 * step(); }
  [[nodiscard]] double share(double latitude_rad, double longitude_rad) const {
    const std::size_t ring = nearest(latitudes_, latitude_rad) * longitudes_.size();
    if (latitudes_[ring / longitudes_.size()] > 0.5 * pi - 1e-6) {  // one place, whatever the longitude
      double sum{0.0};
      for (std::size_t i = 0; i < longitudes_.size(); ++i) sum += shares_[ring + i];
      return sum / static_cast<double>(longitudes_.size());
    }
    const double around = 2.0 * pi / static_cast<double>(longitudes_.size());
    const double turned = longitude_rad < 0.0 ? longitude_rad + 2.0 * pi : longitude_rad;
    return shares_[ring + static_cast<std::size_t>(std::lround(turned / around)) % longitudes_.size()];
  }

 private:
  [[nodiscard]] double step() const { return latitudes_.size() > 1 ? latitudes_[1] - latitudes_[0] : 10_deg; }
  static std::size_t nearest(const std::vector<double>& values, double at) {
    const auto closer = [at](double a, double b) { return std::abs(a - at) < std::abs(b - at); };
    return static_cast<std::size_t>(std::min_element(values.begin(), values.end(), closer) - values.begin());
  }

  std::vector<double> latitudes_;
  std::vector<double> longitudes_;
  std::vector<double> shares_;
};

Panel sky_panel(const ReachScene& scene) {
  constexpr int kRadius_px{165};
  constexpr int kSide_px{2 * kRadius_px + 72};
  constexpr int kMiddle{kSide_px / 2};
  constexpr int kAcross{3};  // samples per pixel and direction
  const DirectionHemisphere sky{scene.directions};
  const double zenith_to_rim = 0.5 * pi - sky.rim_rad();
  ColorImage panel{kSide_px, kSide_px, kPaper};
  for (int v = 0; v < kSide_px; ++v) {
    for (int u = 0; u < kSide_px; ++u) {
      std::array<int, 3> sum{};
      for (int k = 0; k < kAcross * kAcross; ++k) {
        const int row = k / kAcross;
        const double x = u - kMiddle + (k % kAcross + 0.5) / kAcross - 0.5;
        const double y = kMiddle - v + (row + 0.5) / kAcross - 0.5;
        const double from_zenith = std::hypot(x, y) / kRadius_px * zenith_to_rim;
        const Rgb8 color =
            from_zenith > zenith_to_rim ? kPaper : color_of(sky.share(0.5 * pi - from_zenith, std::atan2(y, x)));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c];
      }
      for (std::size_t c = 0; c < 3; ++c) panel(u, v)[c] = static_cast<std::uint8_t>(sum[c] / (kAcross * kAcross));
    }
  }
  const auto at = [&](double latitude_rad, double longitude_rad, double beyond_px) {
    const double r = (0.5 * pi - latitude_rad) / zenith_to_rim * kRadius_px + beyond_px;
    return Eigen::Vector2d{kMiddle + r * std::cos(longitude_rad), kMiddle - r * std::sin(longitude_rad)};
  };
  for (const int latitude_deg : {0, 30, 60}) {
    const double latitude_rad = to_rad(latitude_deg);
    if (latitude_rad < sky.rim_rad()) continue;
    for (int i = 0; i < 180; ++i) {
      draw_stroke(panel, at(latitude_rad, to_rad(2.0 * i), 0.0), at(latitude_rad, to_rad(2.0 * i + 1.0), 0.0),
                  {kPaper, 1.0});
    }
    const Eigen::Vector2d label = at(latitude_rad, 0.25 * pi, 0.0);
    const std::string text = std::to_string(latitude_deg) + "°";
    for (const auto& [du, dv] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}}) {
      draw_text(panel, label.x() + du, label.y() + 4.0 + dv, text, {9.0, kPaper, TextAnchor::center});
    }
    draw_text(panel, label.x(), label.y() + 4.0, text, {9.0, kWorkspace, TextAnchor::center});
  }
  constexpr std::array<const char*, 4> kSides{"+x", "+y", "-x", "-y"};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d p = at(sky.rim_rad(), 0.5 * pi * i, 17.0);
    draw_text(panel, p.x(), p.y() + 4.5, kSides[static_cast<std::size_t>(i)], {10.0, kInk, TextAnchor::center});
  }
  return {std::move(panel), "by direction, from the points to the camera", bar(), amount_colors(), {}};
}

}  // namespace

ColorImage reach_picture(const ReachScene& scene) {
  SACCADE_EXPECTS(!scene.squares.empty() && validate(Region{scene.workspace}).ok());
  Sheet sheet{scene.title, {top_panel(scene)}, scene.note};
  if (!scene.directions.empty()) sheet.panels.push_back(sky_panel(scene));
  return compose(sheet);
}

}  // namespace saccade
