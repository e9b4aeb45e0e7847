// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/depth_picture.hpp"

#include <algorithm>

namespace saccade {
namespace {

constexpr double kNearGrey{225.0};
constexpr double kFarGrey{95.0};

Rgb8 grey_of(double depth_m, const DepthScale& scale) {
  const double share = std::clamp((depth_m - scale.near_m) / (scale.far_m - scale.near_m), 0.0, 1.0);
  const auto level = static_cast<std::uint8_t>(kNearGrey + share * (kFarGrey - kNearGrey));
  return {level, level, level};
}

ColorImage removed_points(const DepthImage& before, const FilteredDepth& filtered, const DepthScale& scale) {
  ColorImage picture{before.width(), before.height(), kNoReturn};
  for (std::size_t i = 0; i < before.size(); ++i) {
    switch (filtered.pixels.pixels()[i]) {
      case FilteredPixel::no_return: break;
      case FilteredPixel::kept: picture.data()[i] = grey_of(before.pixels()[i], scale); break;
      case FilteredPixel::shadow_point: picture.data()[i] = kShadowPointColor; break;
      case FilteredPixel::veil_point: picture.data()[i] = kVeilPointColor; break;
    }
  }
  return picture;
}

}  // namespace

ColorImage filter_picture(const DepthImage& before, const FilteredDepth& filtered, const std::string& title) {
  SACCADE_EXPECTS(before.width() == filtered.pixels.width() && before.height() == filtered.pixels.height());
  const DepthScale scale = depth_scale(before);
  Panel removed{removed_points(before, filtered, scale), "removed", {}, {}, {}};
  removed.legend = {{kShadowPointColor, std::to_string(filtered.shadow_points) + " shadow points"},
                    {kVeilPointColor, std::to_string(filtered.veil_points) + " veil points"},
                    {kNoReturn, "no return"}};
  return compose(
      {title,
       {depth_panel(before, scale, "before"), depth_panel(filtered.depth, scale, "after"), std::move(removed)},
       {}});
}

}  // namespace saccade
