// SPDX-License-Identifier: Apache-2.0
#include "server/show/run_reader.hpp"

#include "saccade/arm/urdf.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "server/show/arm_reading.hpp"
#include "server/show/open_document.hpp"
#include "server/show/run_facts.hpp"
#include "server/show/run_layers.hpp"
#include "server/show/stand_upright.hpp"

namespace saccade::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::string text_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

json entry_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() ? *found : json(nullptr);
}

/// Converts a journal to the form of a result.
json result_of_journal(const json& journal) {
  json result = entry_in(journal, "settings");
  if (!result.is_object()) result = json::object();
  result["camera"] = entry_in(result, "intrinsics");
  result["initial"] = entry_in(journal, "initial");
  result["views"] = entry_in(journal, "views");
  result["final"] = result["initial"];
  if (result["views"].is_array() && !result["views"].empty()) result["final"] = result["views"].back();
  return result;
}

std::string task_name(std::size_t number) { return "task-" + std::to_string(number); }

/// Returns what to do with a folder that holds no run, to follow that.
std::string way_to_its_page(const fs::path& folder) {
  const fs::path whole = (folder / "").parent_path();  // without a slash at the end
  const fs::path above = whole.has_parent_path() ? whole.parent_path() : ".";
  std::string way;
  if (whole.filename().string().starts_with("task-") && is_there(above / "update.json"))
    way = "; it is a task of an update, so show " + above.string();
  for (const char* page : {"report.html", "index.html"}) {
    if (is_there(whole / page)) return way + "; open " + (whole / page).string() + " in a browser";
  }
  return way;
}

std::string title_of(const json& result, const fs::path& folder) {
  const std::string command = text_in(result, "command");
  const std::string scene = text_in(result, "scene");
  if (command == "explore") return "Exploration of " + scene;
  if (const std::string cell = text_in(result, "cell"); command == "update" && !cell.empty())
    return "Updates of " + cell;
  if (command == "update") return "Update of " + scene;
  const std::string name = folder.filename().empty() ? folder.parent_path().filename().string()  // "run/"
                                                     : folder.filename().string();
  return command == "fuse" ? "Fusion: " + name : name;
}

std::array<double, 2> fov_in(const json& result) {
  const json camera = entry_in(result, "camera");
  if (!camera.is_object()) return {0.0, 0.0};
  PinholeCamera pinhole;
  pinhole.fx = camera.value("fx", pinhole.fx);
  pinhole.fy = camera.value("fy", pinhole.fy);
  pinhole.cx = camera.value("cx", pinhole.cx);
  pinhole.cy = camera.value("cy", pinhole.cy);
  pinhole.width = camera.value("width", pinhole.width);
  pinhole.height = camera.value("height", pinhole.height);
  return pinhole.validate() ? fov_of(pinhole) : std::array<double, 2>{0.0, 0.0};
}

}  // namespace

RunReader::RunReader(fs::path folder, const Executor& executor, std::optional<Eigen::Vector3d> up)
    : folder_{std::move(folder)}, executor_{executor}, up_{std::move(up)} {}

Result<SceneDocument> RunReader::read(bool live) {
  try {
    SACCADE_TRY(json record, read_record());
    json result = entry_in(record, "result");
    if (!result.is_object()) result = json::object();
    result["command"] = text_in(record, "command");
    SACCADE_CHECK(read_steps(result));
    const json tasks = entry_in(result, "tasks");
    if (tasks.is_array()) {  // as the facts of a run have it
      result["scene"] = entry_in(result, "cell");
      result["views"] = json::array();
      for (RecordedView& recorded : views_in(result)) result["views"].push_back(std::move(recorded.view));
    }
    SceneDocument document;
    document.record = std::move(record);
    document.folder = folder_;
    document.title = title_of(result, folder_);
    document.kind = DocumentKind::run;
    document.live = live;
    document.facts = facts_of_run(result);
    if (tasks.is_array()) document.facts.emplace_back("tasks", std::to_string(tasks.size()));
    if (!live && result.value("unfinished", false)) document.facts.emplace_back("state", "interrupted");
    if (!why_no_arm_.empty()) document.facts.emplace_back("arm", why_no_arm_);
    SACCADE_CHECK(add_end(document));
    add_trajectory(document);
    for (const ReadStep& read : steps_) {
      document.steps.push_back(read.step);
      document.layers.insert(document.layers.end(), read.layers.begin(), read.layers.end());
    }
    return document;
  } catch (const json::exception& e) {
    return Error{Errc::corrupt_data, "the run's figures are not what they should be: " + message_of(e),
                 folder_.string()};
  }
}

