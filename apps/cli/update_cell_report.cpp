// SPDX-License-Identifier: Apache-2.0
#include "update_cell_report.hpp"

#include <algorithm>
#include <iostream>

#include "attend.hpp"
#include "explore_report.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "summary.hpp"
#include "update.hpp"
#include "update_report.hpp"
#include "view_json.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kTaskFolder{"task-"};

std::string hand_of(const UpdateOptions& options) {
  return options.simulates_hand() ? options.hand_command
                                  : std::filesystem::path{options.trajectory}.filename().string();
}

std::string fused_when(const UpdateOptions& options) {
  return options.fuse_when == FuseWhen::motion ? "at views and in motion (KFOM)" : "at views (KFOVP)";
}

/// "regions_done" as a reader would say it.
std::string end_in_words(const std::string& end) {
  if (end == "hand_came") return "the hand came again";
  if (end == "regions_done") return "nothing is left to look at";
  if (end == "nothing_to_do") return "the hand changed nothing";
  std::string text = end;
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

CellTask cell_task(const json& record, std::size_t number) {
  CellTask task;
  task.number = number;
  task.page = task_folder(number) + "/report.html";
  task.duration_s = record.at("duration_s").get<double>();
  task.actions = record.at("actions").size();
  task.regions = record.at("regions").size();
  task.views = record.at("views").size();
  for (const json& region : record.at("regions")) {
    task.complete += region.at("end") == to_string(RegionStatus::done) ? 1 : 0;
    const json& unknown = region.at("unknown");
    if (unknown.empty()) continue;
    task.unknown_after_task += unknown.front().get<std::size_t>();
    task.unknown_at_end += unknown.back().get<std::size_t>();
  }
  task.end = end_in_words(record.at("stopped_because").get<std::string>());
  if (record.contains("problem")) task.end = record.at("problem").get<std::string>();
  return task;
}

/// Facts of the run that every page has.
std::vector<std::pair<std::string, std::string>> facts_of(const UpdateOptions& options, const ExploreDevices& devices) {
  std::vector<std::pair<std::string, std::string>> facts{
      {"voxel size", millimetres(options.run.voxel_size_m)},
      {"camera", camera_text(camera_to_json(devices.intrinsics()))},
      {"poses of frames", std::string{to_string(options.run.exploration.tracking)}}};
  if (options.run.as_printed) facts.emplace_back("views", "chosen as the thesis prints it");
  return facts;
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
    static_cast<void>(cell_task(record, 1));
    for (const json& region : record.at("regions")) {
      SACCADE_TRY([[maybe_unused]] const RefusalCounts refused, refusals_from_json(region.at("refused")));
    }
  } catch (const json::exception& e) {
    return Error{Errc::corrupt_data, std::string{"no record of a task: "} + e.what(), "update.json"};
  }
  return {};
}

void print_tasks(const json& records) {
  const Summary summary{std::cout};
  if (records.empty()) summary.line("tasks", "none");
  std::size_t number = 0;
  for (const json& record : records) {
    const CellTask task = cell_task(record, ++number);
    std::string text = std::to_string(task.actions) + (task.actions == 1 ? " action, " : " actions, ") +
                       std::to_string(task.complete) + " of " + std::to_string(task.regions) + " regions complete, " +
                       std::to_string(task.views) + (task.views == 1 ? " view; " : " views; ") + task.end;
    RefusalCounts refused;
    for (const json& region : record.at("regions")) refused.add(refusals_from_json(region.at("refused")).value());
    if (refused.total() > 0) text += "; refused " + in_words(refused);
    summary.line("task " + std::to_string(number), text);
  }
}

Status write_task_page(const UpdateOptions& options, const WatchedTask& task, const UpdateFigures& figures,
                       const RunFolder& folder, const ExploreDevices& devices, const json& document,
                       const json& record) {
  UpdateReport report;
  const json& result = document.at("result");
  report.scene = result.at("cell").get<std::string>();
  report.title = "Task " + std::to_string(result.at("tasks").size()) + " of " + report.scene;
  report.hand = hand_of(options);
  report.method = options.method->name;
  report.fuse_when = fused_when(options);
  report.robot = options.robot;
  report.draws_robot = options.has_arm();
  report.seed = document.at("seed").get<std::uint64_t>();
  report.threads = document.at("threads").get<std::size_t>();
  report.version = document.at("version").get<std::string>();
  report.facts = facts_of(options, devices);
  if (const std::string problem = record.value("problem", ""); !problem.empty()) {
    report.facts.emplace_back("problem", problem);
  }
  report.min_gain = options.run.planner.min_gain;
  report.before.measures.unknown_left = count_unknown(figures.before, figures.before.config.workspace.value());
  report.links = {{"hand.csv", "the hand's trajectory, for saccade attend"},
                  {"../report.html", "all tasks"},
                  {"../map.sacmap", "the map now, for saccade nbv"}};
  return write_task_report(report, task, figures, folder, record);
}

Status write_cell_page(const UpdateOptions& options, const TsdfSnapshot& map, const Box& workspace,
                       ExploreDevices& devices, const RunFolder& out, const json& document, const Executor& executor) {
  const json& result = document.at("result");
  CellReport report;
  report.title = "Updates of " + result.at("cell").get<std::string>();
  report.version = document.at("version").get<std::string>();
  report.settings = {{"hand", hand_of(options)},
                     {"actions by", std::string{options.method->name}},
                     {"fused", fused_when(options)},
                     {"robot", options.robot}};
  report.facts = facts_of(options, devices);
  for (const json& record : result.at("tasks")) report.tasks.push_back(cell_task(record, report.tasks.size() + 1));
  const std::optional<RobotDrawing> robot = drawing_of(devices.arm(), devices.robot().configuration(), {});
  MapPictureConfig config;
  config.robot = robot ? &*robot : nullptr;
  SACCADE_CHECK(write_png(out / "map.png", map_picture(map, workspace, executor, config)));
  report.pictures = picture_of(out, "map.png", "The map now, unknown in black", "The map from outside", "map");
  report.unknown_left = count_unknown(map, workspace);
  report.links = {{"mesh.ply", "the surface, with colours"},
                  {"map.sacmap", "the map, for saccade nbv"},
                  {"update.json", "all figures, for programs"}};
  return write_file_atomically(out / "report.html", cell_report_html(report));
}

}  // namespace saccade::cli
