// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/comparison_report.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/result.hpp"
#include "saccade/report/html_text.hpp"
#include "saccade/report/internal/run_report_curves.hpp"
#include "saccade/report/internal/run_report_page.hpp"
#include "saccade/report/run_report_parts.hpp"

namespace saccade {
namespace {

std::string table_html(const std::string& corner, const std::vector<std::string>& columns,
                       const std::vector<ComparisonRow>& rows) {
  std::string out = "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">" + html_escaped(corner) + "</th>";
  for (const std::string& column : columns) out += "<th scope=\"col\">" + html_escaped(column) + "</th>";
  out += "</tr></thead><tbody>";
  for (const ComparisonRow& row : rows) {
    SACCADE_EXPECTS(row.cells.size() == columns.size());
    out += "<tr><td>" + html_escaped(row.name) + "</td>";
    for (const std::string& cell : row.cells) out += "<td>" + html_escaped(cell) + "</td>";
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

std::vector<std::string> view_columns(std::size_t count) {
  std::vector<std::string> columns;
  for (std::size_t k = 1; k <= count; ++k) columns.push_back("view " + std::to_string(k));
  return columns;
}

/// "✓", "×", and nothing for views that were not taken.
std::string marks_html(const std::vector<ComparisonMarks>& marks) {
  std::size_t most = 0;
  for (const ComparisonMarks& run : marks) most = std::max(most, run.marks.size());
  std::vector<ComparisonRow> rows;
  for (const ComparisonMarks& run : marks) {
    ComparisonRow row{run.strategy + ", " + run.run, std::vector<std::string>(most)};
    for (std::size_t k = 0; k < run.marks.size(); ++k) row.cells[k] = run.marks[k] ? "\u2713" : "\u00d7";
    rows.push_back(std::move(row));
  }
  return "<details><summary>Run by run: \u2713 points at an object, \u00d7 does not</summary>" +
         table_html("run", view_columns(most), rows) + "</details>";
}

double total_ms(const ComparisonTimes& times) {
  double sum = 0.0;
  for (const double ms : times.ms) sum += ms;
  return sum;
}

/// A stacked bar per strategy, the longest as wide as the page.
std::string times_html(const ComparisonSection& section) {
  double longest_ms = 0.0;
  for (const ComparisonTimes& times : section.times) longest_ms = std::max(longest_ms, total_ms(times));
  if (!(longest_ms > 0.0)) return {};
  std::vector<bool> occurs(section.phases.size());
  std::string bars;
  for (const ComparisonTimes& times : section.times) {
    SACCADE_EXPECTS(times.ms.size() == section.phases.size());
    bars += "<dt>" + html_escaped(times.strategy) + " <span class=\"soft\">" + duration_text(total_ms(times)) +
            "</span></dt><dd>";
    for (std::size_t i = 0; i < times.ms.size(); ++i) {
      const int permille = static_cast<int>(std::lround(1000.0 * times.ms[i] / longest_ms));
      if (permille == 0) continue;
      occurs[i] = true;
      bars += "<span class=\"p" + std::to_string(i % kPhaseColors) +
              "\" style=\"width:" + std::to_string(permille / 10) + '.' + std::to_string(permille % 10) +
              "%\" title=\"" + html_escaped(section.phases[i] + ": " + duration_text(times.ms[i])) + "\"></span>";
    }
    bars += "</dd>";
  }
  std::string key;
  for (std::size_t i = 0; i < section.phases.size(); ++i) {
    if (!occurs[i]) continue;
    key += "<li><span class=\"swatch p" + std::to_string(i % kPhaseColors) + "\"></span>" +
           html_escaped(section.phases[i]) + "</li>";
  }
  return "<h3>Time per phase, mean of a run</h3><dl class=\"bars\">" + bars + "</dl><ul class=\"key\">" + key + "</ul>";
}

std::string section_html(const std::string& id, const ComparisonSection& section) {
  std::string out = "<section id=\"" + id + "\"><h2>" + html_escaped(section.title) + "</h2>";
  for (const std::string& fact : section.facts) out += "<p class=\"soft\">" + html_escaped(fact) + "</p>";
  if (!section.plots.empty()) {
    out += "<div class=\"charts\">";
    for (const Plot& plot : section.plots) out += "<figure class=\"plot\">" + plot_svg(plot) + "</figure>";
    out += "</div>";
  }
  out += table_html("mean ± 95 % confidence", section.columns, section.rows);
  if (!section.shares.empty()) {
    out += "<h3>Views that point at an object</h3>" +
           table_html("share of the runs", view_columns(section.shares.front().cells.size()), section.shares);
  }
  if (!section.marks.empty()) out += marks_html(section.marks);
  return out + times_html(section) + "</section>\n";
}

std::string comparison_section(const ComparisonReport& report) {
  FactList facts{"pairs"};
  for (const auto& [name, value] : report.facts) facts.add(name, value);
  facts.add("Saccade", report.version);
  return "<section id=\"comparison\"><h2>Comparison</h2>" + facts.html() + links_html(report.links) + "</section>\n";
}

}  // namespace

std::string comparison_report_html(const ComparisonReport& report) {
  PageHead head{report.title, report.version, report.settings, report.verdict, {}};
  std::string main;
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    const std::string id = "part-" + std::to_string(i + 1);
    head.parts.emplace_back(id, report.sections[i].title);
    main += section_html(id, report.sections[i]);
  }
  head.parts.emplace_back("comparison", "Comparison");
  main += comparison_section(report);
  return page_html(head, main);
}

}  // namespace saccade
