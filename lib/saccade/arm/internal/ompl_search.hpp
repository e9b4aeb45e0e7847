// SPDX-License-Identifier: Apache-2.0
#pragma once
// OMPL behind a few own types: a path of free straight motions from one configuration to any of several.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

/// Queries available to a search. Motions are straight lines.
struct MotionSpace {
  const ArmModel& arm;
  std::function<bool(const Configuration& q)> is_free;
  std::function<bool(const Configuration& from, const Configuration& to)> motion_is_free;
};

struct SearchEffort {
  int max_motions;
  double budget_s;
  std::uint64_t seed;
};

struct SearchResult {
  std::optional<JointPath> path;  ///< from the start to one of the goals, both to the bit
  int motions{0};
  bool out_of_time{false};  ///< the budget ran out before the motions did
};

[[nodiscard]] std::vector<std::string> ompl_planner_names();

/// Searches for a path. Expects a known planner, a free start, and at least one free goal within the limits. Distances
/// are seconds at full speed, Euclidean over the joints. A continuous joint turns at most one whole turn beyond the
/// start and the goals.
[[nodiscard]] SearchResult search_with_ompl(const std::string& planner, const MotionSpace& space,
                                            const Configuration& start, std::span<const Configuration> goals,
                                            const SearchEffort& effort);

}  // namespace saccade