Result<json> RunReader::read_record() const {
  if (is_there(folder_ / "journal.json")) {
    SACCADE_TRY(const json journal, read_json(folder_ / "journal.json"));
    if (!journal.is_object()) return Error{Errc::corrupt_data, "is not a journal", (folder_ / "journal.json").string()};
    json result = result_of_journal(journal);
    result["unfinished"] = true;
    return json{{"command", "explore"}, {"seed", entry_in(result, "seed")}, {"result", std::move(result)}};
  }
  for (const char* name : {"run.json", "update.json"}) {
    if (!is_there(folder_ / name)) continue;
    SACCADE_TRY(json run, read_json(folder_ / name));
    if (!run.is_object() || !entry_in(run, "result").is_object()) {
      return Error{Errc::corrupt_data, "is not a result of saccade", (folder_ / name).string()};
    }
    return run;
  }
  if (is_there(folder_ / "map.sacmap") || is_there(folder_ / "mesh.ply")) return json(nullptr);
  return Error{Errc::not_found,
               "holds no run: neither run.json nor update.json, map.sacmap or mesh.ply" + way_to_its_page(folder_),
               folder_.string()};
}

std::vector<RunReader::RecordedView> RunReader::views_in(const json& result) {
  std::vector<RecordedView> recorded;
  const auto add = [&](const json& views, std::size_t task) {
    const std::size_t count = views.is_array() ? views.size() : 0;
    for (std::size_t i = 0; i < count; ++i) recorded.push_back({i + 1, task, views[i]});
  };
  const json tasks = entry_in(result, "tasks");
  if (!tasks.is_array()) add(entry_in(result, "views"), 0);
  for (std::size_t i = 0; tasks.is_array() && i < tasks.size(); ++i) add(entry_in(tasks[i], "views"), i + 1);
  return recorded;
}

Status RunReader::read_steps(const json& result) {
  const bool has_scan = entry_in(result, "initial").is_object();
  const std::vector<RecordedView> views = views_in(result);
  if (has_scan && steps_.empty()) {
    ReadStep scan;
    SACCADE_TRY(const ScanRecord record, in_file(scan_from_json(result["initial"]), folder_));
    scan.step = {"Scan", std::nullopt, fov_in(result), facts_of_scan(record), pictures_of_view(folder_, 0)};
    SACCADE_CHECK(add_map(0, scan));
    steps_.push_back(std::move(scan));
  }
  const std::size_t before_views = has_scan ? 1 : 0;
  for (std::size_t i = steps_.size() - std::min(steps_.size(), before_views); i < views.size(); ++i) {
    SACCADE_CHECK(read_step(result, views[i]));
  }
  if (steps_.empty()) {
    std::vector<StepPicture> pictures = pictures_in(folder_);
    if (!pictures.empty()) steps_.push_back({{"Pictures", std::nullopt, {}, {}, std::move(pictures)}, {}});
  }
  return {};
}

Status RunReader::read_step(const json& result, const RecordedView& recorded) {
  const auto& [number, task, view] = recorded;
  ReadStep read;
  const fs::path folder = task == 0 ? folder_ : folder_ / task_name(task);
  SACCADE_TRY(const ViewRecord record, in_file(view_from_json(view), folder / ("view " + std::to_string(number))));
  read.step = {"View " + std::to_string(number), record.T_world_camera, fov_in(result), facts_of_view(record),
               pictures_of_view(folder, number)};
  if (task == 0) {
    SACCADE_CHECK(add_choice(result, number, read));
    SACCADE_CHECK(add_map(number, read));
  } else {  // tasks keep neither
    read.step.name = "Task " + std::to_string(task) + ", view " + std::to_string(number);
    for (StepPicture& picture : read.step.pictures) picture.name = task_name(task) + "/" + picture.name;
  }
  add_arm(result, record.q, read);
  steps_.push_back(std::move(read));
  return {};
}

Status RunReader::add_choice(const json& result, std::size_t number, ReadStep& out) {
  const auto read = read_view_choice(folder_, number);
  if (!read) return read.error().code == Errc::not_found ? Status{} : Status{read.error()};
  const ViewChoice& choice = *read->choice;
  const std::size_t step = steps_.size();
  if (!choice.candidates.empty()) out.layers.push_back(candidates_layer(choice.candidates, fov_in(result), step));
  if (last_map_ && last_map_->step + 1 == number) {
    out.layers.push_back(hits_layer(last_map_->map, choice, *out.step.T_world_camera, step, executor_));
    SACCADE_CHECK(add_attention(*last_map_, choice, step, out.layers));
  }
  out.layers.push_back(region_layer(choice.region, step));
  if (read->path.size() > 1) out.layers.push_back(path_layer(read->path, step));
  return {};
}

