// SPDX-License-Identifier: Apache-2.0
// saccade attend: where hands acted, by their trajectories; with labels, how good the detector is.
#include "attend.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>

#include "add_value.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 1> kAttendFiles{"attend.json"};

/// Folders stand for the trajectories below them.
Result<std::vector<fs::path>> trajectory_files(const AttendOptions& options) {
  std::vector<fs::path> files;
  for (const fs::path& path : options.files) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    SACCADE_TRY(const std::vector<fs::path> found, find_hand_trajectories(path));
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// One trajectory through the detector; nullopt for one that is left out.
Result<std::optional<AttendedTrajectory>> attend_one(const fs::path& file, std::size_t index,
                                                     const AttendOptions& options, const AttendDetector& detector) {
  SACCADE_TRY(HandRecording recording, read_hand_file(file, options.hand_file));
  LabelledTrajectory labelled{file.stem().string(), std::move(recording.trajectory), {}};
  if (options.evaluate) {
    SACCADE_TRY(labelled.labels_m, read_hand_labels(file));
    if (options.conditions.exclude_mislabelled && is_mislabelled(labelled)) return std::optional<AttendedTrajectory>{};
  }
  AttendedTrajectory attended{file, recording.report, {}, {}, 0.0, std::nullopt};
  // The conditions as evaluate_detector makes them, and its scores; the findings are kept on the way.
  const HandActionDetector keeping = [&](const HandTrajectory& given) -> Result<std::vector<HandAction>> {
    const Stopwatch watch;
    SACCADE_TRY(attended.findings, detector(given));
    attended.ms = watch.elapsed_ms();
    attended.given = given;
    return attended.findings.actions;
  };
  EvaluationConditions conditions = options.conditions;
  conditions.exclude_mislabelled = false;
  conditions.first_index = index;
  auto evaluated = evaluate_detector(keeping, {&labelled, 1}, conditions);
  if (!evaluated) return in_file(evaluated.error(), file);
  if (options.evaluate) attended.score = TrajectoryScore{evaluated->counts, evaluated->location_errors_m};
  attended.findings.labels_m = std::move(labelled.labels_m);
  return std::optional<AttendedTrajectory>{std::move(attended)};
}

Result<AttendResult> attend_all(const std::vector<fs::path>& files, const AttendOptions& options, ProgressBar& bar) {
  AttendResult result;
  const AttendDetector detector = options.method->make(options.as_printed);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (interrupted()) return Error{Errc::cancelled, "interrupted", {}};
    bar.update("reading trajectories", i, files.size());
    SACCADE_TRY(std::optional<AttendedTrajectory> attended, attend_one(files[i], i, options, detector));
    if (attended) {
      result.trajectories.push_back(std::move(*attended));
    } else {
      result.excluded.push_back(files[i]);
    }
  }
  return result;
}

Status write_outputs(const RunFolder& out, const AttendOptions& options, const AttendResult& result,
                     const nlohmann::json& document, ProgressBar& bar) {
  for (std::size_t i = 0; i < result.trajectories.size(); ++i) {
    if (interrupted()) return Error{Errc::cancelled, "interrupted", {}};
    bar.update("drawing", i, result.trajectories.size());
    SACCADE_CHECK(write_png(out / attend_picture_name(i), attend_picture(options, result.trajectories[i])));
    const std::string speed_name = attend_speed_name(i);
    const std::string speed_plot = attend_speed_plot(options, result.trajectories[i]);
    if (speed_plot.empty()) {
      SACCADE_CHECK(out.remove(std::array<std::string_view, 1>{speed_name}));  // what another method left
    } else {
      SACCADE_CHECK(write_file_atomically(out / speed_name, speed_plot));
    }
  }
  return write_json(out / kAttendFiles.front(), document);
}

