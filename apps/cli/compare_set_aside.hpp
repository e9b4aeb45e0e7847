// SPDX-License-Identifier: Apache-2.0
#pragma once
// --set-aside of campaigns: shards that are damaged make way, so that a merge or a submission goes on without them.

#include <filesystem>
#include <string>
#include <vector>

#include "compare_options.hpp"
#include "context.hpp"

namespace saccade::cli {

/// Reads all shards of a campaign from end to end, and moves the folders of those that are damaged or were cut short to
/// DIR/set-aside, where nothing is read; warns of each. Their runs count as missing then. invalid_argument for one
/// whose slice runs; io_failure where one cannot be moved.
[[nodiscard]] Status set_aside_damaged(Context& context, const std::filesystem::path& out);

/// Names in DIR/set-aside, sorted.
[[nodiscard]] std::vector<std::string> set_aside_shards(const std::filesystem::path& out);

/// Adds to an error on a damaged shard of the campaign that --set-aside moves it away.
[[nodiscard]] Error with_set_aside_hint(Error error, const CompareOptions& options);

}  // namespace saccade::cli
