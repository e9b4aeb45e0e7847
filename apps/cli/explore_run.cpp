// SPDX-License-Identifier: Apache-2.0
#include "explore_run.hpp"

#include <algorithm>
#include <cmath>

#include "explore_report.hpp"
#include "explore_surfels.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "server/show/arm_reading.hpp"
#include "summary.hpp"
#include "view_json.hpp"
#include "view_lines.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr const char* kProgram{"a program"};  ///< its command may be mended before a run goes on

json box_to_json(const Box& box) {
  return {{box.min.x(), box.min.y(), box.min.z()}, {box.max.x(), box.max.y(), box.max.z()}};
}

/// All that decides how a run goes on.
json settings_of(const ExploreOptions& options, const ExploreSetup& subject, const PinholeCamera& camera) {
  const SimulatedRunConfig& run = options.run;
  json settings{{"scene", subject.scene.name},
                {"scene_hash", subject.rays ? scene_hash(*subject.rays) : ""},
                {"strategy", run.strategy.name},
                {"robot", options.robot_command.empty() ? options.robot.c_str() : kProgram},
                {"fixtures", options.fixtures},
                {"free", options.free},
                {"obstacle_cell_m", options.arm.obstacles.cell_size_m},
                {"unknown_is_obstacle", options.arm.obstacles.unknown_is_obstacle},
                {"planner", options.arm.planner.planner},
                {"joints", options.joints_command.empty() ? "simulated" : kProgram},
                {"camera", options.camera_command.empty() ? "simulated" : kProgram},
                {"intrinsics", camera_to_json(camera)},
                {"sensor", to_string(run.sensor)},
                {"noise", run.noise},
                {"seed", run.seed},
                {"voxel_size_m", run.voxel_size_m},
                {"truncation_vox", run.truncation_vox},
                {"radii_m", run.sphere.radii_m},
                {"gain_width_px", run.gain_width_px},
                {"min_gain", run.planner.min_gain},
                {"good_enough", run.exploration.good_enough}};
  if (!subject.rays) {  // with objects, scene_hash tells these
    settings["workspace"] = box_to_json(subject.scene.workspace);
    for (const Region& region : subject.scene.regions) settings["regions"].push_back(box_to_json(bounds(region)));
    for (const Pose& pose : subject.scene.scan) settings["scan"].push_back(pose_to_json(pose));
  }
  if (run.clearing_percent != 100) settings["clearing_percent"] = run.clearing_percent;
  if (json reading = server::arm_reading_to_json(options.arm_reading.urdf); !reading.empty())
    settings["arm_reading"] = std::move(reading);
  if (options.surfels) settings["free_voxel_m"] = run.free_voxel_m;
  if (run.as_printed) settings["as_printed"] = true;
  if (options.speed) settings["speed"] = *options.speed;
  if (!options.map.empty()) settings["map"] = options.map.string();
  if (run.exploration.tracking != TrackingMode::forced) settings["tracking"] = to_string(run.exploration.tracking);
  if (run.exploration.frame_on_way_s > 0.0) settings["frame_on_way_s"] = run.exploration.frame_on_way_s;
  if (run.exploration.lookahead > 1) settings["lookahead"] = run.exploration.lookahead;
  if (run.exploration.objective != Objective::surface) settings["objective"] = to_string(run.exploration.objective);
  if (run.strategy.name == surface_planner().name || options.surfels) settings["least_share"] = run.least_share;
  if (run.weigh_by_saliency) settings["saliency"] = saliency_text(options.saliency);
  if (run.strategy.name == attention_planner().name) {
    settings["saliency"] = saliency_text(options.saliency);
    settings["rival_share"] = run.planner.rival_share;
  }
  return settings;
}

/// The virtual sensor that gains are counted with.
PinholeCamera gain_sensor(const SimulatedRunConfig& run, const PinholeCamera& camera) {
  return widened_vertically(camera.scaled_to_width(std::min(run.gain_width_px, camera.width)),
                            run.exploration.oscillation_rad);
}

