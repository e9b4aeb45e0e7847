// SPDX-License-Identifier: Apache-2.0
#pragma once
// Experiments: what several tables are made from, each carried out by the first that needs it.

#include <optional>

#include "experiments/annotations.hpp"
#include "experiments/explorations.hpp"
#include "experiments/filtered_frames.hpp"
#include "experiments/salient_scan.hpp"
#include "experiments/scan_trackings.hpp"
#include "experiments/surfel_trials.hpp"
#include "experiments/updates.hpp"
#include "thesis/update_task.hpp"

namespace saccade::reproduce {

struct Experiments {
  std::optional<TrackedScans> tracked_scans;
  std::optional<UpdateExperiments> updates;
  std::optional<thesis::UpdateTask> update_task;
  ExplorationExperiments explorations;
  std::optional<FilteredFrames> filtered_frames;
  std::optional<SegmentedScan> salient_scan;
  SurfelExperiments surfels;
  std::optional<AnnotationExperiments> annotations;
};

/// Makes the map of thesis §2.4.4 unless it is there. Errors of make_update_task.
[[nodiscard]] Status carry_out_update_task(const TableOptions& options, const Executor& executor,
                                           const Progress& progress, std::optional<thesis::UpdateTask>& task);

}  // namespace saccade::reproduce
