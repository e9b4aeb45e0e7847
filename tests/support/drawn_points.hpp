// SPDX-License-Identifier: Apache-2.0
#pragma once
// DrawnPoints: a z-buffer that draws points as the annotation page does, pixel by pixel, and remembers whose each pixel
// is. It shares no code with the selection that it judges.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/annotate/selection.hpp"

namespace saccade::test {

class DrawnPoints {
 public:
  /// Draws every point as the square that WebGL makes of gl_PointSize: all pixels whose centres lie in it.
  DrawnPoints(std::span<const Eigen::Vector3f> positions_m, const SelectionView& view)
      : view_{view}, places_(positions_m.size()) {
    const auto pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    depth_.assign(pixels, std::numeric_limits<double>::infinity());
    owner_.assign(pixels, kNobody);
    const Eigen::Matrix4d& m = view.clip_world;
    perspective_ = m.row(3).head<3>().norm() > 0.0;
    const double scale = m.row(perspective_ ? 3 : 2).head<3>().norm();
    for (std::size_t i = 0; i < positions_m.size(); ++i) {
      if (!positions_m[i].allFinite()) continue;
      const Eigen::Vector4d clip = m * Eigen::Vector4d{positions_m[i].x(), positions_m[i].y(), positions_m[i].z(), 1.0};
      if (clip.w() <= 0.0 || clip.head<3>().cwiseAbs().maxCoeff() > clip.w()) continue;
      Place& at = places_[i];
      at.x = 0.5 * view.width * (1.0 + clip.x() / clip.w());
      at.y = 0.5 * view.height * (1.0 - clip.y() / clip.w());
      at.depth_m = (perspective_ ? clip.w() : clip.z()) / scale;
      each_pixel(at, [&](std::size_t pixel) {
        if (at.depth_m >= depth_[pixel]) return;
        depth_[pixel] = at.depth_m;
        owner_[pixel] = i;
      });
    }
    shows_.assign(positions_m.size(), 0);
    for (const std::size_t owner : owner_) {
      if (owner != kNobody) shows_[owner] += 1;
    }
  }

  /// Tells whether the middle of a point's square lies in a rectangle of the picture.
  [[nodiscard]] bool is_in(std::size_t i, const ScreenRectangle& shape) const {
    return !std::isnan(places_[i].x) && places_[i].x >= shape.corner.x() && places_[i].x < shape.opposite.x() &&
           places_[i].y >= shape.corner.y() && places_[i].y < shape.opposite.y();
  }
  /// Returns the point that the pixel in the middle of a point's square shows. Expects a point in the picture.
  [[nodiscard]] std::size_t shown_before(std::size_t i) const {
    return owner_[static_cast<std::size_t>(places_[i].y) * static_cast<std::size_t>(view_.width) +
                  static_cast<std::size_t>(places_[i].x)];
  }
  /// Number of pixels that have a point's colour.
  [[nodiscard]] int pixels_of(std::size_t i) const { return shows_[i]; }
  /// Distance by which a point lies behind the farthest that any pixel of its square shows, in widths of a pixel there.
  [[nodiscard]] double hidden_px(std::size_t i, double pixel_at_1_m) const {
    double shown_m{0.0};
    each_pixel(places_[i], [&](std::size_t pixel) { shown_m = std::max(shown_m, depth_[pixel]); });
    return (places_[i].depth_m - shown_m) / (pixel_at_1_m * (perspective_ ? shown_m : 1.0));
  }

 private:
  static constexpr std::size_t kNobody{std::numeric_limits<std::size_t>::max()};
  struct Place {
    double x{std::numeric_limits<double>::quiet_NaN()}, y{0.0}, depth_m{0.0};
  };

  template <class Visit>
  void each_pixel(const Place& at, const Visit& visit) const {
    const double half = 0.5 * view_.point_size_px;
    for (int row = static_cast<int>(std::floor(at.y - half)); row <= static_cast<int>(at.y + half); ++row) {
      for (int column = static_cast<int>(std::floor(at.x - half)); column <= static_cast<int>(at.x + half); ++column) {
        const double right = column + 0.5 - at.x;
        const double down = row + 0.5 - at.y;
        const bool covers = right > -half && right <= half && down > -half && down <= half;
        if (!covers || row < 0 || column < 0 || row >= view_.height || column >= view_.width) continue;
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(column));
      }
    }
  }

  SelectionView view_;
  bool perspective_{true};
  std::vector<Place> places_;
  std::vector<double> depth_;
  std::vector<std::size_t> owner_;
  std::vector<int> shows_;
};

}  // namespace saccade::test
