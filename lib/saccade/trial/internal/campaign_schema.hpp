// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tables of a campaign file, and upgrades of files of earlier versions.

#include "saccade/io/files/sqlite_file.hpp"

namespace saccade {

/// Makes the tables in an empty file, or upgrades those of an older Saccade. Always writes once, so that a file that
/// cannot be written fails here. Runs within the caller's transaction. Errors: those of Campaign::open.
[[nodiscard]] Status make_campaign_tables(const SqliteFile& file);

}  // namespace saccade
