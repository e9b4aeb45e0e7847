// SPDX-License-Identifier: Apache-2.0
#pragma once
// FilteredFrames: simulated depth images of a Kinect v2 after each filter, for Table 3.4 and Fig. 3.23.

#include <array>
#include <optional>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "table_options.hpp"
#include "thesis/filter_trials.hpp"

namespace saccade::reproduce {

/// Input of Table 3.4.
struct Pipeline {
  const char* name;
  const char* here;
  int measurements;  ///< in the thesis; 0: not there
  int outliers;
};
constexpr std::array<Pipeline, 5> kPipelines{{{"–", "no filter", 0, 0},
                                              {"Bilateral", "bilateral", 83125, 1874},
                                              {"Bilateral+Edge-aware", "bilateral, edge-aware", 81611, 849},
                                              {"Bilateral+Proposed filter", "bilateral, thesis' filter", 79756, 182},
                                              {"–", "bilateral, ours", 0, 0}}};

struct FilteredFrames {
  thesis::FilterScene scene;
  PinholeCamera camera;
  std::array<std::vector<DepthImage>, kPipelines.size()> by_pipeline;
};

/// Makes and filters the frames unless that was done. cancelled; errors of the simulated camera and the filters.
[[nodiscard]] Status carry_out_filters(const TableOptions& options, const Executor& executor, const Progress& progress,
                                       std::optional<FilteredFrames>& frames);

}  // namespace saccade::reproduce
