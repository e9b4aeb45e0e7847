// SPDX-License-Identifier: Apache-2.0
#pragma once
// Campaigns in slices: a slice into its shard, how far all are, and the merge.

#include "compare_slices.hpp"
#include "context.hpp"

namespace saccade::cli {

/// Runs what the slice lacks and keeps it in DIR/shards/I-of-N. What the campaign of DIR has already is not done again.
/// The folder is locked meanwhile: a second process of this machine is refused.
[[nodiscard]] Result<Outcome> run_slice(Context& context, const Comparison& comparison);

/// Runs that are done, in the campaign of a folder and in these shards.
/// @param broken  takes the errors of shards that cannot be read, which count as empty then; null: the first ends it
[[nodiscard]] Result<CampaignIndex> done_in(const std::filesystem::path& out,
                                            const std::vector<std::filesystem::path>& shards,
                                            std::vector<Error>* broken = nullptr);

/// Says how far the campaign and its slices are. Writes nothing.
[[nodiscard]] Result<Outcome> slice_status(const Comparison& comparison);

/// Adds what the shards have to the campaign. All are read from end to end first; what is wrong with one of them, or is
/// not of this comparison, is an error that names it, and the campaign stays as it was.
/// @param open  makes and opens the campaign of DIR, once all shards are known to be good
[[nodiscard]] Result<CampaignMerge> merge_shards(const Comparison& comparison,
                                                 const std::vector<std::filesystem::path>& shards,
                                                 const std::function<Result<const Campaign*>()>& open);

/// The shards that --merge names, without the campaign itself.
[[nodiscard]] Result<std::vector<std::filesystem::path>> shards_to_merge(const CompareOptions& options);

}  // namespace saccade::cli
