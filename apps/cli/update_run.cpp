// SPDX-License-Identifier: Apache-2.0
#include "update_run.hpp"

#include "saccade/core/clock.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/metrics.hpp"

namespace saccade::cli {
namespace {

/// Seconds of motion between instants at which contacts are looked for.
constexpr double kContactStep_s{0.03};

/// Counts instants and contacts of motions in a scene.
Status count_contacts_of(const PlannedArm& arm, std::size_t first, std::size_t last, const RayScene& scene,
                         const Executor& executor, UpdateFigures& figures) {
  SACCADE_TRY(const Solids solids, Solids::build(scene, [](const SceneObject&) { return true; }));
  const std::span<const Trajectory> motions = std::span{arm.motions()}.subspan(first, last - first);
  figures.contacts += count_contacts(arm.reachability().collision(), solids, motions, executor, kContactStep_s);
  for (const Trajectory& motion : motions) {
    figures.instants += static_cast<std::size_t>(motion.duration_s() / kContactStep_s) + 1;
  }
  return {};
}

Result<ExploreSetup> case_of(const std::string& name) {
  SACCADE_TRY(Scene scene, find_scene(name));
  ExploreSetup subject{std::move(scene), std::nullopt, std::nullopt};
  SACCADE_TRY(subject.rays, RayScene::build(subject.scene));
  return subject;
}

}  // namespace

Result<UpdateCase> open_update_case(const UpdateOptions& options) {
  SACCADE_TRY(ExploreSetup before, case_of(options.before));
  SACCADE_TRY(ExploreSetup after, case_of(options.scene));
  SACCADE_TRY(std::vector<SceneChange> changes, scene_changes(before.scene, after.scene));
  return UpdateCase{std::move(before), std::move(after), std::move(changes)};
}

Result<WatchedTask> watch_task(const UpdateOptions& options, const UpdateCase& subject) {
  WatchedTask task;
  std::vector<Eigen::Vector3d> places_m;
  if (options.simulates_hand()) {
    SACCADE_TRY(SimulatedHand hand, simulated_hand(subject.before.scene, subject.changes, options.run.seed));
    task.trajectory = std::move(hand.trajectory);
    task.report = check_samples(task.trajectory);
    for (const HandPlace& place : hand.places) places_m.push_back(place.position_m);
  } else {
    SACCADE_TRY(HandRecording recording, read_hand_file(options.trajectory, options.hand_file));
    task.trajectory = std::move(recording.trajectory);
    task.report = recording.report;
  }
  const Stopwatch stopwatch;
  SACCADE_TRY(task.findings, options.method->make(false)(task.trajectory));
  task.ms = stopwatch.elapsed_ms();
  task.findings.labels_m = std::move(places_m);
  SACCADE_TRY(task.regions, regions_of_interest(task.findings.actions, options.region_radius_m));
  // A region that no map can hold is found here, before the robot moves.
  SACCADE_TRY(TsdfMap empty, TsdfMap::create(options.run.map()));
  for (const RegionOfInterest& region : task.regions) {
    const Status forgotten = empty.forget(region.bounds);
    if (forgotten) continue;
    return Error{forgotten.error().code, forgotten.error().message, "regions of the hand in " + options.trajectory};
  }
  return task;
}

Result<ExploreDevices> open_update_devices(const UpdateOptions& options, const UpdateCase& subject,
                                           const Executor& executor, ProgressBar* bar) {
  SACCADE_TRY(std::optional<ArmModel> arm, read_arm(options, bar));
  if (arm && options.fuse_when == FuseWhen::motion) arm = slowed(*arm, kSpeedWhileFusing);
  return ExploreDevices::open(options, subject.before, arm, executor);
}

namespace {

/// Scans the scene as it was, and takes the robot out of the user's way.
Status scan_before(const UpdateOptions& options, const UpdateCase& subject, TsdfMap& map, Explorer& explorer,
                   UpdateFigures& figures) {
  for (const Box& box : options.free_boxes()) SACCADE_CHECK(map.free(box));
  SACCADE_TRY(figures.scan, explorer.scan(subject.before.scene.scan));
  figures.interrupted = !figures.scan.complete;
  if (figures.interrupted) {
    figures.run.stopped_because = StopReason::cancelled;
    return {};
  }
  SACCADE_TRY(figures.after_scan, explorer.return_to_stand_by());
  figures.back = figures.after_scan;
  return {};
}

/// Explorer::update, with its measures.
Status update_regions(const WatchedTask& task, const RegionMeter& meter, TsdfMap& map, Explorer& explorer,
                      ViewPlanner& planner, UpdateFigures& figures) {
  const Stopwatch stopwatch;
  SACCADE_CHECK(explorer.forget(task.regions));
  figures.forgetting_ms = stopwatch.elapsed_ms();
  figures.unknown_after_task = count_unknown(map.content(), task.regions);
  SACCADE_TRY(figures.run, explorer.explore(planner));
  figures.run.regions.resize(task.regions.size());
  figures.unknown_after_view = meter.unknown();
  figures.interrupted = figures.run.stopped_because == StopReason::cancelled;
  if (figures.interrupted) return {};
  SACCADE_TRY(figures.back, explorer.return_to_stand_by());
  return {};
}

}  // namespace

Status UpdateMeter::viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> /*frames*/) {
  view.measures.unknown_left = count_unknown(map, workspace_);
  views_.push_back(view);
  views_.back().choice.reset();  // it is large
  return {};
}

