// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunReport and run_report_html: an exploration, view by view, as one HTML page. How to read it: docs/report.md.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saccade/explore/view_record.hpp"

namespace saccade {

/// A picture of the page.
struct ReportPicture {
  std::vector<std::byte> png;  ///< the whole file; a picture that is no PNG is left out
  std::string caption;         ///< below it
  std::string alt;             ///< what it shows, for those who do not see it
  std::string kind;            ///< for example "map"; stepping through enlarged pictures stays with one kind
};

/// One view that was taken, with what the page shows beside its record.
struct ShownView {
  std::size_t number{1};  ///< on the page, each once; the first view after the scan is 1
  ViewRecord record{};
  std::vector<ReportPicture> pictures{};
  std::vector<std::pair<std::string, std::string>> facts{};  ///< further ones, such as the robot's
  std::optional<std::size_t> region{};                       ///< number of the region on the page, where there are some
};

/// The map after the initial scan.
struct ShownScan {
  Measures measures{};
  std::vector<ReportPicture> pictures{};
  std::vector<std::pair<std::string, std::string>> facts{};  ///< further ones, such as poses that were passed over
};

/// A file beside the page.
struct ReportLink {
  std::string name;  ///< relative, for example "mesh.ply"
  std::string what;  ///< for example "the surface, with colours"
};

/// Everything the page says. Text is plain; the page escapes it. Empty text is left out.
struct RunReport {
  std::string title;
  std::string scene;
  std::string strategy;
  std::string robot;
  bool draws_robot{false};  ///< the pictures show an arm and its camera's way
  std::string noise;
  std::uint64_t seed{0};
  std::size_t threads{0};
  std::string version;  ///< of the program
  /// Further facts, no dates among them: the same run gives the same page but for its durations.
  std::vector<std::pair<std::string, std::string>> facts;
  std::string gain_unit{"rays"};
  std::optional<double> min_gain;  ///< below which a region is done
  /// to_string(StopReason), which the page puts into words; any other text is shown as it is.
  std::string stop_reason;
  ShownScan initial;
  std::vector<ShownView> views;
  Measures final;  ///< the map at the end
  std::vector<ReportLink> links;
};

/// The page: UTF-8, well-formed as XML but for its doctype, nothing in it from elsewhere. O(bytes of the pictures).
[[nodiscard]] std::string run_report_html(const RunReport& report);

}  // namespace saccade
