// SPDX-License-Identifier: Apache-2.0
#pragma once
// Phase and PhaseTimes: how the wall time of a view is spent.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string_view>

#include "saccade/core/clock.hpp"
#include "saccade/core/names.hpp"

namespace saccade {

/// Phases of a view, in the order in which they are done.
enum class Phase : std::uint8_t {
  obstacles,     ///< the robot's obstacle map is brought up to date with the map
  candidates,    ///< view poses are generated
  segmentation,  ///< the surface is cut into segments
  saliency,      ///< attention ranks regions of interest
  reachability,  ///< the robot tests view poses
  gain,          ///< views are evaluated
  planning,      ///< motions are planned
  motion,        ///< the robot moves
  fusion,        ///< frames are taken and fused
};

/// Names in files: keys of JSON, columns of tables.
inline constexpr auto kPhaseNames = make_names<Phase>({{Phase::obstacles, "planner_map"},
                                                       {Phase::candidates, "candidates"},
                                                       {Phase::segmentation, "segmentation"},
                                                       {Phase::saliency, "saliency"},
                                                       {Phase::reachability, "reachability"},
                                                       {Phase::gain, "evaluation"},
                                                       {Phase::planning, "planning"},
                                                       {Phase::motion, "motion"},
                                                       {Phase::fusion, "fusion"}});
[[nodiscard]] constexpr std::string_view to_string(Phase phase) { return kPhaseNames.of(phase); }
/// Returns the name for people.
[[nodiscard]] constexpr std::string_view text_of(Phase phase) {
  if (phase == Phase::obstacles) return "planner's map";
  return phase == Phase::planning ? "motion planning" : to_string(phase);
}

/// Milliseconds per phase. For one thread.
class PhaseTimes {
 public:
  void add(Phase phase, double ms) { ms_[static_cast<std::size_t>(phase)] += ms; }
  void add(const PhaseTimes& other) {
    for (std::size_t i = 0; i < ms_.size(); ++i) ms_[i] += other.ms_[i];
  }
  [[nodiscard]] double ms(Phase phase) const { return ms_[static_cast<std::size_t>(phase)]; }
  [[nodiscard]] double total_ms() const { return std::accumulate(ms_.begin(), ms_.end(), 0.0); }

  /// Calls `work` and adds its time to the phase. Time that `work` itself measures here counts for the inner phase
  /// only.
  template <class Work>
  decltype(auto) measure(Phase phase, const Work& work) {
    const Measured measured{*this, phase};
    return work();
  }

  [[nodiscard]] bool operator==(const PhaseTimes&) const = default;

 private:
  struct Measured {
    PhaseTimes& times;
    Phase phase;
    double before_ms{times.total_ms()};
    Stopwatch stopwatch{};
    ~Measured() { times.add(phase, std::max(0.0, stopwatch.elapsed_ms() - (times.total_ms() - before_ms))); }
  };
  std::array<double, kPhaseNames.values.size()> ms_{};
};

}  // namespace saccade
