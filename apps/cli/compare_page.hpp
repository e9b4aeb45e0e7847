// SPDX-License-Identifier: Apache-2.0
#pragma once
// The page of a campaign, index.html: of one that is merged, and of one whose slices are still at work.

#include "compare_output.hpp"
#include "compare_slices.hpp"
#include "comparison.hpp"
#include "context.hpp"

namespace saccade::cli {

constexpr const char* kPageFile{"index.html"};

/// The result of a comparison: what it compares, the figures of its runs, and how many there are.
/// @param planned  runs
[[nodiscard]] nlohmann::json campaign_json(const Comparison& comparison, const ComparedRuns& compared,
                                           std::size_t planned);

/// Writes the page of a campaign whose slices are at work: the figures of what is merged, how far each slice is, what
/// failed, and which shards cannot be read. Other slices may do the same at once; the last one stays.
/// @param slices  number of slices that are to be shown although none of them has begun; 0: none
/// Costs what reading the campaign and its shards costs.
[[nodiscard]] Status write_page_of_slices(const Context& context, const Comparison& comparison, std::size_t slices = 0);

}  // namespace saccade::cli
