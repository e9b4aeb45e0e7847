// SPDX-License-Identifier: Apache-2.0
#pragma once
// The parts of the run report: figures in words, lists of facts, tiles, charts, the table of views, pictures, legend.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "saccade/report/run_report.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// A share in [0, 1] as "93.4 %".
[[nodiscard]] std::string percent_text(double share);
[[nodiscard]] std::string count_text(std::size_t count);
/// Whole gains without decimals, others with two.
[[nodiscard]] std::string gain_text(double gain);
/// With its sign, "+" and "±0" included.
[[nodiscard]] std::string signed_text(double value, int decimals);
/// Why the run stopped, as a sentence.
[[nodiscard]] std::string stop_sentence(const std::string& stop_reason);
/// nullopt: not evaluated.
[[nodiscard]] std::optional<double> gain_of(const ShownView& view);
/// Phases that took time in one of the views.
[[nodiscard]] std::vector<Phase> phases_of(std::span<const ShownView> views);
[[nodiscard]] double total_ms(const ShownView& view);
/// " (candidates 0.4 ms, evaluation 31 ms)".
[[nodiscard]] std::string phases_text(const ShownView& view);

/// Names and values as a description list. Empty names and values are left out.
class FactList {
 public:
  explicit FactList(std::string css_class = "facts") : css_class_{std::move(css_class)} {}
  void add(std::string_view name, std::string_view value);
  /// Nothing where there is no value.
  template <class T, class Format>
  void add(std::string_view name, const std::optional<T>& value, const Format& format) {
    if (value) add(name, format(*value));
  }
  [[nodiscard]] std::string html() const;

 private:
  std::string css_class_;
  std::string items_;
};

/// A label, a large figure, and a line that says more; in a list of the class "tiles".
[[nodiscard]] std::string tile_html(std::string_view label, const std::string& value, const std::string& more = {});
/// Headline figures.
[[nodiscard]] std::string tiles_html(const RunReport& report);
/// Coverage, unknown left, gain and time over the views; what has no values has no chart.
[[nodiscard]] std::string charts_html(const RunReport& report);
/// One row per view, with a link to it. Empty without views.
[[nodiscard]] std::string table_html(const RunReport& report);
/// A colour of the pictures, or several from left to right, and what it stands for.
struct LegendItem {
  std::vector<Rgb8> colors;
  std::string text;
  bool is_outline{false};
};
/// What colours in the pictures stand for.
[[nodiscard]] std::string legend_html(bool draws_robot, const std::vector<LegendItem>& more = {});
/// Time of each phase over the views, stacked. Empty without phases.
/// @param first  name of the position before the first view.
[[nodiscard]] std::string time_chart_html(std::span<const ShownView> views, const std::string& first);
/// A figure; empty for what is no PNG. Pictures much wider than high take the whole width.
[[nodiscard]] std::string picture_html(const ReportPicture& picture);

}  // namespace saccade
