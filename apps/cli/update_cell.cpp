// SPDX-License-Identifier: Apache-2.0
#include "update_cell.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <utility>

#include "cell_options.hpp"
#include "context.hpp"
#include "explore_devices.hpp"
#include "saccade/attention/task_watcher.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/map/mesh.hpp"
#include "summary.hpp"
#include "update_cell_report.hpp"
#include "update_report.hpp"
#include "view_lines.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// The tracker that the cell names, or a recording in its place.
Result<std::unique_ptr<HandTracker>> open_hand(const UpdateOptions& options) {
  if (!options.simulates_hand()) {
    SACCADE_TRY(HandRecording recording, read_hand_file(options.trajectory, options.hand_file));
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
  /// The folder is open.
  CellUpdate(const UpdateOptions& options, Context& context, const ExploreSetup& subject, ExploreDevices& devices,
             TsdfMap map, RunMessages& messages)
      : options_{options},
        context_{context},
        executor_{context.executor()},
        subject_{subject},
        devices_{devices},
        out_{*context.folder()},
        bar_{context.bar()},
        map_{std::move(map)},
        messages_{messages},
        has_scan_{!options.map.empty()} {}

  [[nodiscard]] Status scan() {
    Progress progress = shown();
    const CancelOnInterrupt guard{progress};
    Explorer explorer = explorer_with(progress, &messages_);
    for (const Box& box : options_.free_boxes()) SACCADE_CHECK(map_.free(box));
    if (options_.dry_run) {
      SACCADE_TRY([[maybe_unused]] const bool seen, devices_.look_from_where_it_stands(map_, executor_));
    }
    const std::vector<Pose>& poses = subject_.scene.scan;
    SACCADE_TRY(scan_, explorer.scan(has_scan_ ? std::vector<Pose>{} : poses));
    if (!scan_.complete) return {};
    has_scan_ = true;
    scan_.measures.unknown_left = count_unknown(map_.content(), subject_.scene.workspace);
    // A kill while the hand is waited for loses no scan.
    SACCADE_CHECK(save_map(map_.content(), out_ / "map.sacmap", executor_));
    SACCADE_CHECK(write_tasks());
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
      const Stopwatch stopwatch;
      auto findings = detector(trajectory);
      problem_ = findings ? "" : findings.error().to_string();  // in this task; the next one may be better
      task_ = WatchedTask{trajectory,
                          check_samples(trajectory),
                          findings ? std::move(*findings) : AttentionFindings{},
                          {},
                          stopwatch.elapsed_ms()};
      return task_.findings.actions;
    };
    SACCADE_TRY(watcher_, TaskWatcher::create(std::move(hand), recorder, detect, options_.region_radius_m, [this] {
                  if (Progress* looking = looking_.load()) looking->request_cancel();
                }));
    if (!left_.empty()) SACCADE_CHECK(look_again({}));  // left by the interrupted run
    for (;;) {
      bar_.update("waiting for the hand", tasks_.size(), 0);
      Progress waiting;
      const CancelOnInterrupt guard{waiting};
      SACCADE_TRY(const std::optional<UserTask> ended, watcher_->next_task(&waiting));
      if (!ended) return {};
      SACCADE_CHECK(look_again(ended->regions));
    }
  }

  /// Goes on after the tasks of an earlier run; regions that its last one left are looked at first. corrupt_data.
  [[nodiscard]] Status resume(const json& document) {
    try {
      has_scan_ = document.at("result").at("scanned").get<bool>();
      for (const json& task : document.at("result").at("tasks")) {
        SACCADE_CHECK(check_task_record(task));
        tasks_.push_back(task);
      }
      if (tasks_.empty()) return {};
      for (const json& region : tasks_.back().at("regions")) {
        const json& end = region.at("end");
        if (end != to_string(RegionStatus::not_begun) && end != to_string(RegionStatus::interrupted)) continue;
        const auto center = region.at("center_m").get<std::array<double, 3>>();
        RegionOfInterest left;
        left.bounds = Sphere{{center[0], center[1], center[2]}, region.at("radius_m").get<double>()};
        SACCADE_CHECK(validate(left.bounds));
        left.saliency = region.at("saliency").get<double>();
        left.why = region.at("why").get<std::string>();
        left_.push_back(std::move(left));
      }
    } catch (const json::exception& e) {
      return Error{Errc::corrupt_data, std::string{"this is no run to go on with: "} + e.what(),
                   (out_ / "update.json").string()};
    }
    return {};
  }

  [[nodiscard]] bool scanned() const { return has_scan_; }
  [[nodiscard]] json result() const {
    return {{"cell", subject_.scene.name},
            {"out", options_.out.string()},
            {"method", options_.method->name},
            {"dry_run", options_.dry_run},
            {"unrepeatable", options_.has_programs() && !options_.dry_run && has_scan_},
            {"scanned", has_scan_},
            {"initial", scan_to_json(scan_)},
            {"tasks", tasks_}};
  }
  /// Writes the map, the tasks and the page that leads to them, at the end.
  [[nodiscard]] Status write() {
    SACCADE_CHECK(write_map());
    SACCADE_TRY(const json document, context_.write_document(result()));
    return write_page(document);
  }

 private:
  [[nodiscard]] Status write_map() const {
    const TsdfSnapshot& map = map_.content();
    SACCADE_CHECK(save_map(map, out_ / "map.sacmap", executor_));
    return write_mesh(out_ / "mesh.ply", extract_mesh(map, executor_));
  }
  /// Writes update.json as it is so far.
  [[nodiscard]] Status write_tasks() const {
    return write_json(out_ / "update.json", context_.document_so_far(result()));
  }
  [[nodiscard]] Status write_page(const json& document) const {
    if (!options_.write_pictures) return {};
    return write_cell_page(options_, map_.content(), subject_.scene.workspace, devices_, out_, document, executor_);
  }

  [[nodiscard]] Progress shown() {
    return Progress{[this](std::string_view stage, std::size_t done, std::size_t of) { bar_.update(stage, done, of); }};
  }

  [[nodiscard]] Explorer explorer_with(const Progress& progress, Recorder* recorder) {
    ExplorerParts parts{map_, devices_.camera(), devices_.robot(), executor_};
    parts.recorder = recorder;
    parts.progress = &progress;
    parts.suspended = [this] { return watcher_ != nullptr && watcher_->hand_inside(); };
    return Explorer{std::move(parts), options_.run.exploration};
  }

  /// Algorithm 1 for the regions of a task, and those that an earlier one has left.
  [[nodiscard]] Status look_again(const std::vector<RegionOfInterest>& regions) {
    task_.regions = std::exchange(left_, {});
    regions_left_before_ = task_.regions.size();
    task_.regions.insert(task_.regions.end(), regions.begin(), regions.end());
    SACCADE_TRY(const RunFolder folder,
                RunFolder::open(out_ / task_folder(tasks_.size() + 1), {}, "report.html", true));
    SACCADE_CHECK(write_hand_csv(folder / "hand.csv", task_.trajectory));
    UpdateFigures figures;
    figures.scan = scan_;
    figures.stand_by = devices_.robot().configuration();
    figures.before = figures.forgotten = figures.after = map_.snapshot();
    // A kill while the robot looks loses no region: they are in the file as not begun.
    tasks_.push_back(task_record(options_, task_, figures, subject_.scene.workspace, "interrupted"));
    SACCADE_CHECK(write_tasks());
    std::string end{"nothing_to_do"};
    const Status looked = task_.regions.empty() ? Status{} : look_at(folder, figures, end);
    figures.after = map_.snapshot();
    figures.at_end = devices_.robot().configuration();
    json record = task_record(options_, task_, figures, subject_.scene.workspace, end);
    record["regions_left_before"] = regions_left_before_;
    if (!problem_.empty()) record["problem"] = problem_;
    if (!looked.ok()) record["problem"] = looked.error().to_string();
    tasks_.back() = record;
    if (looked.ok()) SACCADE_CHECK(write_so_far());
    if (options_.write_pictures) SACCADE_CHECK(draw(folder, figures, record));
    return looked;
  }

  [[nodiscard]] Status write_so_far() const {
    SACCADE_CHECK(write_map());
    SACCADE_CHECK(write_tasks());
    return write_page(context_.document_so_far(result()));
  }

  [[nodiscard]] Status draw(const RunFolder& folder, const UpdateFigures& figures, const json& record) const {
    const UpdatePictures pictures{options_, subject_.scene.workspace, task_, devices_, folder, executor_};
    SACCADE_CHECK(pictures.draw_maps(figures));
    return write_task_page(options_, task_, folder, devices_, context_.document_so_far(result()), record);
  }

  [[nodiscard]] Status look_at(const RunFolder& folder, UpdateFigures& figures, std::string& end) {
    Progress progress = shown();
    const CancelOnInterrupt guard{progress};
    looking_ = &progress;
    if (watcher_->hand_inside()) progress.request_cancel();
    const Status looked = look_until(progress, folder, figures, end);
    looking_ = nullptr;
    return looked;
  }

  [[nodiscard]] Status look_until(const Progress& progress, const RunFolder& folder, UpdateFigures& figures,
                                  std::string& end) {
    UpdateMeter meter{subject_.scene.workspace};
    RegionMeter of_regions{task_.regions};
    UpdatePictures pictures{options_, subject_.scene.workspace, task_, devices_, folder, executor_};
    Recorder silent;
    ViewLines lines{bar_, static_cast<std::size_t>(options_.run.exploration.max_views),
                    options_.run.strategy.gain_unit};
    Recorders recorders{&meter, &of_regions, options_.write_pictures ? &pictures : &silent, &messages_, &lines};
    Explorer explorer = explorer_with(progress, &recorders);
    const Stopwatch stopwatch;
    SACCADE_CHECK(explorer.forget(task_.regions));
    figures.forgetting_ms = stopwatch.elapsed_ms();
    figures.forgotten = map_.snapshot();
    figures.unknown_after_task = count_unknown(figures.forgotten, task_.regions);
    SACCADE_CHECK(pictures.scanned(scan_, figures.forgotten));
    RegionsInTurn in_turn{task_.regions};
    const std::vector<Region> whole{subject_.scene.workspace};
    ViewPlanner planner = make_planner(options_.run, devices_.intrinsics(), whole).with(in_turn);
    Result<RunRecord> run = explorer.explore(planner);
    figures.unknown_after_view = of_regions.unknown();
    if (!run) {
      figures.run.views = meter.views();
      end = "device_failed";
      return run.error();
    }
    figures.run = std::move(*run);
    figures.run.regions.resize(task_.regions.size());
    const bool cancelled = figures.run.stopped_because == StopReason::cancelled;
    const bool hand_came = cancelled && !interrupted();
    for (std::size_t i = 0; hand_came && i < task_.regions.size(); ++i) {
      if (figures.run.regions[i].status != RegionStatus::done) left_.push_back(task_.regions[i]);
    }
    end = hand_came ? "hand_came" : std::string{to_string(figures.run.stopped_because)};
    if (cancelled) return {};
    SACCADE_TRY(figures.back, explorer.return_to_stand_by());
    return {};
  }

  const UpdateOptions& options_;
  Context& context_;
  const Executor& executor_;
  const ExploreSetup& subject_;
  ExploreDevices& devices_;
  const RunFolder& out_;
  ProgressBar& bar_;
  TsdfMap map_;
  RunMessages& messages_;
  bool has_scan_;  ///< the map knows what the scan would show
  ScanRecord scan_;
  std::vector<json> tasks_;
  std::vector<RegionOfInterest> left_;
  WatchedTask task_;  ///< the task that is handled
  std::size_t regions_left_before_{0};
  std::string problem_;                      ///< why the detector found no actions in the last task
  std::atomic<Progress*> looking_{nullptr};  ///< what a hand that comes interrupts
  std::unique_ptr<TaskWatcher> watcher_;     // last: its thread uses looking_
};

