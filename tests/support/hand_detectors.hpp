// SPDX-License-Identifier: Apache-2.0
#pragma once
// The three detectors of hand actions, and what the thesis says of two of them.

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

/// Precision and recall, %.
struct Rates {
  double precision;
  double recall;
};

/// Thesis Table 2.2, over four users.
inline constexpr Rates kThesisPlacementsGmm{95.4, 95.9};
inline constexpr Rates kThesisPlacementsZvc{96.4, 97.3};
inline constexpr Rates kThesisPickAndPlaceGmm{97.7, 97.3};
inline constexpr Rates kThesisPickAndPlaceZvc{94.5, 98.2};

/// A row of Table 2.3 or 2.4.
struct ThesisHandRow {
  double speed;
  double sigma_m;
  Rates gmm;
  Rates zvc;
};
inline constexpr ThesisHandRow kThesisHandRows[] = {
    {0.25, 0.0, {98.0, 86.1}, {96.6, 93.0}},  {0.5, 0.0, {97.0, 95.9}, {95.7, 97.7}},
    {1.0, 0.0, {96.6, 96.6}, {95.5, 97.7}},   {2.0, 0.0, {96.8, 92.5}, {95.7, 97.7}},
    {4.0, 0.0, {97.0, 80.7}, {96.4, 97.7}},   {1.0, 0.001, {97.5, 98.4}, {95.4, 97.7}},
    {1.0, 0.025, {97.0, 80.2}, {95.1, 12.5}}, {1.0, 0.05, {98.6, 56.8}, {97.5, 0.5}},
};

}  // namespace saccade::test
