// SPDX-License-Identifier: Apache-2.0
#include "update_report.hpp"

#include <algorithm>
#include <array>

#include "explore_report.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/update_report.hpp"
#include "summary.hpp"
#include "view_json.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

std::string in_words(const std::string& end) {
  if (end == "done") return "complete";
  if (end == "out_of_reach") return "out of reach";
  if (end == "outside_workspace") return "outside the workspace";
  return end == "not_begun" ? "not begun" : end;
}

ReportRegion report_region(const json& region, std::size_t number) {
  ReportRegion shown;
  shown.number = number;
  shown.why = region.at("why").get<std::string>();
  shown.center_m = region.at("center_m").get<std::array<double, 3>>();
  shown.radius_m = region.at("radius_m").get<double>();
  shown.end = in_words(region.at("end").get<std::string>());
  shown.unknown = region.at("unknown").get<std::vector<std::size_t>>();
  const json coverage = region.value("coverage", json::object());  // a real cell has no truth
  if (!coverage.value("objects", json{}).is_null()) shown.coverage_objects = coverage.at("objects").get<double>();
  if (!coverage.value("surfaces", json{}).is_null()) shown.coverage_surfaces = coverage.at("surfaces").get<double>();
  return shown;
}

ReportObject report_object(const json& object) {
  ReportObject shown{object.at("name").get<std::string>(), {}};
  const json& measured = object.at("measured");
  for (const auto& [key, name] :
       {std::pair{"height_m", "height"}, {"major_m", "major axis"}, {"minor_m", "minor axis"}}) {
    ReportMeasure measure{name, object.at("true").at(key).get<double>(), std::nullopt};
    if (!measured.is_null()) measure.measured_m = measured.at(key).get<double>();
    shown.measures.push_back(std::move(measure));
  }
  return shown;
}

void add(std::vector<ReportPicture>& pictures, std::vector<ReportPicture> more) {
  std::move(more.begin(), more.end(), std::back_inserter(pictures));
}

void fill_head(UpdateReport& report, const UpdateOptions& options, const json& document) {
  const json& result = document.at("result");
  report.title = "Update of " + result.at("scene").get<std::string>();
  report.scene = result.at("before").get<std::string>() + " to " + result.at("scene").get<std::string>();
  report.hand = options.simulates_hand() ? "simulated" : std::filesystem::path{options.trajectory}.filename().string();
  report.method = result.at("task").at("method").get<std::string>();
  report.fuse_when = result.at("fuse_when") == "motion" ? "at views and in motion (KFOM)" : "at views (KFOVP)";
  report.robot = result.at("robot").get<std::string>();
  report.draws_robot = options.has_arm();
  report.noise = noise_name(options.run);
  report.seed = document.at("seed").get<std::uint64_t>();
  report.threads = document.at("threads").get<std::size_t>();
  report.version = document.at("version").get<std::string>();
  report.facts = {{"voxel size", millimetres(options.run.voxel_size_m)},
                  {"camera", camera_text(result.at("camera"))},
                  {"back end", document.at("backend").get<std::string>()}};
  if (options.run.as_printed) report.facts.emplace_back("views", "chosen as the thesis prints it");
  report.min_gain = options.run.planner.min_gain;
}

}  // namespace

std::vector<ReportPicture> picture_of(const RunFolder& out, const char* name, const char* caption, const char* alt,
                                      const char* kind) {
  constexpr std::uintmax_t kMaxBytes{std::uintmax_t{64} << 20U};
  const auto bytes = read_text_file(out / name, kMaxBytes);
  if (!bytes) return {};
  const auto* first = reinterpret_cast<const std::byte*>(bytes->data());
  return {{{first, first + bytes->size()}, caption, alt, kind}};
}

Status UpdatePictures::scanned(ScanRecord& /*scan*/, const TsdfSnapshot& map) {
  before_ = map;
  return {};
}

Status UpdatePictures::viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) {
  const std::optional<RobotDrawing> robot = drawing_of(devices_.arm(), view.q, view.path);
  SACCADE_CHECK(draw_view(out_,
                          {T_world_earlier_.size() + 1, before_, map, view, T_world_earlier_, frames, workspace_,
                           devices_.intrinsics(), robot ? &*robot : nullptr},
                          executor_));
  before_ = map;
  T_world_earlier_.push_back(view.T_world_camera);
  return {};
}

