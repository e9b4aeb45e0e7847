// SPDX-License-Identifier: Apache-2.0
#pragma once
// Foresight: weighs views by later views, by their duration, and by what is seen during the motion.

#include <cstddef>
#include <cstdint>

#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/explore/ranking.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

/// Criterion for comparing views.
enum class Objective : std::uint8_t {
  surface,             ///< its gain
  surface_per_second,  ///< its gain relative to the time of motion and view
};
inline constexpr auto kObjectiveNames =
    make_names<Objective>({{Objective::surface, "surface"}, {Objective::surface_per_second, "surface-per-second"}});

[[nodiscard]] constexpr std::string_view to_string(Objective objective) { return kObjectiveNames.of(objective); }

struct Foresight {
  /// Number of views that together make most known, soonest; the next view is one of them. They are chosen anew for
  /// each view. 1: the best one.
  std::size_t lookahead{1};
  Objective objective{Objective::surface};
  double frame_on_way_s{0.0};  ///< seconds between frames fused on the way to a view; 0: none

  /// Tells whether anything besides the order of gains matters.
  [[nodiscard]] bool is_needed() const {
    return lookahead > 1 || objective != Objective::surface || frame_on_way_s > 0.0;
  }
};

/// Moves the robot's next view to the front of the ranking, followed by the others of the set, then the rest unchanged.
/// The set is best_sequence of `lookahead` views, or of 8 to choose from where it is 1. The first is the view of the
/// set with the largest worth, including frames during the motion, or the largest worth per time. Views of the set that
/// the robot cannot reach keep their place. Does nothing where the gain makes no promises. Costs planning a motion for
/// each view of the set, and the promises of 256 views. Errors: those of the robot.
[[nodiscard]] Status look_ahead(const Foresight& foresight, Robot& robot, const Executor& executor, Ranking& ranking);

}  // namespace saccade
