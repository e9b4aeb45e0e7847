// SPDX-License-Identifier: Apache-2.0
#include "update_cell.hpp"

#include <atomic>
#include <iostream>
#include <memory>
#include <utility>

#include "attend.hpp"
#include "cell_options.hpp"
#include "exit_status.hpp"
#include "explore_devices.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/attention/task_watcher.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/map/mesh.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// The tracker that the cell names, or a recording in its place.
Result<std::unique_ptr<HandTracker>> open_hand(const UpdateOptions& options) {
  if (!options.simulates_hand()) {
    SACCADE_TRY(HandRecording recording, read_hand_trajectory(options.trajectory, options.format));
    return std::unique_ptr<HandTracker>{std::make_unique<saccade::RecordedHand>(std::move(recording.trajectory))};
  }
  if (options.hand_command.empty()) {
    return Error{Errc::invalid_argument,
                 "nothing tracks the hand: add the key hand with a command, or give --hand-command or --trajectory",
                 options.scene};
  }
  SACCADE_TRY(std::unique_ptr<ProgramHand> hand,
              ProgramHand::start(program_config(options, options.hand_command, options.cell.hand)));
  return std::unique_ptr<HandTracker>{std::move(hand)};
}

/// One cell, from its scan on.
class CellUpdate {
 public:
  CellUpdate(const UpdateOptions& options, const GlobalOptions& global, const ExploreCase& subject,
             ExploreDevices& devices, const RunFolder& out, ProgressBar& bar, TsdfMap map)
      : options_{options},
        global_{global},
        executor_{global.executor()},
        subject_{subject},
        devices_{devices},
        out_{out},
        bar_{bar},
        map_{std::move(map)} {}

  [[nodiscard]] Status scan() {
    Progress progress = shown();
    const CancelOnInterrupt guard{progress};
    Explorer explorer = explorer_with(progress);
    for (const Box& box : options_.free_boxes()) SACCADE_CHECK(map_.free(box));
    const std::vector<Pose>& poses = subject_.scene.scan;
    SACCADE_TRY(scan_, explorer.scan(options_.map.empty() ? poses : std::vector<Pose>{}));
    if (!scan_.complete) return {};
    SACCADE_TRY([[maybe_unused]] const StandByResult back, explorer.return_to_stand_by());
    return {};
  }

  /// Handles one task after the other. A hand that comes while the robot looks ends its looking; what was left is
  /// looked at after the next task.
  [[nodiscard]] Status watch(std::unique_ptr<HandTracker> hand) {
    HandRecorderConfig recorder;
    recorder.workspace = subject_.scene.workspace;
    const AttendDetector detector = options_.method->make(false);
    const DetectActions detect = [&](const HandTrajectory& trajectory) -> Result<std::vector<HandAction>> {
      auto findings = detector(trajectory);
      problem_ = findings ? "" : findings.error().to_string();  // of one task; the next one may be better
      return findings ? std::move(findings->actions) : std::vector<HandAction>{};
    };
    SACCADE_TRY(watcher_, TaskWatcher::create(std::move(hand), recorder, detect, options_.region_radius_m, [this] {
                  if (Progress* looking = looking_.load()) looking->request_cancel();
                }));
    for (;;) {
      bar_.update("waiting for the hand", tasks_.size(), 0);
      Progress waiting;
      const CancelOnInterrupt guard{waiting};
      SACCADE_TRY(std::optional<UserTask> task, watcher_->next_task(&waiting));
      if (!task) return {};
      SACCADE_CHECK(look_again(*task));
    }
  }

  [[nodiscard]] std::size_t tasks() const { return tasks_.size(); }
  [[nodiscard]] bool scanned() const { return scan_.complete; }
  [[nodiscard]] json result() const {
    return {{"cell", subject_.scene.name},
            {"out", options_.out.string()},
            {"method", options_.method->name},
            {"initial", scan_to_json(scan_)},
            {"tasks", tasks_}};
  }
  [[nodiscard]] Status write(double total_ms) {
    SACCADE_CHECK(save_map(map_.content(), out_ / "map.sacmap", executor_));
    SACCADE_CHECK(write_mesh(out_ / "mesh.ply", extract_mesh(map_.content(), executor_)));
    return write_json(out_ / "update.json",
                      json_envelope("update", global_, executor_, {{"total", total_ms}}, result()));
  }

 private:
  [[nodiscard]] Progress shown() {
    return Progress{[this](std::string_view stage, std::size_t done, std::size_t of) { bar_.update(stage, done, of); }};
  }

  [[nodiscard]] Explorer explorer_with(const Progress& progress) {
    ExplorerParts parts{map_, devices_.camera(), devices_.robot(), executor_};
    parts.progress = &progress;
    parts.suspended = [this] { return watcher_ != nullptr && watcher_->hand_inside(); };
    return Explorer{std::move(parts), options_.run.exploration};
  }

