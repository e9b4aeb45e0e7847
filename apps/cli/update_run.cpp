// SPDX-License-Identifier: Apache-2.0
#include "update_run.hpp"

#include "saccade/core/clock.hpp"
#include "saccade/explore/true_contacts.hpp"
#include "saccade/io/scene_yaml.hpp"

namespace saccade::cli {
namespace {

/// Seconds of motion between instants at which contacts are looked for.
constexpr double kContactStep_s{0.03};

/// Counts instants and contacts of motions in a scene.
Status count_contacts_of(const SimulatedRobot& arm, std::size_t first, std::size_t last, const RayScene& scene,
                         const Executor& executor, UpdateFigures& figures) {
  SACCADE_TRY(const Solids solids, Solids::build(scene, [](const SceneObject&) { return true; }));
  const std::span<const Trajectory> motions = std::span{arm.motions()}.subspan(first, last - first);
  figures.contacts += count_contacts(arm.reachability().collision(), solids, motions, executor, kContactStep_s);
  for (const Trajectory& motion : motions) {
    figures.instants += static_cast<std::size_t>(motion.duration_s() / kContactStep_s) + 1;
  }
  return {};
}

Result<ExploreCase> case_of(const std::string& name) {
  SACCADE_TRY(Scene scene, find_scene(name));
  ExploreCase subject{std::move(scene), std::nullopt, std::nullopt};
  SACCADE_TRY(subject.rays, RayScene::build(subject.scene));
  return subject;
}

}  // namespace

Result<UpdateCase> open_update_case(const UpdateOptions& options) {
  SACCADE_TRY(ExploreCase before, case_of(options.before));
  SACCADE_TRY(ExploreCase after, case_of(options.scene));
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
    SACCADE_TRY(HandRecording recording, read_hand_trajectory(options.trajectory, options.format));
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
  if (const Status forgotten = forget_around(empty, task.regions); !forgotten) {
    return Error{forgotten.error().code, forgotten.error().message, "regions of the hand in " + options.trajectory};
  }
  return task;
}

Result<ExploreDevices> open_update_devices(const UpdateOptions& options, const UpdateCase& subject,
                                           const Executor& executor) {
  SACCADE_TRY(std::optional<ArmModel> arm, read_arm(options));
  if (arm && options.fuse_when == FuseWhen::motion) arm = slowed(*arm, kSpeedWhileFusing);
  return ExploreDevices::open(options, subject.before, arm, executor);
}

Result<UpdateFigures> run_update(const UpdateOptions& options, const UpdateCase& subject, const WatchedTask& task,
                                 ExploreDevices& devices, const Executor& executor, const Progress& progress,
                                 const std::function<Status(const TakenView& view)>& after_view) {
  TsdfConfig map_config = options.run.map();
  map_config.workspace = subject.before.scene.workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(map_config));
  ExplorationCell cell{devices.camera(), [&](const Pose& pose) { return devices.observe(pose); }, devices.robot()};
  const ExplorationConfig& config = options.run.exploration;
  UpdateFigures figures;

  // The scene as it was, and the robot out of the user's way.
  for (const Box& box : options.free_boxes()) SACCADE_CHECK(map.free(box));
  SACCADE_TRY(figures.scan, scan(map, cell, subject.before.scene.scan, config, executor, {}, progress));
  figures.interrupted = !figures.scan.complete;
  if (figures.interrupted) {
    figures.update.exploration.stopped_because = StopReason::cancelled;
  } else {
    SACCADE_TRY(figures.after_scan, return_to_stand_by(map, devices.robot(), executor));
    figures.update.back = figures.after_scan;
  }
  figures.stand_by = devices.robot().configuration();
  figures.before = map.snapshot();
  const SimulatedRobot* arm = devices.simulated_arm();
  const std::size_t scanned = arm != nullptr ? arm->motions().size() : 0;

  // The user's task: the scene changes, and the map does not know.
  SACCADE_CHECK(devices.change_scene(*subject.after.rays, options.run));
  TsdfMap forgotten{map.snapshot()};
  SACCADE_CHECK(forget_around(forgotten, task.regions));
  figures.forgotten = forgotten.snapshot();
  devices.take_frames();

  if (!figures.interrupted && !task.regions.empty()) {
    Status drawn;
    TsdfSnapshot before = figures.forgotten;
    std::vector<Pose> earlier;
    std::size_t taken = 0;
    ExplorationHooks hooks;
    hooks.after_view = [&](const ExploredView& view, const Proposals& proposals) {
      ++taken;
      figures.unknown_left.push_back(count_unknown(map.content(), subject.after.scene.workspace));
      const TsdfSnapshot after = map.snapshot();
      std::vector<Frame> frames = devices.take_frames();
      frames.erase(frames.begin(), frames.end() - static_cast<std::ptrdiff_t>(view.frames));  // those on the way
      if (after_view) drawn = after_view({taken, before, after, view, proposals, earlier, std::move(frames)});
      before = after;
      earlier.push_back(view.T_world_camera);
      return drawn.ok();
    };
    const std::unique_ptr<Strategy> strategy = make_strategy(options.run, devices.camera(), task.regions.size());
    SACCADE_TRY(figures.update,
                update_environment(map, cell, task.regions, *strategy, config, executor, hooks, progress));
    if (!drawn.ok()) return drawn.error();
    figures.interrupted = figures.update.exploration.stopped_because == StopReason::cancelled;
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
