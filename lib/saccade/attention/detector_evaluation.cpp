// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/detector_evaluation.hpp"

#include <algorithm>
#include <limits>

#include "saccade/core/clock.hpp"
#include "saccade/core/statistics.hpp"

namespace saccade {
namespace {

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

std::optional<double> median_if_any(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional{median(values)};
}

void append(std::vector<double>& to, const std::vector<double>& from) { to.insert(to.end(), from.begin(), from.end()); }

}  // namespace

bool is_mislabelled(const LabelledTrajectory& labelled, double distance_m) {
  return std::any_of(labelled.labels_m.begin(), labelled.labels_m.end(), [&](const Eigen::Vector3d& label) {
    return std::all_of(labelled.trajectory.begin(), labelled.trajectory.end(),
                       [&](const HandSample& sample) { return (sample.position_m - label).norm() > distance_m; });
  });
}

std::optional<double> DetectionCounts::precision() const {
  return share(true_positives, true_positives + false_positives);
}

std::optional<double> DetectionCounts::recall() const { return share(true_positives, labels); }

DetectionCounts& DetectionCounts::operator+=(const DetectionCounts& other) {
  labels += other.labels;
  true_positives += other.true_positives;
  false_positives += other.false_positives;
  return *this;
}

TrajectoryScore score(std::span<const HandAction> actions, std::span<const Eigen::Vector3d> labels_m,
                      double match_radius_m) {
  TrajectoryScore result;
  result.counts.labels = labels_m.size();
  for (const Eigen::Vector3d& label : labels_m) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const HandAction& action : actions) nearest_m = std::min(nearest_m, (action.position_m - label).norm());
    if (nearest_m <= match_radius_m) {
      ++result.counts.true_positives;
      result.location_errors_m.push_back(nearest_m);
    }
  }
  result.counts.false_positives =
      static_cast<std::size_t>(std::count_if(actions.begin(), actions.end(), [&](const HandAction& action) {
        return std::none_of(labels_m.begin(), labels_m.end(), [&](const Eigen::Vector3d& label) {
          return (action.position_m - label).norm() <= match_radius_m;
        });
      }));
  return result;
}

DetectorEvaluation& DetectorEvaluation::operator+=(const DetectorEvaluation& other) {
  counts += other.counts;
  trajectories += other.trajectories;
  excluded += other.excluded;
  append(location_errors_m, other.location_errors_m);
  append(ms, other.ms);
  return *this;
}

std::optional<double> DetectorEvaluation::median_location_error_m() const { return median_if_any(location_errors_m); }

std::optional<double> DetectorEvaluation::median_ms() const { return median_if_any(ms); }

Result<DetectorEvaluation> evaluate_detector(const HandActionDetector& detector,
                                             std::span<const LabelledTrajectory> trajectories,
                                             const EvaluationConditions& conditions) {
  if (!(conditions.match_radius_m > 0.0)) {
    return Error{Errc::invalid_argument, "the match radius must be positive", "EvaluationConditions"};
  }
  DetectorEvaluation evaluation;
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    const LabelledTrajectory& labelled = trajectories[i];
    if (conditions.exclude_mislabelled && is_mislabelled(labelled)) {
      ++evaluation.excluded;
      continue;
    }
    constexpr std::uint64_t kSeedsApart{0x9E3779B97F4A7C15U};
    SACCADE_TRY(HandTrajectory slower, at_speed(labelled.trajectory, conditions.speed));
    SACCADE_TRY(const HandTrajectory given, with_noise(std::move(slower), conditions.sigma_m,
                                                       conditions.seed * kSeedsApart + conditions.first_index + i));
    const Stopwatch watch;
    auto actions = detector(given);
    evaluation.ms.push_back(watch.elapsed_ms());
    if (!actions) {
      Error error = actions.error();
      error.context = error.context.empty() ? labelled.name : labelled.name + ", " + error.context;
      return error;
    }
    const TrajectoryScore scored = score(*actions, labelled.labels_m, conditions.match_radius_m);
    evaluation.counts += scored.counts;
    append(evaluation.location_errors_m, scored.location_errors_m);
    ++evaluation.trajectories;
  }
  return evaluation;
}

}  // namespace saccade
