// SPDX-License-Identifier: Apache-2.0
#pragma once
// Details of the page of `saccade compare` beyond the result: curves, all paired differences, views run by run.

#include <nlohmann/json.hpp>

#include "compare_output.hpp"
#include "comparison.hpp"

namespace saccade::cli {

/// {measures, gaps, curves, marks, facts}, as web/src/report/compare.ts reads them.
[[nodiscard]] nlohmann::json comparison_details(const Comparison& comparison, const ComparedRuns& compared);

}  // namespace saccade::cli
