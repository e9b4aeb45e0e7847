// SPDX-License-Identifier: Apache-2.0
#pragma once
// HandTrajectory: where a hand was, sample after sample; HandAction: where and when it did something;
// LabelledTrajectory: both.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace saccade {

/// One reading of the motion sensor on the hand.
struct HandSample {
  double time_s{0.0};
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};  ///< in the world frame
  std::optional<Eigen::Quaterniond> R_world_hand{};     ///< where the sensor gives it
};

/// A task of the hand, by increasing time.
using HandTrajectory = std::vector<HandSample>;

/// A place where the hand may have changed something: a point of interest (POI) of thesis §2.2.4.
struct HandAction {
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};
  double time_s{0.0};
  double saliency{0.0};  ///< in the unit of the detector that found it; larger is more certain
  std::string why;       ///< one line for people
};

/// A trajectory with the places where the hand is known to have acted.
struct LabelledTrajectory {
  std::string name;
  HandTrajectory trajectory;
  std::vector<Eigen::Vector3d> labels_m;
};

}  // namespace saccade
