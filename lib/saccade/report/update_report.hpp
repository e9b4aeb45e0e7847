// SPDX-License-Identifier: Apache-2.0
#pragma once
// UpdateReport and update_report_html: a user's task and how the map was brought up to date after it, as one HTML page,
// and its pictures; CellReport and cell_report_html: the tasks of a cell. How to read them: docs/report.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/report/attention_picture.hpp"
#include "saccade/report/robot_drawing.hpp"
#include "saccade/report/run_report.hpp"

namespace saccade {

/// A user's task in the map; world frame.
struct TaskScene {
  Box workspace;
  std::span<const HandSample> trajectory;
  const AttentionFindings& findings;
  std::span<const Region> regions;  ///< of interest
};

struct TaskPictureConfig {
  OverviewConfig overview{.width = 720, .height = 540};
  double margin_m{0.1};                ///< of the map, shown around the workspace
  int samples{1};                      ///< per pixel and direction
  double region_radius_m{0.2};         ///< of the spheres around points of interest
  const RobotDrawing* robot{nullptr};  ///< drawn into the map; not owned
};

/// Fig. 2.16 left and centre: the map before the task, unknown nearly black, with the hand's way coloured by time on a
/// scale below, the Gaussians, if any, and the points of interest with their numbers. The same picture for every thread
/// count.
[[nodiscard]] ColorImage task_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                                      const TaskPictureConfig& config = {});

/// Fig. 2.16 right: the map after the task from the same place, unknown black in the regions alone; they are outlined
/// and have their numbers, from 1.
[[nodiscard]] ColorImage forgotten_picture(const TsdfSnapshot& map, const TaskScene& task, const Executor& executor,
                                           const TaskPictureConfig& config = {});

/// Unknown voxels in a region.
struct RegionUnknown {
  std::string name;
  std::vector<std::size_t> unknown;  ///< after the user's task, then after each view
};
/// Fig. 2.20: one curve per region over the views, 0 being after the user's task, as SVG. Empty without regions.
[[nodiscard]] std::string unknown_plot(std::span<const RegionUnknown> regions, const std::string& title);

/// Where the hand did something, and what became of it.
struct ReportRegion {
  std::size_t number{1};  ///< as in the pictures, each once
  std::string why;
  std::array<double, 3> center_m{};  ///< world frame
  double radius_m{0.0};
  std::string end;                   ///< in words, for example "complete" or "out of reach"
  std::vector<std::size_t> unknown;  ///< voxels in it: after the task, then after each view of the page
  // Of what can be seen at all in the region, the share that the final map has.
  std::optional<double> coverage_objects{};
  std::optional<double> coverage_surfaces{};  ///< with supports
};

/// A length of an object. Metres.
struct ReportMeasure {
  std::string name;  ///< for example "height"
  std::optional<double> true_m;
  std::optional<double> measured_m;
};

/// An object that the task involved. Thesis §2.4.1.
struct ReportObject {
  std::string name;
  std::vector<ReportMeasure> measures;
};

/// Everything the page says. Text is plain; the page escapes it. Empty text and what is absent is left out.
struct UpdateReport {
  std::string title;
  std::string scene;   ///< for example "bottle-before to bottle"
  std::string hand;    ///< where its trajectory came from
  std::string method;  ///< that detected actions
  std::string fuse_when;
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
  ShownScan before;                ///< after the initial scan, before the task
  // The task.
  std::vector<ReportPicture> task_pictures;
  std::vector<std::pair<std::string, std::string>> task_facts;
  std::string speed_svg;  ///< speed_plot; it goes into the page as it is
  std::vector<ReportRegion> regions;
  // Looking again.
  std::vector<std::pair<std::string, double>> once_ms;  ///< phases that are part of no view, such as clearing
  std::vector<ShownView> views;                         ///< with their region's number
  std::size_t unknown_after_task{0};                    ///< voxels of the whole workspace
  std::optional<double> coverage_after_task;
  // After it.
  std::vector<ReportPicture> after_pictures;
  Measures final;
  std::vector<ReportObject> objects;
  std::vector<ReportLink> links;
};

/// The page: UTF-8, well-formed as XML but for its doctype, nothing in it from elsewhere. O(bytes of the pictures).
[[nodiscard]] std::string update_report_html(const UpdateReport& report);

/// One task of a real cell, which has a page of its own.
struct CellTask {
  std::size_t number{1};
  std::string page;        ///< relative, for example "task-1/report.html"
  double duration_s{0.0};  ///< from the hand's entering the workspace to its leaving
  std::size_t actions{0};
  std::size_t regions{0};  ///< with those that an earlier task has left
  std::size_t complete{0};
  std::size_t views{0};
  std::size_t unknown_after_task{0};  ///< voxels in the regions
  std::size_t unknown_at_end{0};
  std::string end;  ///< in words
};

/// What happened in a cell so far.
struct CellReport {
  std::string title;
  std::string version;                                        ///< the program's
  std::vector<std::pair<std::string, std::string>> settings;  ///< one line below the title
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<CellTask> tasks;
  std::vector<ReportPicture> pictures;  ///< the map as it is now
  std::size_t unknown_left{0};          ///< voxels of the workspace
  std::vector<ReportLink> links;
};

/// The page that leads to those of the tasks; otherwise as update_report_html.
[[nodiscard]] std::string cell_report_html(const CellReport& report);

}  // namespace saccade
