// SPDX-License-Identifier: Apache-2.0
#pragma once
// ComparisonReport and comparison_report_html: strategies side by side, scene by scene, as one HTML page.

#include <string>
#include <utility>
#include <vector>

#include "saccade/report/plot.hpp"
#include "saccade/report/run_report.hpp"

namespace saccade {

/// One row of a table; as many cells as the table has columns.
struct ComparisonRow {
  std::string name;
  std::vector<std::string> cells;
};

/// Which of the first views point at an object, as in Table 3.3 of the thesis.
struct ComparisonMarks {
  std::string strategy;
  std::string run;          ///< for example "seed 3"
  std::vector<bool> marks;  ///< view by view
};

/// Time by phase, a bar of the page.
struct ComparisonTimes {
  std::string strategy;
  std::vector<double> ms;  ///< as many as phases
};

/// One scene, or all of them.
struct ComparisonSection {
  std::string title;
  std::vector<std::string> facts;  ///< one sentence each, such as why runs stopped
  std::vector<Plot> plots;
  std::vector<std::string> columns;    ///< of the table of figures
  std::vector<ComparisonRow> rows;     ///< figures
  std::vector<ComparisonRow> shares;   ///< by strategy: what share of the runs' k-th views point at an object
  std::vector<ComparisonMarks> marks;  ///< run by run; folded up on the page
  std::vector<std::string> phases;     ///< names of what time is spent on
  std::vector<ComparisonTimes> times;  ///< of a run, on average
};

struct ComparisonReport {
  std::string title;
  std::string version;                                        ///< of the program
  std::vector<std::pair<std::string, std::string>> settings;  ///< one line; those without a value are left out
  std::string verdict;                                        ///< one sentence or more
  std::vector<ComparisonSection> sections;
  std::vector<std::pair<std::string, std::string>> facts;  ///< of the comparison as a whole
  std::vector<ReportLink> links;
};

/// The page: UTF-8, well-formed as XML but for its doctype, nothing in it from elsewhere. All text is escaped.
[[nodiscard]] std::string comparison_report_html(const ComparisonReport& report);

}  // namespace saccade
