// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reports of a DipStream about a trajectory, and their delays.

#include <algorithm>
#include <vector>

#include "saccade/attention/dip_detector.hpp"

namespace saccade::test {

struct DipReport {
  HandAction action;
  double at_s{0.0};  ///< time of the sample with which it came
};

/// Expects a valid trajectory.
inline std::vector<DipReport> dip_reports(const HandTrajectory& hand) {
  DipStream stream = DipStream::create().value();
  std::vector<DipReport> reports;
  for (const HandSample& sample : hand) {
    const std::vector<HandAction> actions = stream.put(sample).value();
    for (const HandAction& action : actions) reports.push_back({action, sample.time_s});
  }
  return reports;
}

inline std::vector<HandAction> actions_of(const std::vector<DipReport>& reports) {
  std::vector<HandAction> actions;
  for (const DipReport& report : reports) actions.push_back(report.action);
  return actions;
}

/// For each label that was found within 0.2 m: from the sample nearest to it to the first such report.
inline std::vector<double> latencies_s(const std::vector<DipReport>& reports, const HandTrajectory& hand,
                                       const std::vector<Eigen::Vector3d>& labels_m) {
  std::vector<double> found_s;
  for (const Eigen::Vector3d& label : labels_m) {
    const auto nearest = std::min_element(hand.begin(), hand.end(), [&](const HandSample& a, const HandSample& b) {
      return (a.position_m - label).squaredNorm() < (b.position_m - label).squaredNorm();
    });
    const auto first = std::find_if(reports.begin(), reports.end(), [&](const DipReport& report) {
      return (report.action.position_m - label).norm() <= 0.2;
    });
    if (first != reports.end()) found_s.push_back(first->at_s - nearest->time_s);
  }
  return found_s;
}

}  // namespace saccade::test
