// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sheet: a page of titled panels side by side, with notes and legends below; ColorMap and its instances, colour bars,
// scales.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/sensor/image.hpp"

namespace saccade {

/// Colours at equal steps over [0, 1], linearly interpolated between.
class ColorMap {
 public:
  explicit constexpr ColorMap(std::span<const Rgb8> stops) : stops_{stops} {}
  /// x is cut to [0, 1]; NaN counts as 0.
  [[nodiscard]] Rgb8 operator()(double x) const;

 private:
  std::span<const Rgb8> stops_;
};

/// Many hues, for depth: red is 0 (near), violet is 1 (far).
[[nodiscard]] ColorMap depth_colors();
/// Dark violet to yellow, ever lighter, for amounts.
[[nodiscard]] ColorMap amount_colors();
/// Blue (0), white (0.5), red (1), for signed differences.
[[nodiscard]] ColorMap signed_colors();

struct ColorBar {
  double low{0.0};    ///< value at x = 0 of the map
  double high{1.0};   ///< value at x = 1
  std::string title;  ///< with the unit
  int decimals{1};
  int ticks{5};
  double text_px{9.0};  ///< height of capitals; 14 pixels above and 26 below the bar hold it up to 11
};

/// A bar from 0 to a round number at or above `high` (> 0), with ticks at round numbers.
[[nodiscard]] ColorBar round_bar(double high, std::string title);

/// A horizontal bar with ticks and their values below and the title above. (x, y) is the bar's upper left corner; 14
/// pixels above and 26 below it are used.
void draw_color_bar(ColorImage& image, int x, int y, int width, const ColorMap& colors, const ColorBar& bar);

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
  std::optional<ColorMap> colors;  ///< colours of `bar`
  std::vector<LegendEntry> legend;
};

struct Sheet {
  std::string title;
  std::vector<Panel> panels;
  std::string note;  ///< one line at the bottom
};

/// Lays the panels out from left to right on white. Repeats the pixels of images that are narrower than their titles.
[[nodiscard]] ColorImage compose(Sheet sheet);

}  // namespace saccade
