// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "saccade/report/internal/blend.hpp"
#include "saccade/report/internal/font.hpp"

namespace saccade {
namespace {

constexpr std::array<Rgb8, 9> kDepth{{{122, 14, 16},
                                      {206, 50, 18},
                                      {247, 128, 38},
                                      {236, 206, 60},
                                      {166, 238, 76},
                                      {56, 212, 146},
                                      {44, 158, 220},
                                      {72, 92, 206},
                                      {58, 30, 108}}};
constexpr std::array<Rgb8, 7> kAmount{
    {{62, 18, 92}, {66, 62, 134}, {46, 104, 142}, {32, 146, 138}, {72, 186, 110}, {166, 216, 60}, {250, 230, 44}}};
constexpr std::array<Rgb8, 7> kSigned{
    {{22, 66, 148}, {66, 134, 202}, {162, 200, 230}, {247, 247, 247}, {246, 184, 150}, {216, 96, 74}, {152, 16, 38}}};

}  // namespace

Rgb8 ColorMap::operator()(double x) const {
  const double at = x > 0.0 ? std::min(x, 1.0) * static_cast<double>(stops_.size() - 1) : 0.0;
  const auto lower = std::min(static_cast<std::size_t>(at), stops_.size() - 2);
  return blend(stops_[lower], stops_[lower + 1], at - static_cast<double>(lower));
}

ColorMap depth_colors() { return ColorMap{kDepth}; }
ColorMap amount_colors() { return ColorMap{kAmount}; }
ColorMap signed_colors() { return ColorMap{kSigned}; }

ColorBar round_bar(double high, std::string title) {
  SACCADE_EXPECTS(high > 0.0);
  constexpr double kIntervals{5.0};
  const double magnitude = std::pow(10.0, std::floor(std::log10(high / kIntervals)));
  const double rest = high / kIntervals / magnitude;
  const double step = magnitude * (rest <= 1.0 ? 1.0 : rest <= 2.0 ? 2.0 : rest <= 5.0 ? 5.0 : 10.0);
  const int count = static_cast<int>(std::ceil(high / step - 1e-9));
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return {0.0, count * step, std::move(title), decimals, count + 1};
}

void draw_color_bar(ColorImage& image, int x, int y, int width, const ColorMap& colors, const ColorBar& bar) {
  constexpr int kHeight{10};
  for (int i = 0; i < width; ++i) fill_rect(image, x + i, y, 1, kHeight, colors((i + 0.5) / width));
  draw_text(image, x, y - 5, bar.title, {.size_px = bar.text_px});
  for (int i = 0; i < bar.ticks; ++i) {
    const double f = static_cast<double>(i) / (bar.ticks - 1);
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", bar.decimals, bar.low + f * (bar.high - bar.low));
    const double at = x + f * (width - 1);
    fill_rect(image, static_cast<int>(std::lround(at)), y + kHeight, 1, 4, {90, 94, 102});
    const TextAnchor anchor = i == 0 ? TextAnchor::left : i + 1 == bar.ticks ? TextAnchor::right : TextAnchor::center;
    draw_text(image, at, y + kHeight + 6 + bar.text_px, text.data(),
              {.size_px = bar.text_px, .color = {70, 74, 82}, .anchor = anchor});
  }
}

}  // namespace saccade
