// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/depth_picture.hpp"

#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace saccade {
namespace {

bool is_return(float depth) { return depth > 0.0F && std::isfinite(depth); }

}  // namespace

Residual residual(const DepthImage& measured, const DepthImage& map_cast) {
  SACCADE_EXPECTS(measured.width() == map_cast.width() && measured.height() == map_cast.height());
  std::vector<float> differences;
  std::size_t valid{0};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const float m = measured.pixels()[i];
    const float c = map_cast.pixels()[i];
    if (!is_return(m)) continue;
    ++valid;
    if (is_return(c)) differences.push_back(std::abs(c - m));
  }
  if (differences.empty()) return {};
  return {upper_median(differences), static_cast<double>(differences.size()) / static_cast<double>(valid)};
}

ColorImage fusion_picture(const DepthImage& measured, const DepthImage& map_cast, const FusionPictureConfig& config) {
  const DepthScale scale = config.scale.value_or(depth_scale(measured));
  const Residual fit = residual(measured, map_cast);
  std::array<char, 120> note{};
  std::snprintf(note.data(), note.size(), "median |difference| %.1f mm over %.1f %% of the pixels with a return",
                1000.0 * fit.median_m, 100.0 * fit.share);
  return compose({config.title,
                  {depth_panel(measured, scale, "measured"), depth_panel(map_cast, scale, "ray cast from the map"),
                   difference_panel(map_cast, measured, config.limit_m, "ray cast - measured")},
                  note.data()});
}

}  // namespace saccade