Result<UpdateFigures> run_update(const UpdateOptions& options, const UpdateCase& subject, const WatchedTask& task,
                                 ExploreDevices& devices, const Executor& executor, const Progress& progress,
                                 Recorder* pictures) {
  TsdfConfig map_config = options.run.map();
  map_config.workspace = subject.before.scene.workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(map_config));
  Recorder silent;
  UpdateMeter unknown{subject.after.scene.workspace};
  RegionMeter of_regions{task.regions};
  Recorders recorders{&unknown, &of_regions, pictures != nullptr ? pictures : &silent};
  Explorer explorer{{map, devices.camera(), devices.robot(), executor, &recorders, nullptr, {}, &progress},
                    options.run.exploration};
  UpdateFigures figures;
  SACCADE_CHECK(scan_before(options, subject, map, explorer, figures));
  figures.stand_by = devices.robot().configuration();
  figures.before = map.snapshot();
  const PlannedArm* arm = devices.simulated_arm();
  const std::size_t scanned = arm != nullptr ? arm->motions().size() : 0;

  // The user's task: the scene changes, and the map does not know.
  SACCADE_CHECK(devices.change_scene(*subject.after.rays, options.run));
  TsdfMap forgotten{map.snapshot()};
  for (const RegionOfInterest& region : task.regions) SACCADE_CHECK(forgotten.forget(region.bounds));
  figures.forgotten = forgotten.snapshot();

  if (!figures.interrupted && !task.regions.empty()) {
    ScanRecord ready = figures.scan;
    SACCADE_CHECK(recorders.scanned(ready, figures.forgotten));
    RegionsInTurn in_turn{task.regions};
    const std::vector<Region> whole{subject.after.scene.workspace};
    ViewPlanner planner = make_planner(options.run, devices.intrinsics(), whole).with(in_turn);
    SACCADE_CHECK(update_regions(task, of_regions, map, explorer, planner, figures));
  }
  figures.after = map.snapshot();
  figures.at_end = devices.robot().configuration();
  if (arm == nullptr) return figures;
  progress.report("checking for contacts", 0, 0);
  SACCADE_CHECK(count_contacts_of(*arm, 0, scanned, *subject.before.rays, executor, figures));
  SACCADE_CHECK(count_contacts_of(*arm, scanned, arm->motions().size(), *subject.after.rays, executor, figures));
  return figures;
}

}  // namespace saccade::cli
