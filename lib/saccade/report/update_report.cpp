// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/update_report.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/report/html_text.hpp"
#include "saccade/report/internal/run_report_page.hpp"
#include "saccade/report/sheet.hpp"

namespace saccade {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

constexpr const char* kNothing{"–"};

Pairs settings_of(const UpdateReport& report) {
  return {{"scene", report.scene},
          {"hand", report.hand},
          {"actions by", report.method},
          {"fused", report.fuse_when},
          {"robot", report.robot},
          {"noise", report.noise},
          {"seed", std::to_string(report.seed)}};
}

std::size_t complete_regions(const UpdateReport& report) {
  return static_cast<std::size_t>(std::count_if(report.regions.begin(), report.regions.end(),
                                                [](const ReportRegion& region) { return region.end == "complete"; }));
}

std::string counted(std::size_t n, const std::string& what) {
  return (n == 0 ? "no" : n == 1 ? "one" : grouped(n)) + ' ' + what + (n == 1 ? "" : "s");
}

std::string verdict(const UpdateReport& report) {
  if (report.regions.empty()) return "The hand did nothing that the robot would look at again.";
  std::string text = "The hand acted at " + counted(report.regions.size(), "place") + ". The robot took " +
                     counted(report.views.size(), "view") + " to look there again; ";
  const std::size_t complete = complete_regions(report);
  if (report.regions.size() == 1) {
    return text + (complete == 1 ? "the region is complete." : "the region ended: " + report.regions[0].end + '.');
  }
  return text +
         (complete == report.regions.size() ? "all regions are"
                                            : grouped(complete) + " of " + grouped(report.regions.size()) +
                                                  " regions " + (complete == 1 ? "is" : "are")) +
         " complete.";
}

/// A table of text; the first column to the left.
std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& cell : head) out += "<th>" + html_escaped(cell) + "</th>";
  out += "</tr></thead><tbody>";
  for (const std::vector<std::string>& row : rows) {
    out += "<tr>";
    for (const std::string& cell : row) out += "<td>" + html_escaped(cell) + "</td>";
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

template <class T, class Format>
std::string text_or_nothing(const std::optional<T>& value, const Format& format) {
  return value ? format(*value) : std::string{kNothing};
}

std::string in_millimetres(double metres) { return number_text(1000.0 * metres, 1); }

std::string place_of(const ReportRegion& region) {
  std::string out = "(";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out += (axis == 0 ? "" : ", ") + number_text(region.center_m[axis], 2);
  }
  return out + ") m";
}

/// The lines of a table without the columns in which no line has anything.
struct Lines {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;

  [[nodiscard]] std::string html() const {
    if (rows.empty()) return {};
    Lines kept;
    kept.rows.resize(rows.size());
    for (std::size_t column = 0; column < head.size(); ++column) {
      const auto has_text = [column](const std::vector<std::string>& row) {
        return !row[column].empty() && row[column] != kNothing;
      };
      if (std::none_of(rows.begin(), rows.end(), has_text)) continue;
      kept.head.push_back(head[column]);
      for (std::size_t i = 0; i < rows.size(); ++i) kept.rows[i].push_back(rows[i][column]);
    }
    return table(kept.head, kept.rows);
  }
};

std::string regions_html(const UpdateReport& report) {
  Lines lines{{"region", "centre", "radius", "end", "unknown after the task", "at the end", "objects covered",
               "surfaces covered", "why"},
              {}};
  for (const ReportRegion& region : report.regions) {
    const bool counted_in = !region.unknown.empty();
    lines.rows.push_back({std::to_string(region.number), place_of(region), number_text(region.radius_m, 2) + " m",
                          region.end, counted_in ? grouped(region.unknown.front()) : kNothing,
                          counted_in ? grouped(region.unknown.back()) : kNothing,
                          text_or_nothing(region.coverage_objects, percent_text),
                          text_or_nothing(region.coverage_surfaces, percent_text), region.why});
  }
  return lines.html();
}

std::size_t unknown_sum(const UpdateReport& report, bool at_the_end) {
  std::size_t sum = 0;
  for (const ReportRegion& region : report.regions) {
    if (!region.unknown.empty()) sum += at_the_end ? region.unknown.back() : region.unknown.front();
  }
  return sum;
}

