// SPDX-License-Identifier: Apache-2.0
#pragma once
// The page of `saccade compare`: index.html in the folder of the results.

#include "compare_output.hpp"
#include "comparison.hpp"
#include "saccade/report/comparison_report.hpp"

namespace saccade::cli {

/// @param planned runs of the comparison, finished or not
[[nodiscard]] ComparisonReport comparison_report(const Comparison& comparison, const ComparedRuns& compared,
                                                 std::size_t planned);

}  // namespace saccade::cli
