// SPDX-License-Identifier: Apache-2.0
#pragma once
// The page of a campaign, index.html: of one that is merged, and of one whose slices are still at work.

#include "compare_output.hpp"
#include "compare_slices.hpp"
#include "comparison.hpp"
#include "context.hpp"

namespace saccade::cli {

constexpr const char* kPageFile{"index.html"};

/// The result of a comparison: what it compares, the figures of its runs, how many there are, and by which versions.
/// @param planned  runs
[[nodiscard]] nlohmann::json campaign_json(const Comparison& comparison, const ComparedRuns& compared,
                                           std::size_t planned);

/// Adds how far the slices of a campaign are to its result: {slices, slices_at, set_aside, unreadable}, and
/// runs.in_shards.
/// @param merged  runs in the campaign
/// @param slices  number of slices that are to be shown although none of them has begun; 0: none
[[nodiscard]] Status add_slices(nlohmann::json& result, const Comparison& comparison, std::size_t merged,
                                std::size_t slices);

/// Writes the page of a campaign whose slices are at work: the figures of what is merged, how far each slice is, what
/// failed, and which shards cannot be read. Other slices may do the same at once; the last one stays. The page of a
/// campaign that is merged as a whole stays as it is.
/// @param slices  number of slices that are to be shown although none of them has begun; 0: none
/// Costs what reading the campaign and its shards costs.
[[nodiscard]] Status write_page_of_slices(const Context& context, const Comparison& comparison, std::size_t slices);
/// Writes the page where the scenes or the arm of a comparison cannot be read, so that there are no runs to be planned:
/// the slices alone, with their errors.
[[nodiscard]] Status write_page_of_failed_start(const Context& context, const std::filesystem::path& out);
/// Writes the page of the slices, and warns where that fails: the page is of less weight than what it shows.
void refresh_page(Context& context, const Comparison& comparison, std::size_t slices = 0);

}  // namespace saccade::cli
