// SPDX-License-Identifier: Apache-2.0
#include "explore_run.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>

#include "explore_report.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "saccade/explore/object_attention.hpp"
#include "saccade/io/camera_io.hpp"
#include "saccade/io/json_io.hpp"
#include "saccade/scene/scene_hash.hpp"
#include "server/show/view_record.hpp"
#include "view_json.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// All that decides how a run goes on.
json settings_of(const ExploreOptions& options, const ExploreCase& subject, const PinholeCamera& camera) {
  const SimulatedRunConfig& run = options.run;
  json settings{{"scene", subject.scene.name},
                {"scene_hash", subject.rays ? scene_hash(*subject.rays) : ""},
                {"strategy", to_string(run.strategy)},
                {"robot", options.robot_command.empty() ? options.robot : options.robot_command},
                {"fixtures", options.fixtures},
                {"free", options.free},
                {"obstacle_cell_m", options.arm.obstacles.cell_size_m},
                {"unknown_is_obstacle", options.arm.obstacles.unknown_is_obstacle},
                {"planner", options.arm.planner.planner},
                {"camera", options.camera_command.empty() ? "simulated" : options.camera_command},
                {"intrinsics", camera_to_json(camera)},
                {"sensor", to_string(run.sensor)},
                {"noise", run.noise},
                {"seed", run.seed},
                {"voxel_size_m", run.voxel_size_m},
                {"truncation_vox", run.truncation_vox},
                {"radii_m", run.sphere.radii_m},
                {"gain_width_px", run.gain_width_px},
                {"min_gain", run.exploration.min_gain},
                {"good_enough", run.exploration.good_enough}};
  if (run.clearing_percent != 100) settings["clearing_percent"] = run.clearing_percent;
  if (run.strategy == StrategyKind::attention) {
    settings["saliency"] = saliency_text(options.saliency);
    settings["rival_share"] = run.attention.rival_share;
  }
  return settings;
}

Result<std::vector<ExploredView>> views_from_json(const json& views) {
  std::vector<ExploredView> all;
  try {
    for (const json& view : views) {
      SACCADE_TRY(const Pose pose, pose_from_json(view.at("T_world_camera")));
      ExploredView& explored = all.emplace_back();
      explored.region = view.at("region").get<std::size_t>();
      explored.gain = view.at("gain").is_null() ? std::nan("") : view.at("gain").get<double>();
      explored.T_world_camera = pose;
    }
  } catch (const json::exception& e) {
    return Error{Errc::corrupt_data, std::string{"the journal is damaged: "} + e.what(), ""};
  }
  return all;
}

/// The virtual sensor that gains are counted with.
PinholeCamera gain_sensor(const SimulatedRunConfig& run, const PinholeCamera& camera) {
  return widened_vertically(coarser(camera, std::min(run.gain_width_px, camera.width)),
                            run.exploration.oscillation_rad);
}

/// One line from the terminal; nullopt at its end, or when the user interrupts.
std::optional<std::string> read_answer() {
  constexpr int kPoll_ms{100};
  std::string line;
  while (!interrupted()) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, kPoll_ms) <= 0) continue;
    char c = 0;
    if (::read(STDIN_FILENO, &c, 1) != 1) return std::nullopt;
    if (c == '\n') return line;
    line.push_back(c);
  }
  return std::nullopt;
}

}  // namespace

ExploreRun::ExploreRun(const ExploreOptions& options, const ExploreCase& subject, ExploreDevices& devices,
                       const RunFolder& out, const Executor& executor, ProgressBar& progress, TsdfMap map)
    : options_{options},
      subject_{subject},
      devices_{devices},
      out_{out},
      executor_{executor},
      progress_{progress},
      map_{std::move(map)},
      before_{map_.snapshot()} {
  journal_.settings = settings_of(options, subject, devices.camera());
}

Result<ExploreRun> ExploreRun::create(const ExploreOptions& options, const ExploreCase& subject,
                                      ExploreDevices& devices, const RunFolder& out, const Executor& executor,
                                      ProgressBar& progress) {
  TsdfConfig config = options.run.map();
  config.workspace = subject.scene.workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(config));
  return ExploreRun{options, subject, devices, out, executor, progress, std::move(map)};
}

