// SPDX-License-Identifier: Apache-2.0
#pragma once
// Plot: curves over an axis, with bands around them, as SVG.

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace saccade {

/// One curve. Points that are not finite are left out, and the line is broken there.
struct PlotSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;  ///< as many as x
  // The band around the curve: both empty, or as many as x. It is drawn where both ends are finite.
  std::vector<double> low{};
  std::vector<double> high{};
};

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
  // Ends of the axes; without them, the data's, bands included.
  std::optional<std::pair<double, double>> x_range{};
  std::optional<std::pair<double, double>> y_range{};
  double min_x_step{0.0};  ///< between ticks: 1 where x counts something
  int width_px{760};
  int height_px{440};
};

/// The plot as one <svg> element that stands alone or in a page: no ids, scripts, styles or fonts of its own. Series
/// differ in colour (Okabe and Ito's, which colour-blind readers tell apart too), dashes and markers; what lies beyond
/// a given range is cut off. Text is UTF-8 and escaped. Expects series of matching lengths, ranges that rise, and at
/// least 200 × 150 pixels. Equal plots give equal text, in any locale.
[[nodiscard]] std::string plot_svg(const Plot& plot);

}  // namespace saccade
