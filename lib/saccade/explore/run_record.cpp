// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/run_record.hpp"

#include <array>
#include <string>

namespace saccade {
namespace {

constexpr std::array kStopReasons{StopReason::regions_done, StopReason::views_used_up, StopReason::no_candidate,
                                  StopReason::cancelled};

}  // namespace

std::string_view to_string(StopReason reason) {
  switch (reason) {
    case StopReason::regions_done: return "regions_done";
    case StopReason::views_used_up: return "views_used_up";
    case StopReason::no_candidate: return "no_candidate";
    default: return "cancelled";
  }
}

Result<StopReason> stop_reason(std::string_view text) {
  for (const StopReason reason : kStopReasons) {
    if (to_string(reason) == text) return reason;
  }
  return Error{Errc::corrupt_data, "there is no reason to stop called \"" + std::string{text} + "\"", ""};
}

std::string_view to_string(RegionStatus status) {
  switch (status) {
    case RegionStatus::not_begun: return "not_begun";
    case RegionStatus::done: return "done";
    case RegionStatus::out_of_reach: return "out_of_reach";
    default: return "interrupted";
  }
}

}  // namespace saccade
