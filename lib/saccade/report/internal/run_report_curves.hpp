// SPDX-License-Identifier: Apache-2.0
#pragma once
// The curves of the run report: small SVG charts over the views. Colours and type come from the page's style sheet.

#include <optional>
#include <string>
#include <vector>

namespace saccade {

/// Values over the views, position 0 being the initial scan. Nothing is drawn where there is no value.
struct ViewCurve {
  std::string title;
  std::vector<std::optional<double>> values;
  std::vector<std::string> positions;  ///< names of the positions, as many as values
  std::optional<double> high;          ///< upper end of the axis; else a round number above all values
  std::optional<double> threshold;     ///< a dashed line
  int decimals{0};                     ///< in what is shown of the values
  std::string unit;                    ///< after a value, for example " %"
};

/// Line with dots.
[[nodiscard]] std::string line_svg(const ViewCurve& curve);
/// One bar per value.
[[nodiscard]] std::string bars_svg(const ViewCurve& curve);

/// Durations of several phases over the views.
struct PhaseCurve {
  std::string title;
  std::vector<std::string> names;       ///< of the phases, the lowest in the stack first
  std::vector<std::vector<double>> ms;  ///< by position, then by phase
  std::vector<std::string> positions;   ///< as many as ms
};
/// Stacked bars; phase i in the colour of the class "p" and i mod kPhaseColors.
[[nodiscard]] std::string stacked_svg(const PhaseCurve& curve);
constexpr std::size_t kPhaseColors{9};

}  // namespace saccade