std::string tiles(const UpdateReport& report) {
  std::string out;
  out += tile_html("regions complete", grouped(complete_regions(report)) + " of " + grouped(report.regions.size()));
  if (unknown_sum(report, false) > 0) {
    out += tile_html("unknown in the regions", grouped(unknown_sum(report, true)),
                     "voxels, of " + grouped(unknown_sum(report, false)) + " after the task");
  }
  if (report.final.coverage) {
    out += tile_html("coverage", percent_text(*report.final.coverage),
                     report.coverage_after_task ? percent_text(*report.coverage_after_task) + " after the task" : "");
  }
  double error_m = 0.0;
  int errors = 0;
  for (const ReportObject& object : report.objects) {
    for (const ReportMeasure& measure : object.measures) {
      if (!measure.true_m || !measure.measured_m) continue;
      error_m += std::abs(*measure.measured_m - *measure.true_m);
      ++errors;
    }
  }
  if (errors > 0) out += tile_html("mean error of lengths", in_millimetres(error_m / errors) + " mm", "of the objects");
  if (report.final.f_score) out += tile_html("F-score", number_text(*report.final.f_score, 3), "at 5 mm");
  double time_ms = 0.0;
  for (const ShownView& view : report.views) time_ms += total_ms(view);
  for (const auto& [name, ms] : report.once_ms) time_ms += ms;
  out += tile_html("views", grouped(report.views.size()), time_ms > 0.0 ? "in " + duration_text(time_ms) : "");
  return "<dl class=\"tiles\">" + out + "</dl>";
}

std::string summary(const UpdateReport& report) {
  return "<section id=\"summary\"><h2>Summary</h2>" + tiles(report) + "</section>\n";
}

std::string before_section(const UpdateReport& report) {
  FactList facts;
  facts.add("coverage", report.before.measures.coverage, percent_text);
  facts.add("unknown left", grouped(report.before.measures.unknown_left) + " voxels");
  facts.add("unknown near objects", report.before.measures.unknown_near_objects, count_text);
  for (const auto& [name, value] : report.before.facts) facts.add(name, value);
  return part_html("before", "Before the task", facts, report.before.pictures);
}

std::string figures_html(const std::vector<ReportPicture>& pictures) {
  std::string figures;
  for (const ReportPicture& picture : pictures) figures += picture_html(picture);
  return figures.empty() ? figures : "<div class=\"pictures\">" + figures + "</div>";
}

std::string plot_html(const std::string& svg) {
  return svg.empty() ? std::string{} : "<figure class=\"plot\">" + svg + "</figure>";
}

std::string task_section(const UpdateReport& report) {
  FactList facts;
  for (const auto& [name, value] : report.task_facts) facts.add(name, value);
  return "<section id=\"task\"><h2>The task</h2>" + facts.html() + figures_html(report.task_pictures) +
         regions_html(report) + plot_html(report.speed_svg) + "</section>\n";
}

/// As Table 2.8, with all phases.
std::string phases_html(const UpdateReport& report) {
  Lines lines{{"phase", "per view", "in all"}, {}};
  for (const auto& [name, ms] : report.once_ms) lines.rows.push_back({name, kNothing, duration_text(ms)});
  for (const Phase phase : phases_of(report.views)) {
    double sum_ms = 0.0;
    for (const ShownView& view : report.views) sum_ms += view.record.times.ms(phase);
    lines.rows.push_back({std::string{text_of(phase)}, duration_text(sum_ms / static_cast<double>(report.views.size())),
                          duration_text(sum_ms)});
  }
  return lines.rows.empty() ? std::string{} : "<h3>Time by phase</h3>" + lines.html();
}

const ReportRegion* region_of(const UpdateReport& report, const ShownView& view) {
  const auto found = std::find_if(report.regions.begin(), report.regions.end(),
                                  [&](const ReportRegion& region) { return view.region == region.number; });
  return found == report.regions.end() ? nullptr : &*found;
}

/// Unknown voxels in a view's region after it, and before it.
std::optional<std::pair<std::size_t, std::size_t>> unknown_in_region(const UpdateReport& report, std::size_t view) {
  const ReportRegion* region = region_of(report, report.views[view]);
  if (region == nullptr || region->unknown.size() <= view + 1) return std::nullopt;
  return std::pair{region->unknown[view + 1], region->unknown[view]};
}

std::string views_html(const UpdateReport& report) {
  Lines lines{
      {"view", "region", "gain, " + report.gain_unit, "candidates", "unknown in its region", "coverage", "time"}, {}};
  for (std::size_t i = 0; i < report.views.size(); ++i) {
    const ShownView& view = report.views[i];
    const auto unknown = unknown_in_region(report, i);
    lines.rows.push_back(
        {std::to_string(view.number), text_or_nothing(view.region, count_text),
         text_or_nothing(gain_of(view), gain_text), view.record.candidates > 0 ? grouped(view.record.candidates) : "",
         unknown ? grouped(unknown->first) : kNothing, text_or_nothing(view.record.measures.coverage, percent_text),
         total_ms(view) <= 0.0 ? "" : duration_text(total_ms(view))});
  }
  return lines.html();
}

