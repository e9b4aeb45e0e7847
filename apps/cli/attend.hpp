// SPDX-License-Identifier: Apache-2.0
#pragma once
// Request and findings of `saccade attend`, for its output.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "attend_methods.hpp"
#include "command.hpp"
#include "json_output.hpp"
#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade::cli {

struct AttendOptions {
  std::vector<std::filesystem::path> files;  ///< trajectories, and folders of .traj files
  HandFileOptions hand_file;
  const AttendMethod* method{nullptr};
  bool as_printed{false};
  bool evaluate{false};
  EvaluationConditions conditions;
};

/// One trajectory: as it was given to the detector, and its result.
struct AttendedTrajectory {
  std::filesystem::path file;
  SampleReport report;
  HandTrajectory given;
  AttentionFindings findings;
  double ms{0.0};
  std::optional<TrajectoryScore> score;  ///< with --evaluate
  double speed_mps{0.0};                 ///< typical one of the hand in the file while it moves
};

struct AttendResult {
  std::vector<AttendedTrajectory> trajectories;
  std::vector<std::filesystem::path> excluded;  ///< with a mislabelled position
  [[nodiscard]] std::size_t actions() const;
  [[nodiscard]] double median_ms() const;
  [[nodiscard]] DetectorEvaluation evaluation() const;
};

[[nodiscard]] nlohmann::json action_json(const HandAction& action);
[[nodiscard]] nlohmann::json sample_report_json(const SampleReport& report);
[[nodiscard]] nlohmann::json attend_json(const AttendOptions& options, const AttendResult& result);
/// For people: the actions of each trajectory, or with --evaluate how good the detector is.
[[nodiscard]] std::string attend_text(const AttendOptions& options, const AttendResult& result);
/// Warns of the first trajectory whose speeds no hand has, as other units give; empty where there is none.
[[nodiscard]] std::string attend_units_warning(const AttendResult& result);
/// Names of a trajectory's picture and of the plot of its speed, from its number.
[[nodiscard]] std::string attend_picture_name(std::size_t index);
[[nodiscard]] std::string attend_speed_name(std::size_t index);
[[nodiscard]] ColorImage attend_picture(const AttendOptions& options, const AttendedTrajectory& trajectory);
/// Empty where the method looks for no dips of the speed.
[[nodiscard]] std::string attend_speed_plot(const AttendOptions& options, const AttendedTrajectory& trajectory);

}  // namespace saccade::cli
