// SPDX-License-Identifier: Apache-2.0
#pragma once
// Foresight: weighs views by what comes after them, by the time that they take, and by what is seen on the way.

#include <cstddef>
#include <cstdint>

#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/explore/ranking.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

/// What makes one view better than another.
enum class Objective : std::uint8_t {
  surface,             ///< its gain
  surface_per_second,  ///< its gain for the time of the motion and of looking
};
inline constexpr auto kObjectiveNames =
    make_names<Objective>({{Objective::surface, "surface"}, {Objective::surface_per_second, "surface-per-second"}});

[[nodiscard]] constexpr std::string_view to_string(Objective objective) { return kObjectiveNames.of(objective); }

struct Foresight {
  /// Views that one after the other make known most, soonest: the next view is one of them; they are chosen anew for
  /// each. 1: the best one.
  std::size_t lookahead{1};
  Objective objective{Objective::surface};
  double frame_on_way_s{0.0};  ///< seconds between frames that are fused on the way to a view; 0: none are

  /// Whether the order of gains is not all that matters.
  [[nodiscard]] bool is_needed() const {
    return lookahead > 1 || objective != Objective::surface || frame_on_way_s > 0.0;
  }
};

/// Puts the view to which the robot is to go to the front of the ranking, and behind it the others of the set, then the
/// rest as they were. The set is best_sequence of `lookahead` views, or of 8 to choose from where it is 1. Of the set,
/// the view comes first that is worth most, with what frames on the way show, or most for its time. Views of the set
/// that the robot cannot reach stay where they were. Does nothing where the gain makes no promises.
/// Costs a motion's planning for each view of the set, and the promises of 256 views. Errors: those of the robot.
[[nodiscard]] Status look_ahead(const Foresight& foresight, Robot& robot, const Executor& executor, Ranking& ranking);

}  // namespace saccade