/// Asks for a move, with what a person needs to make it by hand.
std::string question_of(const RankedView& view) {
  const Eigen::Vector3d p = view.T_world_camera.translation();
  const Eigen::Vector3d axis = view.T_world_camera.linear().col(2);
  // The angle that the image's horizontal makes with the world's.
  const double roll_rad = std::atan2(view.T_world_camera.linear()(2, 0), -view.T_world_camera.linear()(2, 1));
  std::string question = "move the camera to (" + fixed(p.x(), 3) + ", " + fixed(p.y(), 3) + ", " + fixed(p.z(), 3) +
                         ") m, looking along (" + fixed(axis.x(), 3) + ", " + fixed(axis.y(), 3) + ", " +
                         fixed(axis.z(), 3) + "), rolled " + fixed(to_deg(roll_rad), 0) + " degrees";
  if (view.gain > 0.0) question += ", gain " + fixed(view.gain, 0);
  return question + "? [y]es, [s]kip, [q]uit: ";
}

}  // namespace

ExploreRun::ExploreRun(const ExploreOptions& options, const ExploreSetup& subject, ExploreDevices& devices,
                       const RunFolder& out, const Executor& executor, ProgressBar& progress, TsdfMap map)
    : options_{options},
      subject_{subject},
      devices_{devices},
      out_{out},
      executor_{executor},
      progress_{progress},
      map_{std::move(map)},
      before_{map_.snapshot()} {
  journal_.settings = settings_of(options, subject, devices.intrinsics());
  if (subject.truth) truth_meter_.emplace(*subject.truth, options.run, options.surfels.get(), executor);
}

Result<std::unique_ptr<ExploreRun>> ExploreRun::create(const ExploreOptions& options, const ExploreSetup& subject,
                                                       ExploreDevices& devices, const RunFolder& out,
                                                       const Executor& executor, ProgressBar& progress) {
  SACCADE_TRY(TsdfMap map, map_to_begin_with(options, subject.scene, executor));
  return std::unique_ptr<ExploreRun>{
      new ExploreRun{options, subject, devices, out, executor, progress, std::move(map)}};
}

Status ExploreRun::resume(SavedExploration saved) {
  std::vector<std::string> keys{"strategy"};  // first: others follow from it
  for (const auto& [key, value] : journal_.settings.items()) keys.push_back(key);
  for (const std::string& key : keys) {
    const json& value = journal_.settings[key];
    // Journals did not name the sensor or the joints while there was but one kind.
    const json missing = key == "sensor"   ? json(to_string(DepthSensor::kinect_v1))
                         : key == "joints" ? json("simulated")
                                           : json(nullptr);
    const json then = saved.journal.settings.value(key, missing);
    if (then == value) continue;
    return Error{Errc::invalid_argument,
                 "the interrupted run had " + key + " " + then.dump() + ", not " + value.dump() +
                     "; give the same options to go on, or --force to start anew",
                 out_.path().string()};
  }
  journal_ = std::move(saved.journal);
  map_ = TsdfMap{std::move(saved.map)};
  before_ = map_.snapshot();
  if (options_.surfels && saved.surfels) {
    SACCADE_TRY(*options_.surfels, SurfelModel::create(SurfelModel::default_config(), std::move(*saved.surfels)));
    if (options_.write_pictures) {
      SACCADE_TRY(surfels_before_, draw_surfels_now());
    }
  }
  if (truth_meter_) truth_meter_->begin(before_);
  devices_.resume_at(journal_.frames());
  return journal_.q && !options_.moves_real() ? devices_.place_arm(*journal_.q) : Status{};
}

