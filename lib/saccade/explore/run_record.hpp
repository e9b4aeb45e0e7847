// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunRecord: the record of one exploration.

#include <cstdint>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/explore/view_record.hpp"

namespace saccade {

enum class StopReason : std::uint8_t {
  regions_done,   ///< no reachable view of any region gains enough
  views_used_up,  ///< the allowed number of views was taken
  no_candidate,   ///< no view of a region is reachable, or none of those with enough gain
  cancelled,      ///< the caller cancelled, by progress or approval
};
inline constexpr auto kStopReasonNames = make_names<StopReason>({{StopReason::regions_done, "regions_done"},
                                                                 {StopReason::views_used_up, "views_used_up"},
                                                                 {StopReason::no_candidate, "no_candidate"},
                                                                 {StopReason::cancelled, "cancelled"}});
[[nodiscard]] constexpr std::string_view to_string(StopReason reason) { return kStopReasonNames.of(reason); }

/// Status of the exploration of one region.
enum class RegionStatus : std::uint8_t {
  not_begun,
  done,          ///< no view left to attempt gains enough
  out_of_reach,  ///< views with enough gain exist, but the robot could not take them
  interrupted,   ///< the run ended before the region was done
};
inline constexpr auto kRegionStatusNames = make_names<RegionStatus>({{RegionStatus::not_begun, "not_begun"},
                                                                     {RegionStatus::done, "done"},
                                                                     {RegionStatus::out_of_reach, "out_of_reach"},
                                                                     {RegionStatus::interrupted, "interrupted"}});
[[nodiscard]] constexpr std::string_view to_string(RegionStatus status) { return kRegionStatusNames.of(status); }

/// Result of exploring one region.
struct RegionResult {
  RegionStatus status{RegionStatus::not_begun};
  double gain_left{0.0};    ///< predicted gain of the best view not yet attempted, at the last ranking; 0: none
  double gain_needed{0.0};  ///< smallest gain worth taking at that time
  RefusalCounts refused{};  ///< out_of_reach: reasons
};

/// Record of the initial scan.
struct ScanRecord {
  bool complete{true};       ///< false: cancelled
  std::size_t attempted{0};  ///< number of poses finished, in their order
  std::size_t views{0};
  std::size_t frames{0};    ///< fused
  RefusalCounts refused{};  ///< poses that were skipped
  Measures measures{};      ///< the map after it
};

struct RunRecord {
  ScanRecord scan{};
  std::vector<ViewRecord> views{};
  std::vector<RegionResult> regions{};  ///< one for each region
  StopReason stopped_because{StopReason::regions_done};
  RefusalCounts refused_at_end{};  ///< no_candidate: reasons, for the last region without a reachable view

  /// Returns the measures after the last view, or after the scan.
  [[nodiscard]] const Measures& final() const { return views.empty() ? scan.measures : views.back().measures; }
};

}  // namespace saccade