Status ExploreRun::resume(SavedExploration saved) {
  for (const auto& [key, value] : journal_.settings.items()) {
    // Journals did not name the sensor while there was but one.
    const json missing = key == "sensor" ? json(to_string(DepthSensor::kinect_v1)) : json(nullptr);
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
  devices_.resume_at(journal_.frames);
  if (journal_.arm.is_null()) return {};
  try {
    const auto values = journal_.arm.get<std::vector<double>>();
    if (values.size() > kMaxJoints) throw std::runtime_error{"too many joints"};
    return devices_.place_arm(Eigen::Map<const Eigen::VectorXd>{values.data(), std::ssize(values)});
  } catch (const std::exception& e) {
    return Error{Errc::corrupt_data, std::string{"the journal is damaged: "} + e.what(), out_.path().string()};
  }
}

Result<StopReason> ExploreRun::run(const std::function<void()>& recorded) {
  recorded_ = recorded;
  ExplorationCell cell{devices_.camera(), [this](const Pose& pose) { return devices_.observe(pose); },
                       devices_.robot()};
  Status last;
  ExplorationHooks hooks;
  hooks.before_move = [this](const Proposal& view) { return ask(view); };
  hooks.after_view = [&](const ExploredView& view, const Proposals& proposals) {
    last = record_view(view, proposals);
    return last.ok() && !interrupted();
  };
  const ExplorationConfig& config = options_.run.exploration;
  if (journal_.initial.is_null()) {
    progress_.update("initial scan", 0, 0);
    for (const Box& box : options_.free_boxes()) SACCADE_CHECK(map_.free(box));
    SACCADE_TRY(const ScanResult scanned, scan(map_, cell, subject_.scene.scan, config, executor_, hooks));
    if (!scanned.complete) return StopReason::cancelled;
    SACCADE_CHECK(record_scan(scanned));
  }
  const std::vector<Region> regions = regions_of(subject_.scene, options_.run.strategy);
  const std::unique_ptr<Strategy> strategy =
      make_strategy(options_.run, devices_.camera(), regions.size(), subject_.truth ? &*subject_.truth : nullptr);
  SACCADE_TRY(std::vector<ExploredView> so_far, views_from_json(journal_.views));
  SACCADE_TRY(const ExplorationResult explored,
              explore(map_, cell, regions, *strategy, config, executor_, hooks, {}, std::move(so_far)));
  if (!last.ok()) return last.error();
  refused_at_end_ = refused_json(explored.refused_at_end);
  return explored.stopped_because;
}

Consent ExploreRun::ask(const Proposal& view) {
  if (interrupted()) return Consent::stop;
  if (!options_.step) return Consent::go;
  progress_.finish();
  const Eigen::Vector3d p = view.T_world_camera.translation();
  const Eigen::Vector3d axis = view.T_world_camera.linear().col(2);
  // The angle that the image's horizontal makes with the world's.
  const double roll_rad = std::atan2(view.T_world_camera.linear()(2, 0), -view.T_world_camera.linear()(2, 1));
  for (;;) {
    std::cerr << std::fixed << std::setprecision(3) << "move the camera to (" << p.x() << ", " << p.y() << ", " << p.z()
              << ") m, looking along (" << axis.x() << ", " << axis.y() << ", " << axis.z() << "), rolled "
              << std::setprecision(0) << roll_rad * 180.0 / std::numbers::pi << " degrees";
    if (view.gain > 0.0) std::cerr << ", gain " << view.gain;
    std::cerr << "? [y]es, [s]kip, [q]uit: " << std::flush;
    const std::optional<std::string> answer = read_answer();
    if (!answer || *answer == "q") return Consent::stop;
    if (*answer == "y") return Consent::go;
    if (*answer == "s") return Consent::pass_over;
  }
}

MeasuredMap ExploreRun::measure_now() const {
  if (subject_.truth) return measure_map(*subject_.truth, map(), executor_);
  return {{}, count_unknown(map(), subject_.scene.workspace)};
}

Status ExploreRun::record_scan(const ScanResult& scanned) {
  const MeasuredMap measured = measure_now();
  journal_.initial = {{"coverage", subject_.truth ? json(measured.metrics.coverage) : json(nullptr)},
                      {"unknown_left", measured.unknown_left},
                      {"views", scanned.views},
                      {"refused", refused_json(scanned.refused)}};
  journal_.frames = devices_.frames();
  journal_.arm = configuration_json(devices_.robot().configuration());
  before_ = map_.snapshot();
  devices_.take_frames();
  if (options_.write_pictures) {
    const std::optional<RobotDrawing> robot = drawing_of(devices_.arm(), devices_.robot().configuration(), {});
    SACCADE_CHECK(draw_scan(out_, map(), subject_.scene.workspace, executor_, robot ? &*robot : nullptr));
  }
  return save_journal();
}

Status ExploreRun::record_view(const ExploredView& view, const Proposals& proposals) {
  const MeasuredMap measured = measure_now();
  json record = view_json(view, journal_.views.size());
  record["unknown_left"] = measured.unknown_left;
  if (subject_.truth) {
    record["unknown_near_objects"] = measured.metrics.unknown_near_objects;
    record["points_at_object"] = newly_known(*subject_.truth, before_, map(), executor_).points_at_object();
    record["coverage"] = measured.metrics.coverage;
    record["looks_at_object"] = looks_at_object(*subject_.truth, view.T_world_camera);
  }
  record["attention"] = attention_json(proposals);
  journal_.views.push_back(std::move(record));
  journal_.frames = devices_.frames();
  journal_.arm = configuration_json(devices_.robot().configuration());
  progress_.update("exploring", journal_.views.size(), static_cast<std::size_t>(options_.run.exploration.max_views));
  const std::vector<Frame> frames = devices_.take_frames();
  if (options_.write_pictures) SACCADE_CHECK(draw(view, proposals, frames));
  if (options_.keeps_views()) SACCADE_CHECK(keep_choice(view, proposals));
  before_ = map_.snapshot();
  return save_journal();
}

json ExploreRun::final() const {
  const MeasuredMap measured = measure_now();
  const Metrics& metrics = measured.metrics;
  const bool truth = subject_.truth.has_value();
  return {{"coverage", truth ? json(metrics.coverage) : json(nullptr)},
          {"unknown_left", measured.unknown_left},
          {"unknown_near_objects", truth ? json(metrics.unknown_near_objects) : json(nullptr)},
          {"accuracy_m", optional_json(metrics.accuracy_m)},
          {"chamfer_m", optional_json(metrics.chamfer_m)},
          {"f_score", optional_json(metrics.f_score)}};
}

Region ExploreRun::region_of(const ExploredView& view, const Proposals& proposals) const {
  return proposals.gained.value_or(regions_of(subject_.scene, options_.run.strategy).at(view.region));
}

Status ExploreRun::save_journal() const {
  const std::string kept = options_.keeps_views() ? server::view_file(journal_.views.size(), ".sacmap") : "";
  SACCADE_CHECK(journal_.save(out_.path(), map(), executor_, kept));
  if (recorded_) recorded_();
  return {};
}

Status ExploreRun::keep_choice(const ExploredView& view, const Proposals& proposals) const {
  server::ViewRecord record;
  record.view = journal_.views.size();
  record.region = region_of(view, proposals);
  record.sensor = gain_sensor(options_.run, devices_.camera());
  for (const Proposal& proposal : proposals.views) {
    record.T_world_candidates.push_back(proposal.T_world_camera);
    record.gains.push_back(proposal.gain);
  }
  if (proposals.attention) {
    for (const Saliency& saliency : proposals.attention->saliency) record.saliency.push_back(saliency.value);
  }
  record.segment = proposals.segment;
  record.path = view.path;
  return server::write_view_record(out_.path(), record);
}

Status ExploreRun::draw(const ExploredView& view, const Proposals& proposals, const std::vector<Frame>& frames) const {
  SACCADE_TRY(std::vector<ExploredView> views, views_from_json(journal_.views));
  std::vector<Pose> earlier;
  for (std::size_t i = 0; i + 1 < views.size(); ++i) earlier.push_back(views[i].T_world_camera);
  const Region region = region_of(view, proposals);
  const std::optional<RobotDrawing> robot = drawing_of(devices_.arm(), view.q, view.path);
  return draw_view(out_,
                   {views.size(), before_, map(), region, view, proposals, std::move(earlier), frames,
                    subject_.scene.workspace, devices_.camera(), robot ? &*robot : nullptr},
                   executor_);
}

}  // namespace saccade::cli
