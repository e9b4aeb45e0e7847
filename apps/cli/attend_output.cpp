// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <iomanip>
#include <sstream>

#include "attend.hpp"
#include "json_output.hpp"
#include "saccade/core/statistics.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

json trajectory_json(const AttendedTrajectory& trajectory) {
  json actions = json::array();
  for (const HandAction& action : trajectory.findings.actions) actions.push_back(action_json(action));
  json entry{{"file", trajectory.file.string()},
             {"samples", sample_report_json(trajectory.report)},
             {"ms", trajectory.ms},
             {"actions", std::move(actions)}};
  if (trajectory.score) {
    const DetectionCounts& counts = trajectory.score->counts;
    entry["ground_truth"] = counts.labels;
    entry["true_positives"] = counts.true_positives;
    entry["false_positives"] = counts.false_positives;
  }
  return entry;
}

/// Eight characters, and more where the number needs them: columns never touch.
std::string coordinate_column(double metres) {
  constexpr std::size_t kWidth{8};
  const std::string number = fixed(metres, 3);
  return std::string(number.size() < kWidth ? kWidth - number.size() : 1, ' ') + number;
}

void list_actions(const AttendedTrajectory& trajectory, std::ostream& text) {
  text << trajectory.file.string() << ": " << trajectory.report.to_string() << '\n';
  for (const HandAction& action : trajectory.findings.actions) {
    text << std::setw(8) << fixed(action.time_s, 2) << " s ";
    for (Eigen::Index axis = 0; axis < 3; ++axis) text << coordinate_column(action.position_m[axis]);
    text << " m  " << action.why << '\n';
  }
  if (trajectory.findings.actions.empty()) text << "  no action\n";
}

std::string evaluation_text(const AttendResult& result) {
  std::ostringstream text;
  const DetectorEvaluation evaluation = result.evaluation();
  const DetectionCounts& counts = evaluation.counts;
  const auto share = [](const std::optional<double>& value) { return value ? percent(*value) : std::string{"none"}; };
  const Summary summary{text};
  summary.line("files", std::to_string(evaluation.trajectories) + (result.excluded.empty()
                                                                       ? ""
                                                                       : ", " + std::to_string(result.excluded.size()) +
                                                                             " with a mislabelled position left out"));
  summary.line("labels", std::to_string(counts.labels));
  summary.line("found", std::to_string(counts.true_positives) + ", missed " + std::to_string(counts.false_negatives()) +
                            ", false " + std::to_string(counts.false_positives));
  summary.line("precision", share(counts.precision()));
  summary.line("recall", share(counts.recall()));
  const auto error_m = evaluation.median_location_error_m();
  summary.line("off by", error_m ? millimetres(*error_m) + ", median" : "none");
  summary.line("time", fixed(result.median_ms(), 2) + " ms per trajectory, median");
  return text.str();
}

std::string numbered_name(std::size_t index, const char* ending) {
  std::array<char, 48> name{};
  std::snprintf(name.data(), name.size(), "trajectory-%03zu%s", index, ending);
  return name.data();
}

std::string points_text(const AttendOptions& options, const AttendedTrajectory& trajectory) {
  const std::size_t actions = trajectory.findings.actions.size();
  return std::string{options.method->name} + ": " + std::to_string(actions) + (actions == 1 ? " point" : " points") +
         " of interest";
}

}  // namespace

json action_json(const HandAction& action) {
  return {{"position_m", point_json(action.position_m)},
          {"time_s", action.time_s},
          {"saliency", action.saliency},
          {"why", action.why}};
}

json sample_report_json(const SampleReport& report) {
  return {{"total", report.samples},
          {"not_finite", report.not_finite},
          {"not_increasing", report.not_increasing},
          {"repeats", report.repeats},
          {"gaps", report.gaps}};
}

std::size_t AttendResult::actions() const {
  std::size_t sum{0};
  for (const AttendedTrajectory& trajectory : trajectories) sum += trajectory.findings.actions.size();
  return sum;
}

double AttendResult::median_ms() const {
  std::vector<double> values;
  for (const AttendedTrajectory& trajectory : trajectories) values.push_back(trajectory.ms);
  return median(values);
}

DetectorEvaluation AttendResult::evaluation() const {
  DetectorEvaluation sum;
  sum.excluded = excluded.size();
  for (const AttendedTrajectory& trajectory : trajectories) {
    sum.counts += trajectory.score->counts;
    const std::vector<double>& errors_m = trajectory.score->location_errors_m;
    sum.location_errors_m.insert(sum.location_errors_m.end(), errors_m.begin(), errors_m.end());
    ++sum.trajectories;
  }
  return sum;
}

json attend_json(const AttendOptions& options, const AttendResult& result) {
  const EvaluationConditions& conditions = options.conditions;
  json details = json::array();
  for (const AttendedTrajectory& trajectory : result.trajectories) details.push_back(trajectory_json(trajectory));
  json document{{"method", options.method->name},
                {"as_printed", options.as_printed},
                {"speed", conditions.speed},
                {"noise_m", conditions.sigma_m},
                {"trajectories", result.trajectories.size()},
                {"actions", result.actions()},
                {"ms_per_trajectory", {{"median", result.median_ms()}}},
                {"details", std::move(details)}};
  if (!options.evaluate) return document;
  const DetectorEvaluation evaluation = result.evaluation();
  const DetectionCounts& counts = evaluation.counts;
  json excluded = json::array();
  for (const auto& file : result.excluded) excluded.push_back(file.string());
  document["match_radius_m"] = conditions.match_radius_m;
  document["excluded"] = std::move(excluded);
  document["ground_truth"] = counts.labels;
  document["true_positives"] = counts.true_positives;
  document["false_positives"] = counts.false_positives;
  document["false_negatives"] = counts.false_negatives();
  document["precision"] = optional_json(counts.precision());
  document["recall"] = optional_json(counts.recall());
  document["location_error_m"] = {{"median", optional_json(evaluation.median_location_error_m())}};
  return document;
}

std::string attend_text(const AttendOptions& options, const AttendResult& result) {
  if (options.evaluate) return evaluation_text(result);
  std::ostringstream text;
  for (const AttendedTrajectory& trajectory : result.trajectories) list_actions(trajectory, text);
  return text.str();
}

std::string attend_units_warning(const AttendResult& result) {
  constexpr double kFastest_mps{20.0};
  for (const AttendedTrajectory& trajectory : result.trajectories) {
    if (!(trajectory.speed_mps > kFastest_mps)) continue;
    return "warning: " + trajectory.file.string() + ": hands do not move at " + fixed(trajectory.speed_mps, 0) +
           " m/s; give positions in metres, not millimetres, and times in seconds";
  }
  return {};
}

std::string attend_picture_name(std::size_t index) { return numbered_name(index, ".png"); }

std::string attend_speed_name(std::size_t index) { return numbered_name(index, "-speed.svg"); }

ColorImage attend_picture(const AttendOptions& options, const AttendedTrajectory& trajectory) {
  AttentionPictureConfig config;
  config.title = trajectory.file.stem().string();
  config.note = points_text(options, trajectory) + "; " + trajectory.report.to_string();
  return attention_picture(trajectory.given, trajectory.findings, config);
}

std::string attend_speed_plot(const AttendOptions& options, const AttendedTrajectory& trajectory) {
  return speed_plot(trajectory.findings, trajectory.file.stem().string() + ", " + points_text(options, trajectory));
}

}  // namespace saccade::cli
