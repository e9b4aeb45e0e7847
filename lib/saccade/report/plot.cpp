// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/plot.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/report/internal/xml_text.hpp"

namespace saccade {
namespace {

using Range = std::pair<double, double>;

// Okabe and Ito, "Color Universal Design" (2008); black and yellow left out: text is black, and yellow is faint on
// white.
constexpr std::array<std::string_view, 6> kColors{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"};
constexpr std::array<std::string_view, 4> kDashes{"", "7 4", "2 3", "9 3 2 3"};

constexpr double kMarginTop_px{40.0};
constexpr double kMarginBottom_px{52.0};
constexpr double kMarginRight_px{18.0};
constexpr double kDigit_px{7.0};  // average width of a letter in a text of 12 px
constexpr double kLegendRow_px{20.0};

/// With at most that many decimals, trailing zeros cut, in any locale. "0" for what is not finite.
std::string svg_number(double value, int decimals = 2) {
  if (!std::isfinite(value)) return "0";
  std::array<char, 400> buffer{};
  const auto [end, code] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  if (code != std::errc{}) return "0";
  std::string text{buffer.data(), end};
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

/// Where a marker, or a dash, changes: every series that has the same colour has another one.
std::size_t round_of(std::size_t series) { return series / kColors.size(); }

struct Axis {
  Range range;
  double step{1.0};
  int decimals{0};

  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> values;
    const double first = std::ceil(range.first / step - 1e-9);
    for (double k = first; k * step <= range.second + 1e-9 * step; k += 1.0) values.push_back(k * step);
    return values;
  }
};

/// The smallest of 1, 2, 5 times a power of ten that makes at most `most` steps of the range.
double round_step(double width, int most) {
  const double power = std::pow(10.0, std::floor(std::log10(width / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * most >= width * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

/// An axis over the range; one that was not given is widened to whole steps.
Axis axis_of(Range range, bool given, int most_steps, double min_step) {
  if (!given && !(range.first < range.second)) {
    const double around = range.first == 0.0 ? 1.0 : 0.1 * std::abs(range.first);
    range = {range.first - around, range.first + around};
  }
  Axis axis{range, std::max(min_step, round_step(range.second - range.first, most_steps)), 0};
  if (!given) {
    axis.range.first = axis.step * std::floor(range.first / axis.step + 1e-9);
    axis.range.second = axis.step * std::ceil(range.second / axis.step - 1e-9);
  }
  axis.decimals = std::max(0, static_cast<int>(-std::floor(std::log10(axis.step) + 1e-9)));
  return axis;
}

void widen(Range& range, const std::vector<double>& values) {
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.first = std::min(range.first, value);
    range.second = std::max(range.second, value);
  }
}

/// From the smallest to the largest of the values; 0 to 1 without any.
Range range_of(const Plot& plot, bool along_x) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const PlotSeries& series : plot.series) {
    widen(range, along_x ? series.x : series.y);
    if (along_x) continue;
    widen(range, series.low);
    widen(range, series.high);
  }
  return range.first <= range.second ? range : Range{0.0, 1.0};
}

/// Characters of UTF-8 text.
std::size_t length_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

std::string attribute(std::string_view name, double value) {
  std::string text{' '};
  text.append(name).append("=\"").append(svg_number(value)).append("\"");
  return text;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot)
      : plot_{plot},
        x_{axis_of(plot.x_range.value_or(range_of(plot, true)), plot.x_range.has_value(), 10, plot.min_x_step)},
        y_{axis_of(plot.y_range.value_or(range_of(plot, false)), plot.y_range.has_value(), 6, 0.0)} {
    std::size_t longest = 0;
    for (const double tick : y_.ticks()) longest = std::max(longest, svg_number(tick, y_.decimals).size());
    left_ = 34.0 + kDigit_px * static_cast<double>(longest);
    right_ = plot.width_px - kMarginRight_px - legend_width();
    bottom_ = plot.height_px - kMarginBottom_px;
  }

  std::string finish() {
    const std::string width = std::to_string(plot_.width_px);
    const std::string height = std::to_string(plot_.height_px);
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"" + width + "\" height=\"" + height +
           "\" viewBox=\"0 0 " + width + ' ' + height + "\" font-family=\"sans-serif\" font-size=\"12\">\n<title>" +
           xml_escaped(plot_.title) + "</title>\n<rect width=\"" + width + "\" height=\"" + height +
           "\" fill=\"#ffffff\"/>\n";
    draw_axes();
    for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_band(i);
    for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_curve(i);
    draw_legend();
    return svg_ + "</svg>\n";
  }

 private:
  /// A point on the picture; beyond the axes it stays at their ends.
  struct Point {
    double u;
    double v;
  };

  [[nodiscard]] double u_of(double x) const {
    return left_ + (right_ - left_) * (x - x_.range.first) / (x_.range.second - x_.range.first);
  }
  [[nodiscard]] double v_of(double y) const {
    const double share = (y - y_.range.first) / (y_.range.second - y_.range.first);
    return bottom_ - (bottom_ - kMarginTop_px) * std::clamp(share, 0.0, 1.0);
  }
  [[nodiscard]] bool shows(double x) const {
    const double slack = 1e-9 * (x_.range.second - x_.range.first);
    return x >= x_.range.first - slack && x <= x_.range.second + slack;  // false for NaN
  }
  [[nodiscard]] bool shows_y(double y) const { return y >= y_.range.first && y <= y_.range.second; }

  [[nodiscard]] double legend_width() const {
    std::size_t longest = 0;
    for (const PlotSeries& series : plot_.series) longest = std::max(longest, length_of(series.name));
    if (longest == 0) return 0.0;
    return std::min(50.0 + kDigit_px * static_cast<double>(longest), 0.4 * plot_.width_px);
  }

  void text(double u, double v, std::string_view anchor, const std::string& content, std::string_view more = "") {
    svg_ += "<text" + attribute("x", u) + attribute("y", v) + " text-anchor=\"" + std::string{anchor} + '"' +
            std::string{more} + '>' + xml_escaped(content) + "</text>\n";
  }

  void line(const Point& a, const Point& b, std::string_view stroke) {
    svg_ += "<line" + attribute("x1", a.u) + attribute("y1", a.v) + attribute("x2", b.u) + attribute("y2", b.v) +
            " stroke=\"" + std::string{stroke} + "\"/>\n";
  }

  void draw_axes() {
    for (const double tick : y_.ticks()) {
      line({left_, v_of(tick)}, {right_, v_of(tick)}, "#e3e3e3");
      text(left_ - 8.0, v_of(tick) + 4.0, "end", svg_number(tick, y_.decimals));
    }
    for (const double tick : x_.ticks()) {
      line({u_of(tick), bottom_}, {u_of(tick), bottom_ + 5.0}, "#333333");
      text(u_of(tick), bottom_ + 19.0, "middle", svg_number(tick, x_.decimals));
    }
    line({left_, bottom_}, {right_, bottom_}, "#333333");
    line({left_, kMarginTop_px}, {left_, bottom_}, "#333333");
    text(left_, 24.0, "start", plot_.title, " font-size=\"15\" font-weight=\"bold\"");
    text(0.5 * (left_ + right_), bottom_ + 42.0, "middle", plot_.x_label);
    const double middle = 0.5 * (kMarginTop_px + bottom_);
    text(16.0, middle, "middle", plot_.y_label, " transform=\"rotate(-90 16 " + svg_number(middle) + ")\"");
  }

  [[nodiscard]] static std::string_view color(std::size_t i) { return kColors[i % kColors.size()]; }

  /// Goes to a point, drawing or not.
  static void go(std::string& path, const Point& p, bool drawing) {
    path += drawing ? 'L' : 'M';
    path += svg_number(p.u);
    path += ' ';
    path += svg_number(p.v);
  }

  /// The band of one stretch of the series, forth along its high ends and back along its low ends.
  void draw_band(std::size_t i) {
    const PlotSeries& series = plot_.series[i];
    if (series.low.empty()) return;
    std::string path;
    const auto drawn = [&](std::size_t k) {
      return k < series.x.size() && shows(series.x[k]) && std::isfinite(series.low[k]) && std::isfinite(series.high[k]);
    };
    for (std::size_t begin = 0; begin < series.x.size(); ++begin) {
      if (!drawn(begin)) continue;
      std::size_t end = begin;
      while (drawn(end)) ++end;
      for (std::size_t k = begin; k < end; ++k) go(path, {u_of(series.x[k]), v_of(series.high[k])}, k > begin);
      for (std::size_t k = end; k > begin; --k) go(path, {u_of(series.x[k - 1]), v_of(series.low[k - 1])}, true);
      path += 'Z';
      begin = end;
    }
    if (path.empty()) return;
    svg_ += "<path d=\"" + path + "\" fill=\"" + std::string{color(i)} + "\" fill-opacity=\"0.18\"/>\n";
  }

  void draw_curve(std::size_t i) {
    const PlotSeries& series = plot_.series[i];
    std::string path;
    std::vector<Point> points;
    bool pen_down = false;
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      const bool drawn = shows(series.x[k]) && std::isfinite(series.y[k]);
      if (drawn) {
        const Point p{u_of(series.x[k]), v_of(series.y[k])};
        go(path, p, pen_down);
        if (shows_y(series.y[k])) points.push_back(p);
      }
      pen_down = drawn;
    }
    if (path.empty()) return;
    svg_ += "<path d=\"" + path + "\" fill=\"none\" stroke-width=\"2\" stroke-linejoin=\"round\"" + stroke(i) + "/>\n";
    constexpr std::size_t kMostMarkers{60};
    if (points.size() > kMostMarkers) return;
    for (const Point& p : points) draw_marker(p, i);
  }

  [[nodiscard]] static std::string stroke(std::size_t i) {
    const std::string_view dashes = kDashes[i % kDashes.size()];
    std::string text = " stroke=\"" + std::string{color(i)} + '"';
    if (!dashes.empty()) text += " stroke-dasharray=\"" + std::string{dashes} + '"';
    return text;
  }

  void draw_marker(const Point& p, std::size_t i) {
    constexpr double kSize_px{3.0};
    const std::string fill = " fill=\"" + std::string{color(i)} + "\"/>\n";
    if ((i + round_of(i)) % 2 == 0) {
      svg_ += "<circle" + attribute("cx", p.u) + attribute("cy", p.v) + attribute("r", kSize_px) + fill;
    } else {
      svg_ += "<rect" + attribute("x", p.u - kSize_px) + attribute("y", p.v - kSize_px) +
              attribute("width", 2.0 * kSize_px) + attribute("height", 2.0 * kSize_px) + fill;
    }
  }

  void draw_legend() {
    double v = kMarginTop_px + 8.0;
    for (std::size_t i = 0; i < plot_.series.size(); ++i, v += kLegendRow_px) {
      if (plot_.series[i].name.empty()) continue;
      const double u = right_ + 14.0;
      std::string path;
      go(path, {u, v}, false);
      go(path, {u + 26.0, v}, true);
      svg_ += "<path d=\"" + path + "\" stroke-width=\"2\"" + stroke(i) + "/>\n";
      draw_marker({u + 13.0, v}, i);
      text(u + 32.0, v + 4.0, "start", plot_.series[i].name);
    }
  }

  const Plot& plot_;
  Axis x_;
  Axis y_;
  double left_{0.0};
  double right_{0.0};
  double bottom_{0.0};
  std::string svg_;
};

bool rises(const std::optional<Range>& range) {
  return !range || (std::isfinite(range->first) && std::isfinite(range->second) && range->first < range->second);
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  SACCADE_EXPECTS(plot.width_px >= 200 && plot.height_px >= 150 && rises(plot.x_range) && rises(plot.y_range));
  for (const PlotSeries& series : plot.series) {
    SACCADE_EXPECTS(series.x.size() == series.y.size() && series.low.size() == series.high.size());
    SACCADE_EXPECTS(series.low.empty() || series.low.size() == series.x.size());
  }
  return Drawing{plot}.finish();
}

}  // namespace saccade
