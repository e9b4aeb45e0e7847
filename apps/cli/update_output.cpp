// SPDX-License-Identifier: Apache-2.0
// The figures of an update as JSON and as a summary.
#include <algorithm>
#include <sstream>

#include "attend.hpp"
#include "explore_report.hpp"
#include "json_output.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "server/show/arm_reading.hpp"
#include "summary.hpp"
#include "update.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

json task_json(const UpdateOptions& options, const WatchedTask& task) {
  json actions = json::array();
  for (const HandAction& action : task.findings.actions) actions.push_back(action_json(action));
  json places = json::array();
  for (const Eigen::Vector3d& place : task.findings.labels_m) places.push_back(point_json(place));
  return {{"trajectory", options.trajectory}, {"samples", sample_report_json(task.report)},
          {"method", options.method->name},   {"ms", task.ms},
          {"actions", std::move(actions)},    {"true_places_m", std::move(places)}};
}

/// Unknown voxels of one region: after the task, and after each view.
json unknown_json(const UpdateFigures& update, std::size_t region) {
  json counts = json::array();
  if (region < update.unknown_after_task.size()) counts.push_back(update.unknown_after_task[region]);
  for (const UnknownOfRegions& after : update.unknown_after_view) counts.push_back(after.at(region));
  return counts;
}

/// Where the map ends there is nothing to look at again, whatever the robot reaches.
std::string_view end_of(const UpdateFigures& update, std::size_t region) {
  const auto& outcomes = update.run.regions;
  if (region >= outcomes.size()) return to_string(RegionStatus::not_begun);
  return update.unknown_after_task.at(region) == 0 ? "outside_workspace" : to_string(outcomes[region].status);
}

/// Measures how much of the surface in a region the mesh has; nulls where nothing was forgotten, or there is nothing to
/// be seen.
Result<json> coverage_json(const UpdateCase& subject, const UpdateFigures& figures, const Region& region,
                           const MeshDistance* mesh, const Progress& progress, const Executor& executor) {
  RegionCoverage coverage;
  if (!figures.unknown_after_task.empty() && !progress.cancelled()) {
    SACCADE_TRY(const RegionSurface surface, observable_in(*subject.after.rays, region, kTruthSpacing_m, executor));
    coverage = measure_coverage(surface, mesh, figures.after.config.voxel_size_m, executor);
  }
  return json{{"objects", optional_json(coverage.objects)}, {"surfaces", optional_json(coverage.surfaces)}};
}

json shape_json(const ObjectShape& shape) {
  return {{"height_m", shape.height_m}, {"major_m", shape.major_m}, {"minor_m", shape.minor_m}};
}

/// The objects that the task put somewhere.
Result<json> objects_json(const UpdateCase& subject, const TriangleMesh& mesh, const Executor& executor) {
  SACCADE_TRY(const ObjectShapes shapes, ObjectShapes::build(*subject.after.rays));
  json objects = json::array();
  for (const std::size_t object : shapes.objects()) {
    const std::string& name = subject.after.scene.objects.at(object).name;
    const auto changed = std::find_if(subject.changes.begin(), subject.changes.end(),
                                      [&](const SceneChange& change) { return change.object == name; });
    if (changed == subject.changes.end()) continue;
    const ObjectShape& truth = shapes.true_shape(object);
    json entry{{"name", name}, {"true", shape_json(truth)}, {"measured", nullptr}, {"error", nullptr}};
    if (const std::optional<ObjectShape> measured = shapes.measure(object, mesh, executor)) {
      entry["measured"] = shape_json(*measured);
      entry["error"] = shape_json(shape_error(*measured, truth));
    }
    objects.push_back(std::move(entry));
  }
  return objects;
}

/// Seconds of all views per phase, as in Table 2.8.
json phases_json(const UpdateFigures& update) {
  json phases{{"forgetting", 1e-3 * update.forgetting_ms}};
  const json of_views = phases_to_json(update.run.views);
  phases.update(of_views);
  phases["robot"] = update.back.motion_s + of_views.value("robot", 0.0);
  return phases;
}

std::string region_text(const json& region) {
  const json& unknown = region["unknown"];
  std::string text = region["end"].get<std::string>() + ", " + std::to_string(region["views"].get<std::size_t>()) +
                     (region["views"] == 1 ? " view" : " views");
  if (!unknown.empty()) {
    text += ", unknown voxels " + std::to_string(unknown.front().get<std::size_t>()) + " -> " +
            std::to_string(unknown.back().get<std::size_t>());
  }
  if (const json& share = region["coverage"]["surfaces"]; !share.is_null()) {
    text += ", " + percent(share.get<double>()) + " of the surface";
  }
  const std::string refused = in_words(refusals_from_json(region["refused"]).value());
  return text + (refused.empty() ? "" : "; refused " + refused);
}

std::string object_text(const json& object) {
  if (object["error"].is_null()) return "too little of it was seen";
  const auto off = [&](const char* what) { return fixed(1e3 * object["error"][what].get<double>(), 1); };
  return "height " + off("height_m") + " mm, major axis " + off("major_m") + " mm, minor axis " + off("minor_m") +
         " mm off the truth";
}

std::string arm_text(const json& result) {
  const json& back = result["back"];
  const auto touching = result["contacts"]["touching"].get<std::size_t>();
  std::string text = back["at_stand_by"].get<bool>() ? "back at its stand-by" : "not at its stand-by";
  if (!back["refused"].is_null()) text += " (" + back["refused"].get<std::string>() + ")";
  return text +
         (touching == 0 ? ", touched nothing" : ", touched something at " + std::to_string(touching) + " instants");
}

}  // namespace

