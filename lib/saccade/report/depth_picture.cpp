// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/depth_picture.hpp"

#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {

DepthScale depth_scale(const DepthImage& depth) {
  std::vector<float> valid;
  for (const float d : depth.pixels()) {
    if (d > 0.0F && std::isfinite(d)) valid.push_back(d);
  }
  if (valid.empty()) return {};
  const auto percentile = [&](double share) {
    const auto index = static_cast<std::size_t>(share * static_cast<double>(valid.size() - 1));
    return static_cast<double>(nth_smallest(valid, index));
  };
  constexpr double kStep{0.2};
  const double near_m = std::floor(percentile(0.01) / kStep) * kStep;
  const double far_m = std::ceil(percentile(0.99) / kStep) * kStep;
  return {near_m, std::max(far_m, near_m + kStep)};
}

ColorImage depth_picture(const DepthImage& depth, const DepthScale& scale) {
  ColorImage picture{depth.width(), depth.height(), kNoReturn};
  const ColorMap colors = depth_colors();
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double d = depth.pixels()[i];
    if (d > 0.0 && std::isfinite(d)) picture.data()[i] = colors((d - scale.near_m) / (scale.far_m - scale.near_m));
  }
  return picture;
}

ColorImage difference_picture(const DepthImage& a, const DepthImage& b, double limit_m) {
  SACCADE_EXPECTS(a.width() == b.width() && a.height() == b.height() && limit_m > 0.0);
  ColorImage picture{a.width(), a.height(), kNoReturn};
  const ColorMap colors = signed_colors();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double da = a.pixels()[i];
    const double db = b.pixels()[i];
    if (!(da > 0.0) || !(db > 0.0) || !std::isfinite(da) || !std::isfinite(db)) continue;
    picture.data()[i] = colors(0.5 + 0.5 * (da - db) / limit_m);
  }
  return picture;
}

Panel depth_panel(const DepthImage& depth, const DepthScale& scale, std::string title) {
  return {depth_picture(depth, scale),
          std::move(title),
          ColorBar{scale.near_m, scale.far_m, "depth along the optical axis [m], dark: no return", 2, 5},
          depth_colors(),
          {}};
}

Panel difference_panel(const DepthImage& a, const DepthImage& b, double limit_m, std::string title) {
  const double limit_mm = 1000.0 * limit_m;
  return {difference_picture(a, b, limit_m),
          std::move(title),
          ColorBar{-limit_mm, limit_mm, "difference [mm], dark: not in both", 0, 5},
          signed_colors(),
          {}};
}

}  // namespace saccade
