// SPDX-License-Identifier: Apache-2.0
#pragma once
// misplaced_points: stray and missing points of annotations, for Figs. 4.20 and 4.21.

#include "experiments/annotations.hpp"

namespace saccade::reproduce {

enum class Misplaced { stray, missing };

/// Counts, for each way to annotate, the points that got the label of an object that they are not on (stray), or that
/// are on an object without getting its label (missing), and draws them red on the cloud that has most of them by
/// rectangles.
/// @param number  of the figure, "4.20"
/// Errors of carry_out_annotations.
[[nodiscard]] Result<ReproducedTable> misplaced_points(Misplaced what, const std::string& number,
                                                       const TableOptions& options, const Executor& executor,
                                                       const Progress& progress,
                                                       std::optional<AnnotationExperiments>& all);

}  // namespace saccade::reproduce