Status RunReader::add_attention(const StepMap& before, const ViewChoice& choice, std::size_t step,
                                std::vector<Layer>& layers) {
  SACCADE_TRY(const SeenAttention seen, attention_.look(before.map, executor_));
  const LayerPlace place{"-" + std::to_string(step), step};
  const bool same_segments = !choice.saliency.empty() && choice.saliency.size() == seen.surface->points.segments();
  if (same_segments) {
    layers.push_back(saliency_layer(before.map, before.mesh, seen.surface->points, choice.saliency, place, executor_));
  }
  if (auto contours = contours_layer(seen.contours, same_segments ? choice.segment : std::nullopt, place)) {
    layers.push_back(std::move(*contours));
  }
  return {};
}

Status RunReader::add_map(std::size_t number, ReadStep& out) {
  const fs::path path = folder_ / view_file(number, ".sacmap");
  if (!is_there(path)) return {};
  SACCADE_TRY(TsdfSnapshot map, load_map(path, executor_));
  TriangleMesh mesh = extract_mesh(map, executor_);
  const LayerPlace place{"-" + std::to_string(steps_.size()), steps_.size()};
  Layer surface = triangles_layer("surface" + place.suffix, kSurfaceName, mesh);
  surface.step = place.step;
  out.layers.insert(out.layers.begin(), std::move(surface));
  if (auto frontier = frontier_layer(map, place)) out.layers.push_back(std::move(*frontier));
  last_map_ = StepMap{number, std::move(map), std::move(mesh)};
  return {};
}

void RunReader::add_arm(const json& result, const std::optional<Configuration>& q, ReadStep& out) {
  const std::string name = text_in(result, "robot");
  if (!q || name.empty()) return;
  if (name != arm_name_) {
    const auto reading = arm_reading_from_json(entry_in(result, "arm_reading"));
    auto read = reading ? find_robot(name, *reading) : Result<UrdfArm>{reading.error()};
    why_no_arm_ = read ? "" : "not shown: " + read.error().to_string();
    arm_ = read ? std::optional{std::move(read->arm)} : std::nullopt;
    arm_name_ = name;
  }
  if (!arm_) return;
  if (q->size() != arm_->dof()) {
    why_no_arm_ = "not shown: " + name + " has other joints than the arm of the run";
    return;
  }
  if (q->allFinite()) out.layers.push_back(arm_layer(*arm_, *q, steps_.size()));
}

/// Adds the run's final result where steps have no maps.
Status RunReader::add_end(SceneDocument& document) const {
  if (last_map_) {
    const TsdfSnapshot& map = last_map_->map;
    document.bounds = bounds_of_map(map, last_map_->mesh);
    SACCADE_CHECK(stand_upright(document, folder_ / "", last_map_->mesh.vertices, {.up = up_}, false));
    if (map.config.workspace) document.layers.push_back(box_layer("workspace", "Workspace", *map.config.workspace));
    return {};
  }
  if (is_there(folder_ / "map.sacmap")) {
    SACCADE_TRY(const TsdfSnapshot map, load_map(folder_ / "map.sacmap", executor_));
    const TriangleMesh mesh = extract_mesh(map, executor_);
    document.bounds = bounds_of_map(map, mesh);
    SACCADE_CHECK(stand_upright(document, folder_ / "", mesh.vertices, {.up = up_}, false));
    SACCADE_TRY(document.layers, layers_of_map(map, mesh, executor_));
  } else if (is_there(folder_ / "mesh.ply")) {
    SACCADE_TRY(const TriangleMesh mesh, read_mesh(folder_ / "mesh.ply"));
    document.bounds = bounds_of_points(mesh.vertices);
    SACCADE_CHECK(stand_upright(document, folder_ / "", mesh.vertices, {.up = up_}, false));
    document.layers.push_back(triangles_layer("surface", kSurfaceName, mesh));
  } else {
    document.bounds = bounds_of_points({});
  }
  if (is_there(folder_ / "before.sacmap")) {
    SACCADE_TRY(const TsdfSnapshot before, load_map(folder_ / "before.sacmap", executor_));
    document.layers.push_back(triangles_layer("before", "Surface before", extract_mesh(before, executor_)));
    document.layers.back().visible = false;
  }
  return {};
}

/// Adds the camera's trajectory of a fusion; anything else is ignored.
void RunReader::add_trajectory(SceneDocument& document) const {
  if (!is_there(folder_ / "trajectory.txt")) return;
  const auto trajectory = read_tum_trajectory(folder_ / "trajectory.txt");
  if (!trajectory || trajectory->size() < 2) return;
  std::vector<Eigen::Vector3d> centers;
  for (const StampedPose& stamped : *trajectory) centers.push_back(stamped.T_world_camera.translation());
  document.layers.push_back(path_layer(centers, std::nullopt));
}

Result<SceneDocument> run_document(const fs::path& folder, const Executor& executor,
                                   const std::optional<Eigen::Vector3d>& up) {
  return RunReader{folder, executor, up}.read(false);
}

}  // namespace saccade::server