/// Returns the summary for people.
std::string cell_text(const UpdateOptions& options, const json& tasks) {
  return std::string{options.dry_run ? "dry run   nothing has moved\n" : ""} + tasks_text(tasks) + "results   " +
         (options.write_pictures ? options.out / "report.html" : options.out).string() + '\n';
}

/// Says why there is no result; empty where there is one.
std::string without_result(const json& tasks) {
  const auto has = [&tasks](const char* what) {
    return std::any_of(tasks.begin(), tasks.end(), [what](const json& task) { return !task.at(what).empty(); });
  };
  if (has("views") || (!tasks.empty() && !has("regions"))) return {};
  return tasks.empty() ? "the hand never came into the workspace; nothing was updated"
                       : "not one view of a region could be taken; does the arm stand in its own way?";
}

}  // namespace

Result<Outcome> update_cell(const UpdateOptions& given, Context& context) {
  UpdateOptions options = given;
  const Executor& executor = context.executor();
  if (options.cell_problem) return *options.cell_problem;
  SACCADE_TRY(std::optional<ArmModel> arm, read_arm(options, &context.bar()));
  if (arm && options.fuse_when == FuseWhen::motion) arm = slowed(*arm, kSpeedWhileFusing);
  SACCADE_TRY(const ExploreSetup subject, open_case(options, executor));
  SACCADE_CHECK(context.open_folder(options.resume ? "map.sacmap" : ""));
  const RunFolder& out = *context.folder();
  std::optional<json> before;
  if (options.resume) {
    SACCADE_TRY(before, read_json(out / "update.json"));
    options.map = out / "map.sacmap";
  }
  if (!options.resume) SACCADE_CHECK(remove_task_folders(out));
  SACCADE_TRY(std::unique_ptr<HandTracker> hand, open_hand(options));
  SACCADE_TRY(ExploreDevices devices, ExploreDevices::open(options, subject, arm, executor));
  SACCADE_TRY(TsdfMap map, map_to_begin_with(options, subject.scene, executor));
  SACCADE_TRY(const std::unique_ptr<RunMessages> messages,
              run_messages(options.messages, devices.intrinsics(), context.bar()));
  CellUpdate update{options, context, subject, devices, std::move(map), *messages};
  if (before) SACCADE_CHECK(update.resume(*before));
  Status ended = update.scan();
  if (ended.ok() && update.scanned()) ended = update.watch(std::move(hand));
  messages->finish();
  const bool stopped = interrupted() || (!ended.ok() && ended.error().code == Errc::cancelled);
  const Status written = update.write();  // an end by an error keeps what was seen, too
  if (!written.ok()) return ended.ok() || stopped ? written.error() : ended.error();
  if (!ended.ok() && !stopped) {
    Error error = ended.error();
    error.message += "; what was seen until then is kept, add --resume to go on";
    return error;
  }
  Outcome outcome{.result = update.result()};
  const json& tasks = outcome.result.at("tasks");
  outcome.text = cell_text(options, tasks);
  if (!stopped) outcome.empty = without_result(tasks);
  return outcome;
}

}  // namespace saccade::cli
