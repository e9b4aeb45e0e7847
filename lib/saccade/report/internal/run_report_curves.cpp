// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/run_report_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "saccade/core/result.hpp"
#include "saccade/report/html_text.hpp"
#include "saccade/report/sheet.hpp"

namespace saccade {
namespace {

constexpr double kWidth{520.0};
constexpr double kHeight{220.0};
constexpr double kLeft{78.0};  // room for "1 000 000" and "1 000 ms"
constexpr double kRight{14.0};
constexpr double kTop{16.0};
constexpr double kBottom{30.0};

/// A coordinate: tenths of a pixel are enough.
std::string at(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string rect(double x, double y, double width, double height, const std::string& css_class,
                 const std::string& title) {
  return "<rect class=\"" + css_class + "\" x=\"" + at(x) + "\" y=\"" + at(y) + "\" width=\"" + at(width) +
         "\" height=\"" + at(height) + "\"><title>" + html_escaped(title) + "</title></rect>";
}

std::string text(double x, double y, const char* anchor, const std::string& content) {
  return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" text-anchor=\"" + anchor + "\">" + html_escaped(content) +
         "</text>";
}

/// Axes, and where values fall between them.
class Chart {
 public:
  Chart(const std::string& title, const std::vector<std::string>& positions, const ColorBar& axis,
        const std::string& unit)
      : count_{positions.size()}, high_{axis.high} {
    svg_ = "<svg class=\"chart\" role=\"img\" viewBox=\"0 0 " + at(kWidth) + ' ' + at(kHeight) + "\" aria-label=\"" +
           html_escaped(title) + "\">";
    for (int i = 0; i < axis.ticks; ++i) {
      const double value = axis.high * i / (axis.ticks - 1);
      svg_ += "<line class=\"" + std::string{i == 0 ? "axis" : "grid"} + "\" x1=\"" + at(kLeft) + "\" x2=\"" +
              at(kWidth - kRight) + "\" y1=\"" + at(y(value)) + "\" y2=\"" + at(y(value)) + "\"/>";
      svg_ += text(kLeft - 8.0, y(value) + 4.0, "end", number_text(value, axis.decimals) + unit);
    }
    constexpr std::size_t kMostNames{14};
    const std::size_t step = (count_ + kMostNames - 1) / kMostNames;
    for (std::size_t i = 0; i < count_; i += std::max<std::size_t>(step, 1)) {
      svg_ += text(x(i), kHeight - 9.0, "middle", positions[i]);
    }
  }

  [[nodiscard]] double slot() const { return (kWidth - kLeft - kRight) / static_cast<double>(std::max(count_, kOne)); }
  [[nodiscard]] double x(std::size_t i) const { return kLeft + slot() * (static_cast<double>(i) + 0.5); }
  [[nodiscard]] double y(double value) const {
    const double share = std::clamp(value / high_, 0.0, 1.0);
    return kHeight - kBottom - (kHeight - kBottom - kTop) * share;
  }
  /// A bar between two values around a position.
  void bar(std::size_t i, double low, double high, const std::string& css_class, const std::string& title) {
    const double width = std::min(0.66 * slot(), 40.0);
    svg_ += rect(x(i) - width / 2.0, y(high), width, std::max(0.0, y(low) - y(high)), css_class, title);
  }
  void add(const std::string& element) { svg_ += element; }
  [[nodiscard]] std::string finish() const { return svg_ + "</svg>"; }

 private:
  static constexpr std::size_t kOne{1};
  std::string svg_;
  std::size_t count_;
  double high_;
};

bool drawn(const std::optional<double>& value) { return value && std::isfinite(*value); }

ColorBar axis_of(const ViewCurve& curve) {
  double high = curve.threshold.value_or(0.0);
  for (const auto& value : curve.values) high = std::max(high, drawn(value) ? *value : 0.0);
  if (curve.high) high = *curve.high;
  return round_bar(std::isfinite(high) && high > 0.0 ? high : 1.0, {});
}

/// What is said of a value when the pointer rests on it.
std::string told(const ViewCurve& curve, std::size_t i) {
  return curve.positions[i] + ": " + number_text(*curve.values[i], curve.decimals) + curve.unit;
}

void draw_threshold(Chart& chart, const ViewCurve& curve) {
  if (!drawn(curve.threshold)) return;
  const std::string y = at(chart.y(*curve.threshold));
  chart.add("<line class=\"threshold\" x1=\"" + at(kLeft) + "\" x2=\"" + at(kWidth - kRight) + "\" y1=\"" + y +
            "\" y2=\"" + y + "\"><title>" +
            html_escaped("threshold: " + number_text(*curve.threshold, curve.decimals)) + "</title></line>");
}

}  // namespace

std::string line_svg(const ViewCurve& curve) {
  SACCADE_EXPECTS(curve.positions.size() == curve.values.size());
  Chart chart{curve.title, curve.positions, axis_of(curve), curve.unit};
  draw_threshold(chart, curve);
  std::string points;
  const auto end_line = [&] {
    if (!points.empty()) chart.add("<polyline class=\"curve\" points=\"" + points + "\"/>");
    points.clear();
  };
  std::string dots;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    if (!drawn(curve.values[i])) {
      end_line();
      continue;
    }
    const std::string x = at(chart.x(i));
    const std::string y = at(chart.y(*curve.values[i]));
    points += (points.empty() ? "" : " ") + x + ',' + y;
    dots += "<circle class=\"dot\" cx=\"" + x + "\" cy=\"" + y + "\" r=\"4\"><title>" + html_escaped(told(curve, i)) +
            "</title></circle>";
  }
  end_line();
  chart.add(dots);
  return chart.finish();
}

std::string bars_svg(const ViewCurve& curve) {
  SACCADE_EXPECTS(curve.positions.size() == curve.values.size());
  Chart chart{curve.title, curve.positions, axis_of(curve), curve.unit};
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    if (drawn(curve.values[i])) chart.bar(i, 0.0, *curve.values[i], "bar", told(curve, i));
  }
  draw_threshold(chart, curve);
  return chart.finish();
}

std::string stacked_svg(const PhaseCurve& curve) {
  SACCADE_EXPECTS(curve.positions.size() == curve.ms.size());
  double longest_ms{0.0};
  for (const std::vector<double>& phases : curve.ms) {
    double sum{0.0};
    for (const double ms : phases) sum += std::isfinite(ms) ? std::max(0.0, ms) : 0.0;
    longest_ms = std::max(longest_ms, sum);
  }
  const bool seconds = longest_ms >= 2000.0;
  const double per_unit = seconds ? 1000.0 : 1.0;
  const ColorBar axis = round_bar(longest_ms > 0.0 ? longest_ms / per_unit : 1.0, {});
  Chart chart{curve.title, curve.positions, axis, seconds ? " s" : " ms"};
  for (std::size_t i = 0; i < curve.ms.size(); ++i) {
    double low{0.0};
    for (std::size_t phase = 0; phase < curve.ms[i].size(); ++phase) {
      const double ms = curve.ms[i][phase];
      if (!std::isfinite(ms) || ms <= 0.0) continue;
      const std::string name = phase < curve.names.size() ? curve.names[phase] : std::string{};
      chart.bar(i, low, low + ms / per_unit, std::string{'p'} += std::to_string(phase % kPhaseColors),
                curve.positions[i] + ", " + name + ": " + duration_text(ms));
      low += ms / per_unit;
    }
  }
  return chart.finish();
}

}  // namespace saccade
