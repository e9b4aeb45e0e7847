// SPDX-License-Identifier: Apache-2.0
#include "update_report.hpp"

#include "explore_report.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/update_pictures.hpp"
#include "server/report_file.hpp"
#include "view_json.hpp"

namespace saccade::cli {

using nlohmann::json;

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

json task_details(const WatchedTask& task) {
  json time_s = json::array();
  json speed_m_s = json::array();
  const std::vector<SmoothedPoint>& motion = task.findings.motion;
  for (const SmoothedPoint& point : motion) {
    time_s.push_back(point.time_s - motion.front().time_s);
    speed_m_s.push_back(point.speed_mps);
  }
  return {{"speed", {{"time_s", std::move(time_s)}, {"speed_m_s", std::move(speed_m_s)}}}};
}

Status write_update_report(const WatchedTask& task, const RunFolder& out, const json& document) {
  return server::write_report(out / "report.html", document, task_details(task));
}

}  // namespace saccade::cli