Result<int> run_attend(const AttendOptions& options, const GlobalOptions& global) {
  const Stopwatch total;
  Stopwatch stopwatch;
  TimingsMs timings_ms;
  ProgressBar bar{global.quiet};
  SACCADE_CHECK(check_json_output(global));
  std::optional<RunFolder> out;
  if (!options.out.empty()) {
    SACCADE_TRY(RunFolder opened, RunFolder::open(options.out, kAttendFiles, kAttendFiles.front(), options.force));
    out.emplace(std::move(opened));
  }
  SACCADE_TRY(const std::vector<fs::path> files, trajectory_files(options));
  SACCADE_TRY(const AttendResult result, attend_all(files, options, bar));
  timings_ms["attend"] = stopwatch.lap_ms();
  timings_ms["total"] = total.elapsed_ms();
  const nlohmann::json document =
      json_envelope("attend", global, global.executor(), timings_ms, attend_json(options, result));
  if (out) SACCADE_CHECK(write_outputs(*out, options, result, document, bar));
  bar.finish();
  SACCADE_CHECK(write_json_output(global, document));
  if (!global.json_to_stdout()) {
    print_attend(options, result);
    if (out) std::cout << "results: " << options.out.string() << '\n';
  }
  if (result.actions() > 0) return static_cast<int>(ExitStatus::done);
  print_error("attend", "no action was found in any trajectory");
  return static_cast<int>(ExitStatus::no_result);
}

void add_method_options(CLI::App& command, AttendOptions& options) {
  add_method_option(command, options.method);
  command.add_flag("--as-printed", options.as_printed,
                   "formula and thresholds as the thesis prints them, which do not give its tables");
  add_hand_file_options(command, options.hand_file);
}

void add_condition_options(CLI::App& command, AttendOptions& options) {
  EvaluationConditions& conditions = options.conditions;
  add_value(command, "--speed", conditions.speed, "K",
            "resample to so many times as many samples first: 0.25 is a fast hand");
  add_value(command, "--noise-m", conditions.sigma_m, "METRES",
            "then add noise of this standard deviation, metres (see --seed)");
  command.add_flag("--evaluate", options.evaluate, "compare with the labels in FILE.res: precision and recall");
  add_value(command, "--match-radius", conditions.match_radius_m, "METRES",
            "with --evaluate: an action is found by a point of interest within, metres");
  command.add_flag("--exclude-mislabelled", conditions.exclude_mislabelled,
                   "with --evaluate: leave out trajectories with a label farther than 0.2 m from every sample");
}

void check_attend_options(const AttendOptions& options) {
  const EvaluationConditions& conditions = options.conditions;
  require_positive(conditions.speed, "--speed");
  require_positive(conditions.match_radius_m, "--match-radius");
  if (!(conditions.sigma_m >= 0.0) || !std::isfinite(conditions.sigma_m)) {
    usage_error("--noise-m", "must not be negative");
  }
  if (conditions.exclude_mislabelled && !options.evaluate) usage_error("--exclude-mislabelled", "goes with --evaluate");
  if (options.as_printed && !options.method->has_printed) {
    usage_error("--as-printed", "the thesis prints nothing for --method " + std::string{options.method->name});
  }
}

}  // namespace

void add_attend(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("attend", "finds where hands acted in their trajectories");
  auto options = std::make_shared<AttendOptions>();
  add_value(*command, "files", options->files, "FILE...",
            "trajectories, or bags of ROS; a folder stands for all .traj files below it")
      ->required();
  add_method_options(*command, *options);
  add_condition_options(*command, *options);
  add_value(*command, "--out", options->out, "DIR",
            "folder for attend.json, a picture of each trajectory, and for --method ours its speed");
  command->add_flag("--force", options->force, "write into a folder that holds other files");
  command->callback([options, &global, &action] {
    check_attend_options(*options);
    options->conditions.seed = global.seed;
    action = [options, &global] { return run_attend(*options, global); };
  });
}

}  // namespace saccade::cli
