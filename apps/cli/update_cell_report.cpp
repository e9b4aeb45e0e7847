// SPDX-License-Identifier: Apache-2.0
#include "update_cell_report.hpp"

#include <algorithm>
#include <sstream>

#include "attend.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "server/report_file.hpp"
#include "summary.hpp"
#include "update.hpp"
#include "update_report.hpp"
#include "view_json.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kTaskFolder{"task-"};

/// One line of the summary.
struct CellTask {
  std::size_t actions{0};
  std::size_t regions{0};  ///< with those that an earlier task has left
  std::size_t complete{0};
  std::size_t views{0};
  std::string end;  ///< in words
};

/// "regions_done" as a reader would say it.
std::string end_in_words(const std::string& end) {
  if (end == "hand_came") return "the hand came again";
  if (end == "regions_done") return "nothing is left to look at";
  if (end == "nothing_to_do") return "the hand changed nothing";
  std::string text = end;
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

/// Throws for what is no record of a task.
CellTask cell_task(const json& record) {
  CellTask task;
  task.actions = record.at("actions").size();
  task.regions = record.at("regions").size();
  task.views = record.at("views").size();
  for (const json& region : record.at("regions")) {
    task.complete += region.at("end") == to_string(RegionStatus::done) ? 1 : 0;
  }
  task.end = end_in_words(record.at("stopped_because").get<std::string>());
  if (record.contains("problem")) task.end = record.at("problem").get<std::string>();
  return task;
}

/// Adds to a result what all pages of a cell say of the run.
void add_settings(json& result, const UpdateOptions& options, const ExploreDevices& devices) {
  result["robot"] = options.robot;
  result["fuse_when"] = to_string(options.fuse_when);
  result["voxel_size_m"] = options.run.voxel_size_m;
  result["min_gain"] = options.run.planner.min_gain;
  result["camera"] = camera_to_json(devices.intrinsics());
}

}  // namespace

std::string task_folder(std::size_t number) { return std::string{kTaskFolder} + std::to_string(number); }

Status remove_task_folders(const RunFolder& out) {
  std::error_code code;
  std::vector<std::filesystem::path> earlier;
  for (const auto& entry : std::filesystem::directory_iterator{out.path()}) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kTaskFolder) && std::filesystem::exists(entry.path() / "hand.csv", code)) {
      earlier.push_back(entry.path());
    }
  }
  for (const std::filesystem::path& folder : earlier) {
    std::filesystem::remove_all(folder, code);
    if (code) return Error{Errc::io_failure, "cannot be removed: " + code.message(), folder.string()};
  }
  return {};
}

json task_record(const UpdateOptions& options, const WatchedTask& task, const UpdateFigures& figures,
                 const Box& workspace, std::string_view end) {
  json actions = json::array();
  for (const HandAction& action : task.findings.actions) actions.push_back(action_json(action));
  json regions = json::array();
  for (std::size_t i = 0; i < task.regions.size(); ++i) regions.push_back(region_json(task, figures, i));
  const HandTrajectory& hand = task.trajectory;
  return {{"samples", sample_report_json(task.report)},
          {"duration_s", hand.empty() ? 0.0 : hand.back().time_s - hand.front().time_s},
          {"method", options.method->name},
          {"ms", task.ms},
          {"actions", std::move(actions)},
          {"regions", std::move(regions)},
          {"unknown_after_task", count_unknown(figures.forgotten, workspace)},
          {"views", views_to_json(figures.run.views)},
          {"back", return_json(figures.back)},
          {"stopped_because", end}};
}

Status check_task_record(const json& record) {
  try {
    static_cast<void>(cell_task(record));
    static_cast<void>(record.at("duration_s").get<double>());
    for (const json& region : record.at("regions")) {
      static_cast<void>(region.at("unknown").get<std::vector<std::size_t>>());
      SACCADE_TRY([[maybe_unused]] const RefusalCounts refused, refusals_from_json(region.at("refused")));
    }
  } catch (const json::exception& e) {
    return Error{Errc::corrupt_data, std::string{"no record of a task: "} + e.what(), "update.json"};
  }
  return {};
}

std::string tasks_text(const json& records) {
  std::ostringstream lines;
  const Summary summary{lines};
  if (records.empty()) summary.line("tasks", "none");
  std::size_t number = 0;
  for (const json& record : records) {
    const CellTask task = cell_task(record);
    ++number;
    std::string text = std::to_string(task.actions) + (task.actions == 1 ? " action, " : " actions, ") +
                       std::to_string(task.complete) + " of " + std::to_string(task.regions) + " regions complete, " +
                       std::to_string(task.views) + (task.views == 1 ? " view; " : " views; ") + task.end;
    RefusalCounts refused;
    for (const json& region : record.at("regions")) refused.add(refusals_from_json(region.at("refused")).value());
    if (refused.total() > 0) text += "; refused " + in_words(refused);
    summary.line("task " + std::to_string(number), text);
  }
  return lines.str();
}

Status write_task_page(const UpdateOptions& options, const WatchedTask& task, const RunFolder& folder,
                       const ExploreDevices& devices, const json& document, const json& record) {
  json page = document;
  const json& result = document.at("result");
  page["result"] = record;
  page["result"]["cell"] = result.at("cell");
  page["result"]["task_number"] = result.at("tasks").size();
  add_settings(page["result"], options, devices);
  return server::write_report(folder / "report.html", std::move(page), task_details(task));
}

Status write_cell_page(const UpdateOptions& options, const TsdfSnapshot& map, const Box& workspace,
                       ExploreDevices& devices, const RunFolder& out, const json& document, const Executor& executor) {
  const std::optional<RobotDrawing> robot = drawing_of(devices.arm(), devices.robot().configuration(), {});
  MapPictureConfig config;
  config.robot = robot ? &*robot : nullptr;
  SACCADE_CHECK(write_png(out / "map.png", map_picture(map, workspace, executor, config)));
  json page = document;
  page["result"]["unknown_left"] = count_unknown(map, workspace);
  add_settings(page["result"], options, devices);
  return server::write_report(out / "report.html", std::move(page));
}

}  // namespace saccade::cli
