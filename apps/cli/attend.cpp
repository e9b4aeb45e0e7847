// SPDX-License-Identifier: Apache-2.0
// saccade attend: where hands acted, by their trajectories; with labels, how good the detector is.
#include "attend.hpp"

#include <array>
#include <cmath>

#include "context.hpp"
#include "length_options.hpp"
#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;
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

/// The speed between samples that three of four moves stay below; 0 without moves. Single jumps of the sensor do not
/// count.
double moving_speed_mps(const HandTrajectory& trajectory) {
  std::vector<double> speeds_mps;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double step_s = trajectory[i].time_s - trajectory[i - 1].time_s;
    const double step_m = (trajectory[i].position_m - trajectory[i - 1].position_m).norm();
    if (step_s > 0.0 && step_m > 0.0) speeds_mps.push_back(step_m / step_s);
  }
  return speeds_mps.empty() ? 0.0 : nth_smallest(speeds_mps, 3 * speeds_mps.size() / 4);
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
  AttendedTrajectory attended{file, recording.report, {}, {}, 0.0, std::nullopt, moving_speed_mps(labelled.trajectory)};
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

/// Draws until all is drawn, or Ctrl-C. Returns the number of trajectories that are drawn.
Result<std::size_t> write_pictures(const RunFolder& out, const AttendOptions& options, const AttendResult& result,
                                   ProgressBar& bar) {
  std::size_t i{0};
  for (; i < result.trajectories.size() && !interrupted(); ++i) {
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
  return i;
}

class Attend final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"attend", "finds where hands acted in their trajectories"};
  }

  void declare(Options& options) override {
    options
        .value("files", attend_.files, "FILE...",
               "trajectories, or bags of ROS; a folder stands for all .traj files below it")
        .required();
    add_method_option(options.group(), attend_.method);
    options.flag("--as-printed", attend_.as_printed,
                 "use formula and thresholds as the thesis prints them; they do not give its tables");
    add_hand_file_options(options.group(), attend_.hand_file);
    declare_conditions(options);
    options.folder({.help = "folder for attend.json, a picture of each trajectory, and for --method ours its speed",
                    .files = {kAttendFiles.begin(), kAttendFiles.end()},
                    .document = kAttendFiles.front()});
    options.flag("--no-pictures{false}", pictures_, "draw no pictures");
  }

  void check(const GlobalOptions& global) override {
    EvaluationConditions& conditions = attend_.conditions;
    require_positive(conditions.speed, "--speed");
    require_length(conditions.match_radius_m, "--match-radius");
    if (!(conditions.sigma_m >= 0.0) || !std::isfinite(conditions.sigma_m)) {
      usage_error("--noise-m", "must not be negative");
    }
    if (conditions.exclude_mislabelled && !attend_.evaluate) {
      usage_error("--exclude-mislabelled", "goes with --evaluate");
    }
    if (attend_.as_printed && !attend_.method->has_printed) {
      usage_error("--as-printed", "the thesis prints nothing for --method " + std::string{attend_.method->name});
    }
    conditions.seed = global.seed;
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_TRY(const std::vector<fs::path> files, trajectory_files(attend_));
    SACCADE_TRY(const AttendResult result, attend_all(files, attend_, context.bar()));
    context.lap("attend");
    Outcome outcome{.result = attend_json(attend_, result), .text = attend_text(attend_, result)};
    if (context.folder() != nullptr) {
      SACCADE_TRY([[maybe_unused]] const json document, context.write_document(outcome.result));
      if (pictures_) SACCADE_CHECK(draw(context, result, outcome));
      outcome.text += "results: " + context.out().string() + "\n";
    }
    if (std::string warning = attend_units_warning(result); !warning.empty()) {
      outcome.warnings.push_back(std::move(warning));
    }
    return std::move(outcome).empty_if(result.actions() == 0, "no action was found in any trajectory");
  }

 private:
  /// The findings are written before: they stay when the pictures do not come to their end.
  [[nodiscard]] Status draw(Context& context, const AttendResult& result, Outcome& outcome) const {
    SACCADE_TRY(const std::size_t drawn, write_pictures(*context.folder(), attend_, result, context.bar()));
    if (drawn == result.trajectories.size()) return {};
    outcome.cut_short = "interrupted after " + std::to_string(drawn) + " of " +
                        std::to_string(result.trajectories.size()) + " pictures; all actions are in " +
                        (*context.folder() / kAttendFiles.front()).string();
    return {};
  }

  void declare_conditions(Options& options) {
    EvaluationConditions& conditions = attend_.conditions;
    options.value("--speed", conditions.speed, "K", "resample to K times as many samples first: 0.25 is a fast hand");
    options.value("--noise-m", conditions.sigma_m, "METRES",
                  "then add noise of this standard deviation, metres (see --seed)");
    options.flag("--evaluate", attend_.evaluate, "compare with the labels in FILE.res: precision and recall");
    options.value("--match-radius", conditions.match_radius_m, "METRES",
                  "with --evaluate: an action counts as found if a point of interest is within this distance, metres");
    options.flag("--exclude-mislabelled", conditions.exclude_mislabelled,
                 "with --evaluate: leave out trajectories with a label farther than 0.2 m from every sample");
  }

  AttendOptions attend_;
  bool pictures_{true};
};

}  // namespace

void add_attend(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Attend>(program, global, action);
}

}  // namespace saccade::cli