std::string during_section(const UpdateReport& report) {
  std::vector<RegionUnknown> curves;
  for (const ReportRegion& region : report.regions) {
    if (!region.unknown.empty()) curves.push_back({"region " + std::to_string(region.number), region.unknown});
  }
  const std::string time = time_chart_html(report.views, "task");
  return "<section id=\"during\"><h2>Looking again</h2>" +
         plot_html(unknown_plot(curves, "Unknown voxels in the regions")) + views_html(report) + phases_html(report) +
         (time.empty() ? "" : "<div class=\"charts\">" + time + "</div>") + "</section>\n";
}

std::string view_section(const UpdateReport& report, std::size_t i, const MapFigures& before) {
  const ShownView& view = report.views[i];
  FactList facts = view_facts(view, before, report.gain_unit);
  if (const auto unknown = unknown_in_region(report, i)) {
    facts.add("unknown in its region",
              grouped(unknown->first) + " (" +
                  signed_text(static_cast<double>(unknown->first) - static_cast<double>(unknown->second), 0) + ")");
  }
  return part_html(view_id(view), "View " + std::to_string(view.number), facts, view.pictures);
}

std::string objects_html(const UpdateReport& report) {
  Lines lines{{"object", "length", "true, mm", "measured, mm", "error, mm"}, {}};
  for (const ReportObject& object : report.objects) {
    for (const ReportMeasure& measure : object.measures) {
      const bool both = measure.true_m && measure.measured_m;
      lines.rows.push_back({object.name, measure.name, text_or_nothing(measure.true_m, in_millimetres),
                            text_or_nothing(measure.measured_m, in_millimetres),
                            both ? signed_text(1000.0 * (*measure.measured_m - *measure.true_m), 1) : kNothing});
    }
  }
  return lines.rows.empty() ? std::string{} : "<h3>Objects of the task</h3>" + lines.html();
}

std::string after_section(const UpdateReport& report) {
  FactList facts;
  facts.add("coverage", report.final.coverage, percent_text);
  facts.add("unknown left", grouped(report.final.unknown_left) + " voxels");
  facts.add("unknown near objects", report.final.unknown_near_objects, count_text);
  facts.add("accuracy", report.final.accuracy_m, [](double m) { return number_text(1000.0 * m, 2) + " mm"; });
  facts.add("Chamfer distance", report.final.chamfer_m, [](double m) { return number_text(1000.0 * m, 2) + " mm"; });
  return "<section id=\"after\"><h2>After looking again</h2>" + facts.html() + figures_html(report.after_pictures) +
         objects_html(report) + "</section>\n";
}

std::string run_section(const UpdateReport& report) {
  FactList facts{"pairs"};
  for (const auto& [name, value] : settings_of(report)) facts.add(name, value);
  if (report.threads > 0) facts.add("threads", grouped(report.threads));
  if (report.min_gain) facts.add("gain threshold", gain_text(*report.min_gain) + ' ' + report.gain_unit);
  for (const auto& [name, value] : report.facts) facts.add(name, value);
  facts.add("Saccade", report.version);
  return "<section id=\"run\"><h2>Run</h2>" + facts.html() + links_html(report.links) + "</section>\n";
}

std::string legend(const UpdateReport& report) {
  const bool in_views = std::any_of(report.views.begin(), report.views.end(),
                                    [](const ShownView& view) { return !view.pictures.empty(); });
  if (!in_views && report.before.pictures.empty() && report.task_pictures.empty() && report.after_pictures.empty()) {
    return {};
  }
  constexpr int kStops{6};
  std::vector<Rgb8> times;
  for (int i = 0; i <= kStops; ++i) times.push_back(depth_colors()(static_cast<double>(i) / kStops));
  return legend_html(report.draws_robot, {{times, "the hand's way, from its start to its end"},
                                          {{poi_color()}, "points of interest and their regions", true}});
}

}  // namespace

std::string update_report_html(const UpdateReport& report) {
  Pairs parts{{"summary", "Summary"}, {"before", "Before"}, {"task", "Task"}, {"during", "Views"}};
  for (const ShownView& view : report.views) parts.emplace_back(view_id(view), std::to_string(view.number));
  parts.emplace_back("after", "After");
  parts.emplace_back("run", "Run");
  std::string sections =
      summary(report) + legend(report) + before_section(report) + task_section(report) + during_section(report);
  MapFigures before{report.coverage_after_task, report.unknown_after_task};
  for (std::size_t i = 0; i < report.views.size(); ++i) {
    sections += view_section(report, i, before);
    before = {report.views[i].record.measures.coverage, report.views[i].record.measures.unknown_left};
  }
  sections += after_section(report) + run_section(report);
  return page_html({report.title, report.version, settings_of(report), verdict(report), parts}, sections);
}

}  // namespace saccade
