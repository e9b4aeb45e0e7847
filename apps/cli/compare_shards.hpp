// SPDX-License-Identifier: Apache-2.0
#pragma once
// Campaigns in slices: a slice into its shard, how far all are, and the merge.

#include "compare_slices.hpp"
#include "context.hpp"

namespace saccade::cli {

/// Runs what the slice lacks and keeps it in DIR/shards/I-of-N. What the campaign of DIR has already is not done again.
/// The folder is locked meanwhile: a second process of this machine is refused. invalid_argument for a DIR that holds
/// other files than a campaign's; unsupported where the shard has runs of the slice by another version of Saccade.
[[nodiscard]] Result<Outcome> run_slice(Context& context, const Comparison& comparison);

/// Notes in the record of the slice that is asked for, if one is, that it failed before it began: its scenes or its arm
/// cannot be read; and writes the page. Leaves everything as it is where the record cannot be written.
void record_failed_start(const Context& context, const CompareOptions& options, const Error& error);
/// Returns what is needed to begin; where that failed, the record of the slice tells so (record_failed_start).
template <class T>
[[nodiscard]] Result<T> recorded(const Context& context, const CompareOptions& options, Result<T> needed) {
  if (!needed) record_failed_start(context, options, needed.error());
  return needed;
}

/// Refuses the empty file of a slice that is done, which has at least tables. corrupt_data.
[[nodiscard]] Status check_not_emptied(const std::filesystem::path& shard);

/// Runs that are done, in the campaign of a folder and in these shards. Runs in shards that another version of Saccade
/// made do not count, since they cannot be merged.
/// @param broken  takes the errors of shards that cannot be read, which count as empty then, and names shards with runs
///                of other versions; null: the first that cannot be read ends it
[[nodiscard]] Result<CampaignIndex> done_in(const std::filesystem::path& out,
                                            const std::vector<std::filesystem::path>& shards,
                                            std::vector<Error>* broken = nullptr);

/// Says how far the campaign and its slices are. Writes nothing. not_found for a folder without a campaign.
[[nodiscard]] Result<Outcome> slice_status(const Comparison& comparison);

struct ShardMerge : CampaignMerge {
  std::size_t other_settings{0};  ///< runs that are left out, and differ from one of the plan in their settings alone
};
/// "2 runs of other settings left out"; empty where none is.
[[nodiscard]] std::string left_out_text(const ShardMerge& merged);

/// Adds what the shards have of this comparison to the campaign; runs of others are left out, and counted. Each shard
/// is read from end to end, once. What is wrong with one of them is an error that names it, and so is a shard with runs
/// of others alone; the campaign stays as it was then, and one that `open` made is removed.
/// @param open  makes and opens the campaign of DIR; called last where it is there already
[[nodiscard]] Result<ShardMerge> merge_shards(const Comparison& comparison,
                                              const std::vector<std::filesystem::path>& shards,
                                              const std::function<Result<const Campaign*>()>& open);

/// The shards that --merge names, without the campaign itself. not_found where there is none, with the first error of
/// slices that failed before they began.
[[nodiscard]] Result<std::vector<std::filesystem::path>> shards_to_merge(const CompareOptions& options);

}  // namespace saccade::cli