json return_json(const StandByResult& back) {
  return {{"at_stand_by", back.at_stand_by},
          {"refused", back.refusal ? json(to_string(*back.refusal)) : json(nullptr)},
          {"motion_s", back.motion_s}};
}

json region_json(const WatchedTask& task, const UpdateFigures& figures, std::size_t i) {
  const RegionOfInterest& region = task.regions[i];
  const auto& sphere = std::get<Sphere>(region.bounds);
  const auto& outcomes = figures.run.regions;
  const RegionResult outcome = i < outcomes.size() ? outcomes[i] : RegionResult{};
  const auto& views = figures.run.views;
  const auto taken =
      std::count_if(views.begin(), views.end(), [i](const ViewRecord& view) { return view.region == i; });
  return {{"center_m", point_json(sphere.center)},
          {"radius_m", sphere.radius_m},
          {"saliency", region.saliency},
          {"why", region.why},
          {"end", end_of(figures, i)},
          {"views", taken},
          {"gain_left", outcome.gain_left},
          {"refused", refusals_to_json(outcome.refused)},
          {"unknown", unknown_json(figures, i)}};
}

Result<json> update_json(const UpdateOptions& options, const UpdateCase& subject, const WatchedTask& task,
                         const UpdateFigures& figures, const ExploreDevices& devices, const Executor& executor,
                         const Progress& progress) {
  const TriangleMesh mesh = extract_mesh(figures.after, executor);
  json regions = json::array();
  std::optional<MeshDistance> distance;
  if (!mesh.triangles.empty()) {
    SACCADE_TRY(distance, MeshDistance::build(mesh));
  }
  for (std::size_t i = 0; i < task.regions.size(); ++i) {
    progress.report("measuring", i, task.regions.size());
    json region = region_json(task, figures, i);
    SACCADE_TRY(region["coverage"], coverage_json(subject, figures, task.regions[i].bounds,
                                                  distance ? &*distance : nullptr, progress, executor));
    regions.push_back(std::move(region));
  }
  SACCADE_TRY(json objects, objects_json(subject, mesh, executor));
  return json{{"scene", subject.after.scene.name},
              {"before", subject.before.scene.name},
              {"out", options.out.string()},
              {"robot", options.robot},
              {"arm_reading", server::arm_reading_to_json(options.arm_reading.urdf)},
              {"fuse_when", to_string(options.fuse_when)},
              {"as_printed", options.run.as_printed},
              {"gain_width_px", options.run.gain_width_px},
              {"min_gain", options.run.planner.min_gain},
              {"noise", options.run.noise},
              {"sensor", to_string(options.run.sensor)},
              {"camera", camera_to_json(devices.intrinsics())},
              {"voxel_size_m", options.run.voxel_size_m},
              {"scan",
               {{"views", figures.scan.views},
                {"refused", refusals_to_json(figures.scan.refused)},
                {"at_stand_by", figures.after_scan.at_stand_by},
                {"unknown_left", count_unknown(figures.before, subject.before.scene.workspace)}}},
              {"task", task_json(options, task)},
              {"unknown_after_task", count_unknown(figures.forgotten, subject.before.scene.workspace)},
              {"regions", std::move(regions)},
              {"views", views_to_json(figures.run.views)},
              {"objects", std::move(objects)},
              {"back", options.has_arm() ? return_json(figures.back) : json(nullptr)},
              {"contacts", {{"instants", figures.instants}, {"touching", figures.contacts}}},
              {"phases_s", phases_json(figures)},
              {"interrupted", figures.interrupted || progress.cancelled()},
              {"stopped_because", to_string(figures.run.stopped_because)}};
}

std::string update_text(const UpdateOptions& options, const WatchedTask& task, const json& result) {
  std::ostringstream text;
  const Summary summary{text};
  const json& scan = result["scan"];
  const std::string refused = in_words(refusals_from_json(scan["refused"]).value());
  summary.line("scan",
               std::to_string(scan["views"].get<std::size_t>()) + " views" +
                   (refused.empty() ? "" : ", passed over: " + refused) +
                   (options.has_arm() && !scan["at_stand_by"].get<bool>() ? "; no way back to the stand-by" : ""));
  summary.line("hand", task.report.to_string());
  for (const json& action : result["task"]["actions"]) {
    summary.line("action", fixed(action["time_s"].get<double>(), 2) + " s  " + action["why"].get<std::string>());
  }
  std::size_t number = 0;
  for (const json& region : result["regions"]) summary.line("region " + std::to_string(++number), region_text(region));
  for (const json& object : result["objects"]) summary.line(object["name"].get<std::string>(), object_text(object));
  const json& phases = result["phases_s"];
  const auto s = [&](const char* phase) { return fixed(phases.value(phase, 0.0), 2) + " s"; };
  summary.line("time", "forgetting " + s("forgetting") + ", evaluation " + s("evaluation") + ", planner's map " +
                           s("planner_map") + ", motion planning " + s("planning") + ", fusion " + s("fusion") +
                           ", robot's motion (planned) " + s("robot"));
  if (options.has_arm()) summary.line("arm", arm_text(result));
  summary.line("stopped", result["stopped_because"].get<std::string>());
  summary.line("results", (options.write_pictures ? options.out / "report.html" : options.out).string());
  return text.str();
}

}  // namespace saccade::cli
