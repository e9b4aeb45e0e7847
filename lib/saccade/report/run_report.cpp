// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/run_report.hpp"

#include <algorithm>

#include "saccade/report/html_text.hpp"
#include "saccade/report/internal/run_report_page.hpp"
#include "saccade/report/run_report_parts.hpp"

namespace saccade {
namespace {

std::vector<std::pair<std::string, std::string>> settings_of(const RunReport& report) {
  return {{"scene", report.scene},
          {"strategy", report.strategy},
          {"robot", report.robot},
          {"noise", report.noise},
          {"seed", std::to_string(report.seed)}};
}

std::string verdict(const RunReport& report) {
  const std::size_t n = report.views.size();
  std::string text = n == 0 ? "No view" : n == 1 ? "One view" : grouped(n) + " views";
  text += " after the initial scan.";
  if (report.initial.measures.coverage && report.final.coverage) {
    text += " Coverage went from " + percent_text(*report.initial.measures.coverage) + " to " +
            percent_text(*report.final.coverage) + '.';
  }
  if (!report.stop_reason.empty()) text += ' ' + stop_sentence(report.stop_reason);
  return text;
}

std::string legend_html_of(const RunReport& report) {
  const bool drawn =
      !report.initial.pictures.empty() || std::any_of(report.views.begin(), report.views.end(),
                                                      [](const ShownView& view) { return !view.pictures.empty(); });
  return drawn ? legend_html(report.draws_robot) : std::string{};
}

std::string summary(const RunReport& report) {
  return "<section id=\"summary\"><h2>Summary</h2>" + tiles_html(report) + charts_html(report) + table_html(report) +
         "</section>\n";
}

std::string scan_section(const RunReport& report) {
  FactList facts;
  facts.add("coverage", report.initial.measures.coverage, percent_text);
  facts.add("unknown left", grouped(report.initial.measures.unknown_left) + " voxels");
  facts.add("unknown near objects", report.initial.measures.unknown_near_objects, count_text);
  for (const auto& [name, value] : report.initial.facts) facts.add(name.c_str(), value);
  return part_html("scan", "Initial scan", facts, report.initial.pictures);
}

std::string run_section(const RunReport& report) {
  std::string out = "<section id=\"run\"><h2>Run</h2>";
  FactList facts{"pairs"};
  for (const auto& [name, value] : settings_of(report)) facts.add(name, value);
  if (report.threads > 0) facts.add("threads", grouped(report.threads));
  if (report.min_gain) facts.add("gain threshold", gain_text(*report.min_gain) + ' ' + report.gain_unit);
  for (const auto& [name, value] : report.facts) facts.add(name, value);
  facts.add("Saccade", report.version);
  out += facts.html();
  out += links_html(report.links);
  return out + "</section>\n";
}

}  // namespace

std::string run_report_html(const RunReport& report) {
  std::vector<std::pair<std::string, std::string>> parts{{"summary", "Summary"}, {"scan", "Scan"}};
  for (const ShownView& view : report.views) parts.emplace_back(view_id(view), std::to_string(view.number));
  parts.emplace_back("run", "Run");
  std::string main = summary(report) + legend_html_of(report) + scan_section(report);
  MapFigures before{report.initial.measures.coverage, report.initial.measures.unknown_left};
  for (const ShownView& view : report.views) {
    main += part_html(view_id(view), "View " + std::to_string(view.number), view_facts(view, before, report.gain_unit),
                      view.pictures);
    before = {view.record.measures.coverage, view.record.measures.unknown_left};
  }
  main += run_section(report);
  return page_html({report.title, report.version, settings_of(report), verdict(report), parts}, main);
}

}  // namespace saccade
