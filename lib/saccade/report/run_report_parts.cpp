// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/run_report_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/html_text.hpp"
#include "saccade/report/internal/run_report_curves.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/view_picture.hpp"

namespace saccade {
namespace {

constexpr double kMillimetres{1000.0};

std::string millimetres(double metres) { return number_text(kMillimetres * metres, 2) + " mm"; }

template <class Get>
bool any_view(const RunReport& report, const Get& get) {
  return std::any_of(report.views.begin(), report.views.end(), [&](const ShownView& view) { return get(view); });
}

std::vector<std::string> positions_of(std::span<const ShownView> views, const std::string& first) {
  std::vector<std::string> positions{first};
  for (const ShownView& view : views) positions.push_back(std::to_string(view.number));
  return positions;
}

std::string chart(const std::string& title, const std::string& svg, const std::string& key = {}) {
  return "<figure><figcaption>" + html_escaped(title) + "</figcaption>" + svg + key + "</figure>";
}

/// A column of the table: its head, and what stands in it for a view.
struct Column {
  std::string head;
  std::function<std::string(const ShownView&)> cell;
};

std::vector<Column> columns_of(const RunReport& report) {
  // The cells outlive this function: nothing is captured by reference.
  const auto number = [](const auto& value, const auto& format) { return value ? format(*value) : std::string{"–"}; };
  std::vector<Column> columns;
  if (any_view(report, [](const ShownView& view) { return gain_of(view).has_value(); })) {
    columns.push_back({"gain, " + report.gain_unit, [=](const ShownView& v) { return number(gain_of(v), gain_text); }});
  }
  if (any_view(report, [](const ShownView& view) { return view.record.candidates > 0; })) {
    columns.push_back({"candidates", [](const ShownView& v) { return grouped(v.record.candidates); }});
  }
  if (any_view(report, [](const ShownView& view) { return view.record.measures.coverage.has_value(); })) {
    columns.push_back(
        {"coverage", [=](const ShownView& v) { return number(v.record.measures.coverage, percent_text); }});
  }
  columns.push_back({"unknown left", [](const ShownView& v) { return grouped(v.record.measures.unknown_left); }});
  if (any_view(report, [](const ShownView& view) { return view.record.measures.unknown_near_objects.has_value(); })) {
    columns.push_back({"unknown near objects",
                       [=](const ShownView& v) { return number(v.record.measures.unknown_near_objects, count_text); }});
  }
  if (any_view(report, [](const ShownView& view) { return view.record.reveals_object.has_value(); })) {
    const auto word = [](bool yes) { return std::string{yes ? "yes" : "no"}; };
    columns.push_back(
        {"points at an object", [=](const ShownView& v) { return number(v.record.reveals_object, word); }});
  }
  if (any_view(report, [](const ShownView& view) { return total_ms(view) > 0.0; })) {
    columns.push_back({"time", [](const ShownView& v) { return duration_text(total_ms(v)); }});
  }
  return columns;
}

/// Width and height from the header of a PNG; zeros where there is none.
std::array<unsigned, 2> png_shape(std::span<const std::byte> png) {
  constexpr std::array<unsigned, 8> kSignature{0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
  constexpr std::size_t kHeaderBytes{24};
  if (png.size() < kHeaderBytes) return {};
  for (std::size_t i = 0; i < kSignature.size(); ++i) {
    if (std::to_integer<unsigned>(png[i]) != kSignature[i]) return {};
  }
  std::array<unsigned, 2> shape{};
  for (std::size_t i = 0; i < 8; ++i) shape[i / 4] = shape[i / 4] << 8U | std::to_integer<unsigned>(png[16 + i]);
  return shape;
}

std::string css_color(const Rgb8& color) {
  return "rgb(" + std::to_string(color[0]) + ", " + std::to_string(color[1]) + ", " + std::to_string(color[2]) + ")";
}

std::string swatch(const LegendItem& item, const std::string& css_class = {}) {
  std::string style = (item.is_outline ? "border-color: " : "background: ") + css_color(item.colors.front());
  if (item.colors.size() > 1) {
    style = "background: linear-gradient(90deg";
    for (const Rgb8& color : item.colors) style += ", " + css_color(color);
    style += ")";
  }
  const std::string shape = item.colors.size() > 1 ? " wide" : item.is_outline ? " ring" : css_class;
  return "<li><span class=\"swatch" + shape + "\" style=\"" + style + "\"></span>" + html_escaped(item.text) + "</li>";
}

}  // namespace

std::string percent_text(double share) { return number_text(100.0 * share, 1) + " %"; }

std::string count_text(std::size_t count) { return grouped(count); }

std::string gain_text(double gain) { return number_text(gain, gain == std::floor(gain) ? 0 : 2); }

std::string signed_text(double value, int decimals) {
  if (!std::isfinite(value)) return number_text(value, decimals);
  const std::string size = number_text(std::abs(value), decimals);
  if (size.find_first_of("123456789") == std::string::npos) return "±" + size;
  return value > 0.0 ? "+" + size : number_text(value, decimals);
}

std::string stop_sentence(const std::string& stop_reason) {
  if (stop_reason == "regions_done") return "It stopped because no view gains enough any more.";
  if (stop_reason == "views_used_up") return "It stopped at the number of views it was given.";
  if (stop_reason == "no_candidate") return "It stopped because none of the views that gain enough can be reached.";
  if (stop_reason == "cancelled") return "It was interrupted.";
  return "It stopped: " + stop_reason + ".";
}

std::optional<double> gain_of(const ShownView& view) {
  const double gain = view.record.gain_predicted;
  return std::isnan(gain) ? std::nullopt : std::optional{gain};
}

std::vector<Phase> phases_of(std::span<const ShownView> views) {
  std::vector<Phase> phases;
  std::copy_if(kPhaseNames.values.begin(), kPhaseNames.values.end(), std::back_inserter(phases), [&](Phase phase) {
    return std::any_of(views.begin(), views.end(),
                       [&](const ShownView& view) { return view.record.times.ms(phase) > 0.0; });
  });
  return phases;
}

double total_ms(const ShownView& view) { return view.record.times.total_ms(); }

std::string phases_text(const ShownView& view) {
  const std::vector<Phase> phases = phases_of(std::span{&view, 1});
  if (phases.empty()) return {};
  const auto shown = [&](Phase phase) {
    return std::string{text_of(phase)} + ' ' + duration_text(view.record.times.ms(phase));
  };
  return " (" + joined(phases, ", ", shown) + ")";
}

void FactList::add(std::string_view name, std::string_view value) {
  if (name.empty() || value.empty()) return;
  const bool boxed = css_class_ == "facts";
  items_ += std::string{boxed ? "<div>" : ""} + "<dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(value) +
            "</dd>" + (boxed ? "</div>" : "");
}

std::string FactList::html() const {
  return items_.empty() ? std::string{} : "<dl class=\"" + css_class_ + "\">" + items_ + "</dl>";
}

std::string tile_html(std::string_view label, const std::string& value, const std::string& more) {
  return "<div><dt>" + html_escaped(label) + "</dt><dd class=\"big\">" + html_escaped(value) + "</dd>" +
         (more.empty() ? "" : "<dd class=\"small\">" + html_escaped(more) + "</dd>") + "</div>";
}

std::string tiles_html(const RunReport& report) {
  std::string out = "<dl class=\"tiles\">";
  const Measures& end = report.final;
  if (end.coverage) {
    const auto& before = report.initial.measures.coverage;
    out += tile_html("coverage", percent_text(*end.coverage), before ? percent_text(*before) + " after the scan" : "");
  }
  out += tile_html("unknown left", grouped(end.unknown_left),
                   "voxels, of " + grouped(report.initial.measures.unknown_left) + " after the scan");
  if (end.unknown_near_objects) out += tile_html("near objects", grouped(*end.unknown_near_objects), "unknown voxels");
  if (end.f_score) out += tile_html("F-score", number_text(*end.f_score, 3), "at 5 mm");
  if (end.chamfer_m) out += tile_html("Chamfer distance", millimetres(*end.chamfer_m));
  if (end.accuracy_m) out += tile_html("accuracy", millimetres(*end.accuracy_m));
  double time_ms{0.0};
  for (const ShownView& view : report.views) time_ms += total_ms(view);
  out += tile_html("views", grouped(report.views.size()), time_ms > 0.0 ? "in " + duration_text(time_ms) : "");
  return out + "</dl>";
}

std::string charts_html(const RunReport& report) {
  if (report.views.empty()) return {};
  ViewCurve coverage{"Coverage", {}, positions_of(report.views, "scan"), {}, {}, 1, " %"};
  ViewCurve unknown{"Unknown left, voxels", {}, positions_of(report.views, "scan"), {}, {}, 0, ""};
  ViewCurve gain{
      "Predicted gain, " + report.gain_unit, {{}}, positions_of(report.views, "scan"), {}, report.min_gain, 0, ""};
  const auto percent = [](const std::optional<double>& share) {
    return share ? std::optional{100.0 * *share} : std::nullopt;
  };
  coverage.high = 100.0;
  coverage.values.push_back(percent(report.initial.measures.coverage));
  unknown.values.emplace_back(static_cast<double>(report.initial.measures.unknown_left));
  for (const ShownView& view : report.views) {
    coverage.values.push_back(percent(view.record.measures.coverage));
    unknown.values.emplace_back(static_cast<double>(view.record.measures.unknown_left));
    gain.values.push_back(gain_of(view));
  }
  const auto has_values = [](const ViewCurve& curve) {
    return std::any_of(curve.values.begin(), curve.values.end(), [](const auto& value) { return value.has_value(); });
  };
  std::string out;
  if (has_values(coverage)) out += chart(coverage.title, line_svg(coverage));
  out += chart(unknown.title, line_svg(unknown));
  if (has_values(gain)) {
    std::string key;
    if (report.min_gain)
      key = "<p class=\"key\">dashed: below " + html_escaped(gain_text(*report.min_gain)) + " a region is done</p>";
    out += chart(gain.title, bars_svg(gain), key);
  }
  out += time_chart_html(report.views, "scan");
  return "<div class=\"charts\">" + out + "</div>";
}

std::string time_chart_html(std::span<const ShownView> views, const std::string& first) {
  PhaseCurve curve{"Time per view", {}, {{}}, positions_of(views, first)};
  const std::vector<Phase> phases = phases_of(views);
  if (phases.empty()) return {};
  for (const Phase phase : phases) curve.names.emplace_back(text_of(phase));
  for (const ShownView& view : views) {
    std::vector<double>& ms = curve.ms.emplace_back();
    for (const Phase phase : phases) ms.push_back(view.record.times.ms(phase));
  }
  std::string key = "<ul class=\"key\">";
  for (std::size_t i = 0; i < curve.names.size(); ++i) {
    key += "<li><span class=\"swatch p" + std::to_string(i % kPhaseColors) + "\"></span>" +
           html_escaped(curve.names[i]) + "</li>";
  }
  return chart(curve.title, stacked_svg(curve), key + "</ul>");
}

std::string table_html(const RunReport& report) {
  if (report.views.empty()) return {};
  const std::vector<Column> columns = columns_of(report);
  std::string out = "<div class=\"scroll\"><table><thead><tr><th>view</th>";
  for (const Column& column : columns) out += "<th>" + html_escaped(column.head) + "</th>";
  out += "</tr></thead><tbody>";
  for (const ShownView& view : report.views) {
    const std::string index = std::to_string(view.number);
    out += "<tr><td><a href=\"#view-" + index + "\">" + index + "</a></td>";
    for (const Column& column : columns) out += "<td>" + html_escaped(column.cell(view)) + "</td>";
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

std::string legend_html(bool draws_robot, const std::vector<LegendItem>& more) {
  constexpr int kStops{6};
  std::vector<Rgb8> gains;
  for (int i = 0; i <= kStops; ++i) gains.push_back(amount_colors()(static_cast<double>(i) / kStops));
  TernaryPictureConfig with_region;
  with_region.unknown_within = {Sphere{}};
  const LegendEntry region = ternary_legend(with_region).back();
  std::string items;
  for (const LegendEntry& entry : ternary_legend()) items += swatch({{entry.color}, entry.text});
  items += swatch({{region.color}, region.text, true});
  items += swatch({gains, "candidates, by the best gain at each place"});
  for (const CandidateMark& mark : candidate_marks(draws_robot)) {
    items += swatch({{mark.color}, mark.text, !mark.is_point}, mark.is_point ? " point" : "");
  }
  for (const LegendItem& item : more) items += swatch(item);
  return "<section id=\"legend\"><h2>How to read the pictures</h2><ul class=\"key\">" + items + "</ul></section>\n";
}

std::string picture_html(const ReportPicture& picture) {
  constexpr unsigned kWide{17};  // tenths of the height
  const auto [width, height] = png_shape(picture.png);
  if (width == 0 || height == 0) return {};
  const bool wide = 10 * static_cast<std::uint64_t>(width) > kWide * static_cast<std::uint64_t>(height);
  std::string out = wide ? "<figure class=\"wide\">" : "<figure>";
  out += "<img width=\"" + std::to_string(width) + "\" height=\"" + std::to_string(height) + "\" alt=\"" +
         html_escaped(picture.alt) + "\"";
  if (!picture.kind.empty()) out += " data-kind=\"" + html_escaped(picture.kind) + "\"";
  out += " src=\"data:image/png;base64," + base64(picture.png) + "\"/>";
  if (!picture.caption.empty()) out += "<figcaption>" + html_escaped(picture.caption) + "</figcaption>";
  return out + "</figure>\n";
}

}  // namespace saccade
