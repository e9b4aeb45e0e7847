// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/sheet.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/report/internal/font.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kSheetPaper{255, 255, 255};
constexpr Rgb8 kSheetInk{40, 44, 52};
constexpr Rgb8 kSoftInk{90, 94, 102};
constexpr Rgb8 kFrame{206, 210, 216};
constexpr int kMargin{16};
constexpr int kLegendRow{20};
constexpr int kBarHeight{56};
constexpr double kPanelTitle_px{10.5};

/// Where each entry of a legend goes, row by row.
struct LegendPlace {
  int x;
  int row;
};

std::vector<LegendPlace> places(const Panel& panel, int width) {
  std::vector<LegendPlace> result;
  int x{0};
  int row{0};
  for (const LegendEntry& entry : panel.legend) {
    const int needed = 34 + static_cast<int>(text_width(entry.text, {.size_px = 9.0}));
    if (x > 0 && x + needed > width + 16) {
      x = 0;
      ++row;
    }
    result.push_back({x, row});
    x += needed;
  }
  return result;
}

int legend_height(const Panel& panel, int width) {
  const int rows = panel.legend.empty() ? 0 : places(panel, width).back().row + 1;
  return (panel.bar ? kBarHeight : 0) + (rows > 0 ? rows * kLegendRow + 8 : 0);
}

/// Repeats each pixel.
ColorImage enlarged(const ColorImage& image, int times) {
  ColorImage out{times * image.width(), times * image.height()};
  for (int v = 0; v < out.height(); ++v) {
    for (int u = 0; u < out.width(); ++u) out(u, v) = image(u / times, v / times);
  }
  return out;
}

/// Enlarges images beside which the titles of panels would overlap, all of a size by as much.
void enlarge_small_panels(std::vector<Panel>& panels) {
  double needed_px = 0.0;
  for (const Panel& panel : panels) {
    needed_px = std::max(needed_px, text_width(panel.title, {.size_px = kPanelTitle_px}));
    if (panel.bar) needed_px = std::max(needed_px, text_width(panel.bar->title, {.size_px = panel.bar->text_px}));
  }
  for (Panel& panel : panels) {
    if (panel.image.empty() || panel.image.width() + kMargin > needed_px) continue;
    panel.image = enlarged(panel.image, static_cast<int>(std::ceil(needed_px / panel.image.width())));
  }
}

void draw_panel(ColorImage& page, int x, int y, const Panel& panel) {
  draw_text(page, x, y - 8, panel.title, {.size_px = kPanelTitle_px, .color = kSheetInk});
  const int w = panel.image.width();
  const int h = panel.image.height();
  fill_rect(page, x - 1, y - 1, w + 2, h + 2, kFrame);
  paste(page, x, y, panel.image);
  if (panel.bar && panel.colors) draw_color_bar(page, x, y + h + 26, w, *panel.colors, *panel.bar);
  const auto at = places(panel, w);
  for (std::size_t i = 0; i < panel.legend.size(); ++i) {
    const int ex = x + at[i].x;
    const int ey = y + h + 10 + (panel.bar ? kBarHeight : 0) + at[i].row * kLegendRow;
    fill_rect(page, ex, ey, 11, 11, kFrame);
    fill_rect(page, ex + 1, ey + 1, 9, 9, panel.legend[i].color);
    draw_text(page, ex + 17, ey + 10, panel.legend[i].text, {.size_px = 9.0, .color = kSoftInk});
  }
}

}  // namespace

void fill_rect(ColorImage& image, int x, int y, int width, int height, const Rgb8& color) {
  for (int v = std::max(0, y); v < std::min(image.height(), y + height); ++v) {
    for (int u = std::max(0, x); u < std::min(image.width(), x + width); ++u) image(u, v) = color;
  }
}

void paste(ColorImage& image, int x, int y, const ColorImage& part) {
  for (int v = std::max(0, -y); v < std::min(part.height(), image.height() - y); ++v) {
    for (int u = std::max(0, -x); u < std::min(part.width(), image.width() - x); ++u) image(x + u, y + v) = part(u, v);
  }
}

void draw_scale(ColorImage& page, int x, int y, int width, const ColorMap& colors, ColorBar bar) {
  constexpr int kBeside_px{10};
  bar.text_px = 11.0;
  draw_color_bar(page, x + kBeside_px, y + 21, width - 2 * kBeside_px, colors, bar);
}

ColorImage with_scale(const ColorImage& picture, const ColorMap& colors, const ColorBar& bar, const Rgb8& paper) {
  ColorImage page{picture.width(), picture.height() + kScaleHeight_px, paper};
  paste(page, 0, 0, picture);
  draw_scale(page, 0, picture.height(), picture.width(), colors, bar);
  return page;
}

ColorImage compose(Sheet sheet) {
  enlarge_small_panels(sheet.panels);
  const bool has_titles =
      std::any_of(sheet.panels.begin(), sheet.panels.end(), [](const Panel& panel) { return !panel.title.empty(); });
  const int top = kMargin + (sheet.title.empty() ? 0 : 30) + (has_titles ? 20 : 0);
  int width = kMargin + static_cast<int>(text_width(sheet.title, {.size_px = 14.0}));
  int panel_bottom = top;
  int panel_width = kMargin;
  for (const Panel& panel : sheet.panels) {
    panel_width += panel.image.width() + kMargin;
    panel_bottom = std::max(panel_bottom, top + panel.image.height() + legend_height(panel, panel.image.width()));
  }
  width = std::max(
      {width + kMargin, panel_width, 2 * kMargin + static_cast<int>(text_width(sheet.note, {.size_px = 9.5}))});
  const int height = panel_bottom + kMargin + (sheet.note.empty() ? 0 : 20);

  ColorImage page{width, height, kSheetPaper};
  if (!sheet.title.empty()) draw_text(page, kMargin, kMargin + 14, sheet.title, {.size_px = 14.0, .color = kSheetInk});
  int x = kMargin;
  for (const Panel& panel : sheet.panels) {
    draw_panel(page, x, top, panel);
    x += panel.image.width() + kMargin;
  }
  if (!sheet.note.empty()) {
    draw_text(page, kMargin, height - kMargin, sheet.note, {.size_px = 9.5, .color = kSoftInk});
  }
  return page;
}

}  // namespace saccade
