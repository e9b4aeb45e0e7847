// SPDX-License-Identifier: Apache-2.0
#pragma once
// fill_rect, paste, and Sheet: a page of titled panels side by side, with notes and legends below.

#include <optional>
#include <string>
#include <vector>

#include "saccade/report/color_map.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// Both cut at the image's border.
void fill_rect(ColorImage& image, int x, int y, int width, int height, const Rgb8& color);
void paste(ColorImage& image, int x, int y, const ColorImage& part);

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
