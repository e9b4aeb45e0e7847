// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunReport and run_report_html: an exploration, view by view, as one HTML page. How to read it: docs/report.md.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace saccade {

/// A picture of the page.
struct ReportPicture {
  std::vector<std::byte> png;  ///< the whole file; a picture that is no PNG is left out
  std::string caption;         ///< below it
  std::string alt;             ///< what it shows, for those who do not see it
  std::string kind;            ///< for example "map"; stepping through enlarged pictures stays with one kind
};

/// Time spent on one phase of a view.
struct ReportPhase {
  std::string name;
  double ms{0.0};
};

/// One view that was taken, and the map after it. Figures against the truth are absent where there is none.
struct ReportView {
  std::size_t index{1};        ///< its number on the page, each once; the first view after the scan is 1
  std::optional<double> gain;  ///< as predicted
  std::size_t candidates{0};
  std::optional<double> coverage;  ///< share, 0 to 1
  std::size_t unknown_left{0};     ///< voxels
  std::optional<std::size_t> unknown_near_objects;
  std::optional<bool> points_at_object;
  std::vector<ReportPhase> phases;  ///< the same names in the same order for every view, as far as possible
  std::vector<ReportPicture> pictures;
  std::vector<std::pair<std::string, std::string>> facts{};  ///< further ones, such as the robot's
  std::optional<std::size_t> region{};                       ///< number of the one that it was chosen for
};

/// The map after the initial scan.
struct ReportScan {
  std::optional<double> coverage;
  std::size_t unknown_left{0};
  std::optional<std::size_t> unknown_near_objects;
  std::vector<ReportPicture> pictures;
  std::vector<std::pair<std::string, std::string>> facts{};  ///< further ones, such as poses that were passed over
};

/// The map at the end, against the truth.
struct ReportFinal {
  std::optional<double> coverage;
  std::size_t unknown_left{0};
  std::optional<std::size_t> unknown_near_objects;
  std::optional<double> accuracy_m;
  std::optional<double> chamfer_m;
  std::optional<double> f_score;
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
  ReportScan initial;
  std::vector<ReportView> views;
  ReportFinal final;
  std::vector<ReportLink> links;
};

/// The page: UTF-8, well-formed as XML but for its doctype, nothing in it from elsewhere. O(bytes of the pictures).
[[nodiscard]] std::string run_report_html(const RunReport& report);

}  // namespace saccade
