// SPDX-License-Identifier: Apache-2.0
#pragma once
// fill_rect, paste, draw_scale, with_scale, and Sheet: a page of titled panels side by side, with notes and legends
// below.

#include <optional>
#include <string>
#include <vector>

#include "saccade/report/color_map.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// Both cut at the image's border.
void fill_rect(ColorImage& image, int x, int y, int width, int height, const Rgb8& color);
void paste(ColorImage& image, int x, int y, const ColorImage& part);

constexpr int kScaleHeight_px{54};  ///< below a picture, for its scale
/// Draws a scale of that height below a picture whose lower left corner is (x, y).
void draw_scale(ColorImage& page, int x, int y, int width, const ColorMap& colors, ColorBar bar);
/// The picture with its scale below.
[[nodiscard]] ColorImage with_scale(const ColorImage& picture, const ColorMap& colors, const ColorBar& bar,
                                    const Rgb8& paper);

/// A colour and what it stands for.
struct LegendEntry {
  Rgb8 color;
  std::string text;
};

struct Panel {
  ColorImage image;
  std::string title;
  std::optional<ColorBar> bar;
  std::optional<ColorMap> colors;  ///< of the bar
  std::vector<LegendEntry> legend;
};

struct Sheet {
  std::string title;
  std::vector<Panel> panels;
  std::string note;  ///< one line at the bottom
};

/// Lays the panels out from left to right on white.
[[nodiscard]] ColorImage compose(const Sheet& sheet);

}  // namespace saccade
