// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tables of a campaign file, and upgrades of files of earlier versions.

#include "saccade/io/files/sqlite_file.hpp"

namespace saccade {

/// How long a write waits for another process.
constexpr int kCampaignBusy_ms{10000};

/// Makes the tables in an empty file, or upgrades those of an older Saccade. Always writes once, so that a file that
/// cannot be written fails here. Runs within the caller's transaction. Errors: those of Campaign::open.
[[nodiscard]] Status make_campaign_tables(const SqliteFile& file);

/// Tells whether the file has the tables of this version; an empty file has none. Reads only. Errors: those of
/// Campaign::open_to_read.
[[nodiscard]] Result<bool> has_campaign_tables(const SqliteFile& file);

}  // namespace saccade