Status ExploreRun::run(const std::function<void()>& recorded, std::unique_ptr<messages::MessageSink> look_on) {
  recorded_ = recorded;
  SACCADE_TRY(messages_, run_messages(options_.messages, devices_.intrinsics(), progress_));
  if (look_on) messages_->add(std::move(look_on));
  const Status ended = run_to_end();
  note_gpu_problem();  // also that of the choice after the last view
  gpu_worked_ = gpu_ && gpu_->traffic().kernels > 0;
  gpu_.reset();
  messages_->finish();
  if (ended.ok()) return ended;
  if (ended.error().code != Errc::cancelled) {
    // A device failed: what it has shown since the last view is kept, too.
    if (options_.has_programs() && !options_.dry_run) static_cast<void>(save_journal());
    return ended;
  }
  journal_.run.stopped_because = StopReason::cancelled;  // a program that hung when the user interrupted
  return {};
}

Status ExploreRun::run_to_end() {
  Progress cancel;
  const CancelOnInterrupt guard{cancel};
  const Approve approve = [this](const RankedView& view) { return ask(view); };
  Recorders recorders{messages_.get(), this};  // the first sees what a view was chosen from
  SACCADE_TRY(gpu_, gpu_map_on(options_.backend, map_.config(), gpu_problem_));
  if (gpu_problem_) progress_.warn("the GPU cannot be used: " + gpu_problem_->message + "; the CPU does its work");
  ExplorerParts parts{map_, devices_.camera(), devices_.robot(), executor_, &recorders, nullptr, approve, &cancel};
  parts.device = gpu_.get();
  parts.model = options_.surfels.get();
  Explorer explorer{std::move(parts), options_.run.exploration};
  if (!journal_.scanned) {
    progress_.update(options_.map.empty() ? "initial scan" : "measuring the map", 0, 0);
    if (journal_.run.scan.attempted == 0) {
      for (const Box& box : options_.free_boxes()) SACCADE_CHECK(map_.free(box));
    }
    if (options_.dry_run) {
      SACCADE_TRY([[maybe_unused]] const bool seen, devices_.look_from_where_it_stands(map_, executor_));
    }
    const std::vector<Pose>& poses = subject_.scene.scan;  // a map that was given makes them unnecessary
    SACCADE_TRY(const ScanRecord scan,
                explorer.scan(options_.map.empty() ? poses : std::vector<Pose>{}, journal_.run.scan));
    if (!scan.complete) {
      journal_.run.stopped_because = StopReason::cancelled;
      return {};
    }
  }
  const std::vector<Region> regions = regions_of(subject_.scene, options_.run.strategy);
  ViewPlanner planner =
      make_planner(options_.run, devices_.intrinsics(), regions, subject_.truth ? &*subject_.truth : nullptr);
  SACCADE_TRY(journal_.run, explorer.explore(planner, journal_.run));
  return {};
}

void ExploreRun::note_gpu_problem() {
  std::optional<Error> problem = gpu_ ? gpu_->take_problem() : std::nullopt;
  if (!problem) return;
  if (!gpu_problem_) progress_.warn("the GPU failed: " + problem->message + "; the CPU goes on");
  gpu_problem_ = std::move(problem);
}

json ExploreRun::compute_to_json() const { return compute_json(options_.backend, gpu_worked_, gpu_problem_); }

Approval ExploreRun::ask(const RankedView& view) {
  if (interrupted()) return Approval::stop;
  if (!options_.step) return Approval::go;
  const std::string question = question_of(view);
  for (;;) {
    const std::optional<std::string> answer = progress_.ask(question);
    if (!answer || *answer == "q") return Approval::stop;
    if (*answer == "y") return Approval::go;
    if (*answer == "s") return Approval::skip;
  }
}

Measures ExploreRun::measure_now() const {
  if (subject_.truth) return measure_run(*subject_.truth, map(), options_.surfels.get(), options_.run, executor_);
  Measures measures;
  measures.unknown_left = count_unknown(map(), subject_.scene.workspace);
  return measures;
}

Status ExploreRun::scanning(const ScanRecord& scan, const TsdfSnapshot& /*map*/) {
  journal_.run.scan = scan;
  return save_journal();
}

