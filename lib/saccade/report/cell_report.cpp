// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "saccade/report/html_text.hpp"
#include "saccade/report/internal/run_report_page.hpp"
#include "saccade/report/update_report.hpp"

namespace saccade {
namespace {

std::string row_html(const CellTask& task) {
  const bool has_regions = task.regions > 0;
  std::string out =
      "<tr><td><a href=\"" + html_escaped(task.page) + "\">task " + std::to_string(task.number) + "</a></td>";
  for (const std::string& cell :
       {number_text(task.duration_s, 1) + " s", grouped(task.actions),
        has_regions ? grouped(task.complete) + " of " + grouped(task.regions) : std::string{"–"}, grouped(task.views),
        has_regions ? grouped(task.unknown_after_task) : std::string{"–"},
        has_regions ? grouped(task.unknown_at_end) : std::string{"–"}, task.end}) {
    out += "<td>" + html_escaped(cell) + "</td>";
  }
  return out + "</tr>";
}

std::string tasks_html(const std::vector<CellTask>& tasks) {
  std::string out =
      "<section id=\"tasks\"><h2>Tasks</h2><div class=\"scroll\"><table><thead><tr><th>task</th><th>the hand was "
      "inside for</th><th>actions</th><th>regions complete</th><th>views</th><th>unknown in them after the task</th>"
      "<th>at the end</th><th>ended</th></tr></thead><tbody>";
  for (const CellTask& task : tasks) out += row_html(task);
  return out + "</tbody></table></div></section>\n";
}

std::string verdict_of(const std::vector<CellTask>& tasks) {
  if (tasks.empty()) return "The hand has not come yet.";
  std::size_t actions = 0;
  std::size_t views = 0;
  for (const CellTask& task : tasks) {
    actions += task.actions;
    views += task.views;
  }
  const auto counted = [](std::size_t n, const char* one, const char* more) {
    return grouped(n) + ' ' + (n == 1 ? one : more);
  };
  return "The hand came " + counted(tasks.size(), "time", "times") + " and acted at " +
         counted(actions, "place", "places") + "; the robot took " + counted(views, "view", "views") +
         " to look there again.";
}

}  // namespace

std::string cell_report_html(const CellReport& report) {
  std::string sections = tasks_html(report.tasks);
  if (!report.pictures.empty()) {
    FactList facts;
    facts.add("unknown left", grouped(report.unknown_left) + " voxels");
    sections += part_html("map", "The map now", facts, report.pictures);
  }
  FactList facts{"pairs"};
  for (const auto& [name, value] : report.facts) facts.add(name, value);
  facts.add("Saccade", report.version);
  sections += "<section id=\"run\"><h2>Run</h2>" + facts.html() + links_html(report.links) + "</section>\n";
  std::vector<std::pair<std::string, std::string>> parts{{"tasks", "Tasks"}};
  if (!report.pictures.empty()) parts.emplace_back("map", "Map");
  parts.emplace_back("run", "Run");
  return page_html({report.title, report.version, report.settings, verdict_of(report.tasks), parts}, sections);
}

}  // namespace saccade
