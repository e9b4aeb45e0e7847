// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunRecord: what is kept of one exploration.

#include <cstdint>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/explore/view_record.hpp"

namespace saccade {

enum class StopReason : std::uint8_t {
  regions_done,   ///< no view of any region that the robot can take gains enough
  views_used_up,  ///< as many views as were allowed
  no_candidate,   ///< no view of a region can be reached, or none of those that would gain enough
  cancelled,      ///< the caller's progress or approval said so
};
inline constexpr auto kStopReasonNames = make_names<StopReason>({{StopReason::regions_done, "regions_done"},
                                                                 {StopReason::views_used_up, "views_used_up"},
                                                                 {StopReason::no_candidate, "no_candidate"},
                                                                 {StopReason::cancelled, "cancelled"}});
[[nodiscard]] constexpr std::string_view to_string(StopReason reason) { return kStopReasonNames.of(reason); }

/// How the exploration of one region ended.
enum class RegionStatus : std::uint8_t {
  not_begun,
  done,          ///< no view that was not attempted gains enough
  out_of_reach,  ///< some would gain as much, but the robot could not take them
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
  double gain_needed{0.0};  ///< a view that gains less than this was not worth going to, then
  RefusalCounts refused{};  ///< out_of_reach: reasons
};

/// The initial scan.
struct ScanRecord {
  bool complete{true};       ///< false: cancelled
  std::size_t attempted{0};  ///< poses that are done with, in their order
  std::size_t views{0};
  std::size_t frames{0};    ///< fused
  RefusalCounts refused{};  ///< poses that were passed over
  Measures measures{};      ///< the map after it
};

struct RunRecord {
  ScanRecord scan{};
  std::vector<ViewRecord> views{};
  std::vector<RegionResult> regions{};  ///< one for each region
  StopReason stopped_because{StopReason::regions_done};
  RefusalCounts refused_at_end{};  ///< no_candidate: reasons, of the last region without a view in reach

  /// Measures after the last view, or after the scan.
  [[nodiscard]] const Measures& final() const { return views.empty() ? scan.measures : views.back().measures; }
};

}  // namespace saccade