  /// Algorithm 1 for the regions of a task, and those that an earlier one has left.
  [[nodiscard]] Status look_again(const UserTask& task) {
    std::vector<RegionOfInterest> regions = std::exchange(left_, {});
    const std::size_t old = regions.size();
    regions.insert(regions.end(), task.regions.begin(), task.regions.end());
    const std::string name = "task-" + std::to_string(tasks_.size() + 1);
    SACCADE_CHECK(write_hand_csv(out_ / (name + ".csv"), task.trajectory));
    json record{{"samples", task.trajectory.size()}, {"regions_left_before", old}};
    json actions = json::array();
    for (const HandAction& action : task.actions) actions.push_back(action_json(action));
    record["actions"] = std::move(actions);
    if (!problem_.empty()) record["problem"] = problem_;
    const Status looked = regions.empty() ? Status{} : look_at(regions, record);
    if (!looked.ok()) record["problem"] = looked.error().to_string();
    tasks_.push_back(std::move(record));
    if (!looked.ok()) return looked.error();
    return write(0.0);
  }

  [[nodiscard]] Status look_at(const std::vector<RegionOfInterest>& regions, json& record) {
    Progress progress = shown();
    const CancelOnInterrupt guard{progress};
    looking_ = &progress;
    if (watcher_->hand_inside()) progress.request_cancel();
    const Status looked = look_until(regions, progress, record);
    looking_ = nullptr;
    return looked;
  }

  [[nodiscard]] Status look_until(const std::vector<RegionOfInterest>& regions, const Progress& progress,
                                  json& record) {
    Explorer explorer = explorer_with(progress);
    SACCADE_CHECK(explorer.forget(regions));
    const UnknownOfRegions forgotten = count_unknown(map_.content(), regions);
    RegionsInTurn in_turn{regions};
    const std::vector<Region> whole{subject_.scene.workspace};
    ViewPlanner planner = make_planner(options_.run, devices_.intrinsics(), whole).with(in_turn);
    SACCADE_TRY(RunRecord run, explorer.explore(planner));
    run.regions.resize(regions.size());
    const bool again = run.stopped_because == StopReason::cancelled && !interrupted();
    for (std::size_t i = 0; again && i < regions.size(); ++i) {
      if (run.regions[i].status != RegionStatus::done) left_.push_back(regions[i]);
    }
    StandByResult back;
    if (run.stopped_because != StopReason::cancelled) {
      SACCADE_TRY(back, explorer.return_to_stand_by());
    }
    record["views"] = views_to_json(run.views);
    record["stopped_because"] = again ? "hand_came" : std::string{to_string(run.stopped_because)};
    record["at_stand_by"] = back.at_stand_by;
    const UnknownOfRegions unknown = count_unknown(map_.content(), regions);
    json list = json::array();
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const auto& ball = std::get<Sphere>(regions[i].bounds);
      list.push_back({{"center_m", point_json(ball.center)},
                      {"radius_m", ball.radius_m},
                      {"why", regions[i].why},
                      {"end", to_string(run.regions[i].status)},
                      {"unknown_after_task", forgotten[i]},
                      {"unknown_left", unknown[i]}});
    }
    record["regions"] = std::move(list);
    return {};
  }

  const UpdateOptions& options_;
  const GlobalOptions& global_;
  Executor executor_;
  const ExploreCase& subject_;
  ExploreDevices& devices_;
  const RunFolder& out_;
  ProgressBar& bar_;
  TsdfMap map_;
  ScanRecord scan_;
  std::vector<json> tasks_;
  std::vector<RegionOfInterest> left_;
  std::string problem_;                      ///< why the detector found no actions in the last task
  std::atomic<Progress*> looking_{nullptr};  ///< what a hand that comes interrupts
  std::unique_ptr<TaskWatcher> watcher_;     // last: its thread uses looking_
};

}  // namespace

Result<int> run_cell_update(const UpdateOptions& options, const GlobalOptions& global) {
  const Stopwatch total;
  const Executor executor = global.executor();
  ProgressBar bar{global.quiet};
  SACCADE_CHECK(check_json_output(global));
  if (options.cell_problem) return *options.cell_problem;
  SACCADE_TRY(std::optional<ArmModel> arm, read_arm(options, &bar));
  if (arm && options.fuse_when == FuseWhen::motion) arm = slowed(*arm, kSpeedWhileFusing);
  SACCADE_TRY(const ExploreCase subject, open_case(options, executor));
  SACCADE_TRY(const RunFolder out, RunFolder::open(options.out, {}, "update.json", options.force));
  SACCADE_TRY(std::unique_ptr<HandTracker> hand, open_hand(options));
  SACCADE_TRY(ExploreDevices devices, ExploreDevices::open(options, subject, arm, executor));
  SACCADE_TRY(TsdfMap map, map_to_begin_with(options, subject.scene, executor));
  CellUpdate update{options, global, subject, devices, out, bar, std::move(map)};
  Status ended = update.scan();
  if (ended.ok() && update.scanned()) ended = update.watch(std::move(hand));
  const bool stopped = interrupted() || (!ended.ok() && ended.error().code == Errc::cancelled);
  const Status written = update.write(total.elapsed_ms());  // whatever happened, what was seen is kept
  bar.finish();
  if (!ended.ok() && !stopped) return ended.error();
  if (!written.ok()) return written.error();
  SACCADE_CHECK(write_result("update", global, executor, {{"total", total.elapsed_ms()}}, update.result()));
  if (!global.json_to_stdout()) {
    std::cout << "tasks     " << update.tasks() << "\nresults   " << options.out.string() << '\n';
  }
  if (stopped) return interrupt_status();
  if (update.tasks() > 0) return static_cast<int>(ExitStatus::done);
  print_error("update", "the hand never came into the workspace; nothing was updated");
  return static_cast<int>(ExitStatus::no_result);
}

}  // namespace saccade::cli
