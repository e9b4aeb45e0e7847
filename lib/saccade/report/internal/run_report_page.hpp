// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the pages of explorations and updates have in common: the page around its sections, sections with pictures, the
// facts of a view, links to files.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/report/run_report_parts.hpp"

namespace saccade {

/// What stands above the sections of a page. Text is plain.
struct PageHead {
  std::string title;
  std::string version;                                        ///< of the program
  std::vector<std::pair<std::string, std::string>> settings;  ///< one line; those without a value are left out
  std::string verdict;                                        ///< one sentence or more
  std::vector<std::pair<std::string, std::string>> parts;     ///< ids of sections and what the navigation calls them
};
/// The page around its sections, which are HTML.
[[nodiscard]] std::string page_html(const PageHead& head, std::string_view sections);

/// A section: heading and facts above the pictures; beside them where there is but one.
[[nodiscard]] std::string part_html(const std::string& id, const std::string& title, const FactList& facts,
                                    const std::vector<ReportPicture>& pictures);

/// Figures of the map before a view: after the view before it, or after the scan.
struct MapFigures {
  std::optional<double> coverage;
  std::size_t unknown_left{0};
};
[[nodiscard]] FactList view_facts(const ShownView& view, const MapFigures& before, const std::string& gain_unit);
[[nodiscard]] std::string view_id(const ShownView& view);

/// Empty without links.
[[nodiscard]] std::string links_html(const std::vector<ReportLink>& links);

}  // namespace saccade
