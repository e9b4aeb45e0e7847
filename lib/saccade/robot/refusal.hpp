// SPDX-License-Identifier: Apache-2.0
#pragma once
// Refusal: why a robot cannot bring the camera to a pose. RefusalCounts: how often, by reason.

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/names.hpp"

namespace saccade {

enum class Refusal : std::uint8_t {
  no_ik,               ///< no configuration of the arm puts the camera there
  outside_limits,      ///< each such configuration has a joint outside its limits
  goal_in_collision,   ///< each configuration within the limits is in collision
  start_in_collision,  ///< the arm is in collision where it stands
  no_path,             ///< no path was found from the arm's position
  declined,            ///< the robot itself declined
};
inline constexpr auto kRefusalNames = make_names<Refusal>({{Refusal::no_ik, "no_ik"},
                                                           {Refusal::outside_limits, "outside_limits"},
                                                           {Refusal::goal_in_collision, "goal_in_collision"},
                                                           {Refusal::start_in_collision, "start_in_collision"},
                                                           {Refusal::no_path, "no_path"},
                                                           {Refusal::declined, "declined"}});
/// Texts for people, to follow a number of poses.
inline constexpr auto kRefusalTexts = make_names<Refusal>({{Refusal::no_ik, "out of reach"},
                                                           {Refusal::outside_limits, "beyond a joint's limits"},
                                                           {Refusal::goal_in_collision, "in collision there"},
                                                           {Refusal::start_in_collision, "in collision at the start"},
                                                           {Refusal::no_path, "without a path"},
                                                           {Refusal::declined, "declined by the robot"}});
[[nodiscard]] constexpr std::string_view to_string(Refusal refusal) { return kRefusalNames.of(refusal); }

/// Number of refusals per reason.
class RefusalCounts {
 public:
  void add(Refusal refusal, std::size_t times = 1) { counts_[static_cast<std::size_t>(refusal)] += times; }
  /// Counts the poses that were refused.
  void add(std::span<const std::optional<Refusal>> refusals) {
    for (const std::optional<Refusal>& refusal : refusals) {
      if (refusal) add(*refusal);
    }
  }
  void add(const RefusalCounts& others) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += others.counts_[i];
  }
  [[nodiscard]] std::size_t of(Refusal refusal) const { return counts_[static_cast<std::size_t>(refusal)]; }
  [[nodiscard]] bool operator==(const RefusalCounts&) const = default;
  [[nodiscard]] std::size_t total() const { return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0}); }

 private:
  std::array<std::size_t, kRefusalNames.values.size()> counts_{};
};

/// Returns "2 out of reach, 1 without a path", in the order of the enumeration; empty without refusals.
[[nodiscard]] std::string in_words(const RefusalCounts& refused);

}  // namespace saccade