Status ExploreRun::scanned(ScanRecord& scan, const TsdfSnapshot& map) {
  if (truth_meter_) SACCADE_CHECK(truth_meter_->scanned(scan, map));
  if (!truth_meter_) scan.measures = measure_now();
  journal_.run.scan = scan;
  journal_.scanned = true;
  before_ = map_.snapshot();
  if (options_.write_pictures) {
    const std::optional<RobotDrawing> robot = drawing_of(devices_.arm(), devices_.robot().configuration(), {});
    SACCADE_TRY(std::optional<DrawnSurfels> surfels, draw_surfels_now());
    SACCADE_CHECK(draw_scan(out_, map, subject_.scene.workspace, executor_, robot ? &*robot : nullptr,
                            surfels ? &*surfels : nullptr));
    surfels_before_ = std::move(surfels);
  }
  return save_journal();
}

Status ExploreRun::viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) {
  note_gpu_problem();
  if (truth_meter_) SACCADE_CHECK(truth_meter_->viewed(view, map, frames));
  if (!truth_meter_) view.measures = measure_now();
  const std::size_t number = journal_.run.views.size() + 1;
  progress_.say(options_.dry_run ? rehearsal_line(view, options_.run.strategy.gain_unit)
                                 : view_line(number, view, options_.run.strategy.gain_unit));
  progress_.update("exploring", number, static_cast<std::size_t>(options_.run.exploration.max_views));
  if (options_.write_pictures) SACCADE_CHECK(draw(view, frames));
  if (options_.keeps_views()) {
    ViewChoice choice = *view.choice;
    choice.sensor = gain_sensor(options_.run, devices_.intrinsics());
    view.choice = std::make_shared<const ViewChoice>(std::move(choice));
    SACCADE_CHECK(write_view_choice(out_.path(), number, view));
  }
  view.choice.reset();  // it is large, and in its file
  journal_.run.views.push_back(view);
  before_ = map_.snapshot();
  return save_journal();
}

Status ExploreRun::save_journal() {
  journal_.q = devices_.robot().configuration();
  const std::string kept =
      options_.keeps_views() && journal_.scanned ? view_file(journal_.run.views.size(), ".sacmap") : "";
  const SurfelMap* surfels = options_.surfels ? &options_.surfels->surfels() : nullptr;
  SACCADE_CHECK(journal_.save(out_.path(), map(), surfels, executor_, kept));
  if (recorded_) recorded_();
  return {};
}

Result<std::optional<DrawnSurfels>> ExploreRun::draw_surfels_now() const {
  if (!options_.surfels) return std::optional<DrawnSurfels>{};
  SACCADE_TRY(const std::vector<SurfelDisc> unknown, unknown_surfels_of(options_, map(), executor_));
  Box shown = subject_.scene.workspace;
  shown.min.array() -= MapPictureConfig{}.margin_m;
  shown.max.array() += MapPictureConfig{}.margin_m;
  return std::optional{drawn_surfels(options_.surfels->surfels(), UnknownSurfelConfig{}.min_weight, unknown, shown)};
}

Status ExploreRun::draw(const ViewRecord& view, std::span<const Frame> frames) {
  std::vector<Pose> earlier;
  for (const ViewRecord& taken : journal_.run.views) earlier.push_back(taken.T_world_camera);
  const std::optional<RobotDrawing> robot = drawing_of(devices_.arm(), view.q, view.path);
  SACCADE_TRY(std::optional<DrawnSurfels> surfels, draw_surfels_now());
  SACCADE_CHECK(draw_view(
      out_,
      {journal_.run.views.size() + 1, before_, map(), view, std::move(earlier), frames, subject_.scene.workspace,
       devices_.intrinsics(), robot ? &*robot : nullptr, options_.run.strategy.gain_unit,
       surfels_before_ ? &*surfels_before_ : nullptr, surfels ? &*surfels : nullptr},
      executor_));
  surfels_before_ = std::move(surfels);
  return {};
}

}  // namespace saccade::cli
