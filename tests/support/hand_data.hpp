// SPDX-License-Identifier: Apache-2.0
#pragma once
// Recorded hands of the shared data, what may happen to them (resampling, noise, outliers, repeats), and scores of
// detected actions.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "saccade/attention/dip_stream.hpp"
#include "saccade/attention/hand_trajectory.hpp"

namespace saccade::test {

/// A recorded task with the true places of its actions.
struct RecordedHand {
  std::string name;
  int user{0};
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<Eigen::Vector3d> labels_m;

  /// Whether every label lies within 0.2 m of a sample.
  [[nodiscard]] bool well_labelled() const {
    return std::all_of(labels_m.begin(), labels_m.end(), [this](const Eigen::Vector3d& label) {
      return std::any_of(positions_m.begin(), positions_m.end(),
                         [&](const Eigen::Vector3d& p) { return (p - label).norm() <= 0.2; });
    });
  }
};

inline std::vector<double> numbers_in(const std::filesystem::path& file) {
  std::ifstream stream{file};
  std::vector<double> numbers;
  for (double number{0.0}; stream >> number;) numbers.push_back(number);
  return numbers;
}

/// All well labelled trajectories of the two folders, by folder and name; empty where there are none.
inline std::vector<RecordedHand> recorded_hands(const std::filesystem::path& root) {
  std::vector<RecordedHand> hands;
  for (const char* folder : {"pick_and_place", "placements_removals"}) {
    if (!std::filesystem::is_directory(root / folder)) continue;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator{root / folder}) {
      if (entry.path().extension() == ".traj") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) {
      RecordedHand hand;
      hand.name = file.stem().string();
      hand.user = hand.name.at(4) - '0';
      const std::vector<double> matrices = numbers_in(file);
      for (std::size_t i = 0; i + 16 <= matrices.size(); i += 16) {
        hand.positions_m.emplace_back(matrices[i + 3], matrices[i + 7], matrices[i + 11]);
      }
      const std::vector<double> labels = numbers_in(file.string() + ".res");
      for (std::size_t i = 0; i + 3 <= labels.size(); i += 3) {
        hand.labels_m.emplace_back(labels[i], labels[i + 1], labels[i + 2]);
      }
      if (hand.well_labelled()) hands.push_back(std::move(hand));
    }
  }
  return hands;
}

/// What happens to a recorded hand before it is detected, in this order.
struct HandCondition {
  double speed{1.0};  ///< 0.25: a quarter of the samples, linearly interpolated
  double noise_m{0.0};
  double outlier_share{0.0};      ///< of the samples, moved by up to 0.5 m along each axis
  bool farthest_outliers{false};  ///< all outliers by 0.5 m along each axis
  double repeat_share{0.0};       ///< of the samples, replaced by the one before
};

/// At 100 Hz, from time 0. The same on every machine with the same standard library. Expects two positions or more.
inline HandTrajectory disturbed(const std::vector<Eigen::Vector3d>& recorded, const HandCondition& condition,
                                std::mt19937_64& random) {
  const std::size_t n = recorded.size();
  const auto count = static_cast<std::size_t>(std::max(2.0, std::round(static_cast<double>(n) * condition.speed)));
  std::normal_distribution<double> gaussian{0.0, 1.0};
  std::uniform_real_distribution<double> unit{0.0, 1.0};
  HandTrajectory made;
  made.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double at = static_cast<double>(k) * static_cast<double>(n - 1) / static_cast<double>(count - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), n - 2);
    const double share = at - static_cast<double>(i);
    HandSample sample;
    sample.time_s = 0.01 * static_cast<double>(k);
    sample.position_m = (1.0 - share) * recorded[i] + share * recorded[i + 1];
    if (condition.noise_m > 0.0) {
      for (double& coordinate : sample.position_m) coordinate += condition.noise_m * gaussian(random);
    }
    if (condition.outlier_share > 0.0 && unit(random) < condition.outlier_share) {
      for (double& coordinate : sample.position_m) {
        const double off_m = unit(random) - 0.5;
        coordinate += condition.farthest_outliers ? std::copysign(0.5, off_m) : off_m;
      }
    }
    if (condition.repeat_share > 0.0 && k > 0 && unit(random) < condition.repeat_share) {
      sample.position_m = made.back().position_m;
    }
    made.push_back(sample);
  }
  return made;
}

/// Whether a condition needs several seeds.
inline bool is_random(const HandCondition& condition) {
  return condition.noise_m > 0.0 || condition.outlier_share > 0.0 || condition.repeat_share > 0.0;
}

/// Of its own for each seed and each trajectory.
inline std::mt19937_64 hand_random(int seed, std::size_t trajectory) {
  return std::mt19937_64{static_cast<std::uint64_t>(seed) * 100003 + trajectory};
}

/// Labels with a report near enough, reports with none, and labels.
struct DetectionScore {
  std::size_t found{0};
  std::size_t false_reports{0};
  std::size_t labels{0};

  [[nodiscard]] double precision() const {
    return found + false_reports == 0 ? 1.0 : static_cast<double>(found) / static_cast<double>(found + false_reports);
  }
  [[nodiscard]] double recall() const {
    return labels == 0 ? 1.0 : static_cast<double>(found) / static_cast<double>(labels);
  }
  void add(const std::vector<Eigen::Vector3d>& truth, const std::vector<HandAction>& actions, double radius_m) {
    labels += truth.size();
    const auto near = [&](const Eigen::Vector3d& label, const HandAction& action) {
      return (label - action.position_m).norm() <= radius_m;
    };
    found += static_cast<std::size_t>(std::count_if(truth.begin(), truth.end(), [&](const Eigen::Vector3d& label) {
      return std::any_of(actions.begin(), actions.end(), [&](const HandAction& a) { return near(label, a); });
    }));
    false_reports += static_cast<std::size_t>(std::count_if(actions.begin(), actions.end(), [&](const HandAction& a) {
      return std::none_of(truth.begin(), truth.end(), [&](const Eigen::Vector3d& label) { return near(label, a); });
    }));
  }
};

/// What a stream reports, and the times of the samples with which it did.
struct StreamedActions {
  std::vector<HandAction> actions;
  std::vector<double> reported_s;
};

/// Expects a valid trajectory.
inline StreamedActions streamed_actions(const HandTrajectory& hand) {
  StreamedActions streamed;
  DipStream stream = DipStream::create().value();
  for (const HandSample& sample : hand) {
    const std::vector<HandAction> actions = stream.put(sample).value();
    for (const HandAction& action : actions) {
      streamed.actions.push_back(action);
      streamed.reported_s.push_back(sample.time_s);
    }
  }
  return streamed;
}

/// For each label that was found within 0.2 m: from the sample nearest to it to the first such report.
inline std::vector<double> latencies_s(const StreamedActions& streamed, const HandTrajectory& hand,
                                       const std::vector<Eigen::Vector3d>& labels_m) {
  std::vector<double> found_s;
  for (const Eigen::Vector3d& label : labels_m) {
    const auto nearest = std::min_element(hand.begin(), hand.end(), [&](const HandSample& a, const HandSample& b) {
      return (a.position_m - label).squaredNorm() < (b.position_m - label).squaredNorm();
    });
    for (std::size_t i = 0; i < streamed.actions.size(); ++i) {
      if ((streamed.actions[i].position_m - label).norm() > 0.2) continue;
      found_s.push_back(streamed.reported_s[i] - nearest->time_s);
      break;
    }
  }
  return found_s;
}

}  // namespace saccade::test
