// SPDX-License-Identifier: Apache-2.0
#pragma once
// The three detectors of hand actions.

#include <utility>
#include <vector>

#include "saccade/attention/dip_detector.hpp"
#include "saccade/attention/gmm_as.hpp"
#include "saccade/attention/zvc.hpp"

namespace saccade::test {

inline Result<std::vector<HandAction>> by_dips(const HandTrajectory& trajectory) {
  SACCADE_TRY(DipResult result, detect_dips(trajectory));
  return std::move(result.actions);
}

inline Result<std::vector<HandAction>> by_gmm(const HandTrajectory& trajectory) {
  SACCADE_TRY(GmmAsResult result, detect_by_gmm(trajectory));
  return std::move(result.actions);
}

inline Result<std::vector<HandAction>> by_zvc(const HandTrajectory& trajectory) {
  SACCADE_TRY(ZvcResult result, detect_by_zvc(trajectory));
  return std::move(result.actions);
}

}  // namespace saccade::test