Status UpdatePictures::draw_maps(const UpdateFigures& figures) const {
  std::vector<Region> regions;
  for (const RegionOfInterest& region : task_.regions) regions.push_back(region.bounds);
  const TaskScene task{workspace_, task_.trajectory, task_.findings, regions};
  const std::optional<RobotDrawing> robot = drawing_of(devices_.arm(), figures.stand_by, {});
  const std::optional<RobotDrawing> robot_at_end = drawing_of(devices_.arm(), figures.at_end, {});
  TaskPictureConfig config;
  config.region_radius_m = options_.region_radius_m;
  MapPictureConfig map;
  config.robot = map.robot = robot ? &*robot : nullptr;
  SACCADE_CHECK(write_png(out_ / "before.png", map_picture(figures.before, workspace_, executor_, map)));
  SACCADE_CHECK(write_png(out_ / "hand.png", task_picture(figures.before, task, executor_, config)));
  SACCADE_CHECK(write_png(out_ / "regions.png", forgotten_picture(figures.forgotten, task, executor_, config)));
  map.robot = robot_at_end ? &*robot_at_end : nullptr;
  return write_png(out_ / "after.png", map_picture(figures.after, workspace_, executor_, map));
}

Status remove_update_pictures(const RunFolder& out) {
  std::vector<std::string> names{"before.png", "hand.png", "regions.png", "after.png", "report.html"};
  for (const auto& entry : std::filesystem::directory_iterator{out.path()}) {
    std::string name = entry.path().filename().string();
    if (is_view_file(name)) names.push_back(std::move(name));
  }
  return out.remove(std::vector<std::string_view>{names.begin(), names.end()});
}

Status write_task_report(const UpdateReport& about, const WatchedTask& task, const UpdateFigures& figures,
                         const RunFolder& out, const json& record) {
  UpdateReport report = about;
  report.before.pictures =
      picture_of(out, "before.png", "The map before the task, unknown in black", "The map from outside", "map");
  report.task_pictures = picture_of(out, "hand.png", "The hand's way, and where it acted",
                                    "The map before the task with the hand's trajectory", "hand");
  add(report.task_pictures, picture_of(out, "regions.png", "What was forgotten around each action, in black",
                                       "The map with the regions of interest unknown", "regions"));
  report.task_facts = {{"hand", task.report.to_string()}, {"detector", fixed(task.ms, 2) + " ms"}};
  report.speed_svg = speed_plot(task.findings, "Speed of the hand");
  for (const json& region : record.at("regions")) {
    report.regions.push_back(report_region(region, report.regions.size() + 1));
  }
  report.once_ms = {{"forgetting", figures.forgetting_ms}};
  report.unknown_after_task = record.at("unknown_after_task").get<std::size_t>();
  for (const ViewRecord& view : figures.run.views) {
    ShownView shown = shown_view(out, view, report.views.size() + 1);
    shown.region = view.region + 1;
    if (view.frames_on_way > 0) shown.facts.emplace_back("frames on the way", std::to_string(view.frames_on_way));
    report.views.push_back(std::move(shown));
  }
  report.after_pictures = picture_of(out, "after.png", "The map after the update", "The map from outside", "map");
  report.final.unknown_left =
      report.views.empty() ? report.unknown_after_task : report.views.back().record.measures.unknown_left;
  return write_file_atomically(out / "report.html", update_report_html(report));
}

Status write_update_report(const UpdateOptions& options, const WatchedTask& task, const UpdateFigures& figures,
                           const RunFolder& out, const json& document) {
  const json& result = document.at("result");
  UpdateReport report;
  fill_head(report, options, document);
  report.before.measures.unknown_left = result.at("scan").at("unknown_left").get<std::size_t>();
  report.before.facts.emplace_back("views", std::to_string(figures.scan.views));
  if (const std::string refused = in_words(figures.scan.refused); !refused.empty()) {
    report.before.facts.emplace_back("poses passed over", refused);
  }
  for (const json& object : result.at("objects")) report.objects.push_back(report_object(object));
  report.links = {{"mesh.ply", "the surface, with colours"},
                  {"before.sacmap", "the map before the task"},
                  {"map.sacmap", "the map after the update, for saccade nbv"},
                  {"hand.csv", "the hand's trajectory, for saccade attend"},
                  {"update.json", "all figures, for programs"}};
  return write_task_report(report, task, figures, out, result);
}

}  // namespace saccade::cli
