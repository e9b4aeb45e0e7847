// SPDX-License-Identifier: Apache-2.0
#pragma once
// The tables of a campaign file, and how files of earlier versions become files of this one.

#include "saccade/io/files/sqlite_file.hpp"

namespace saccade {

/// Makes the tables in an empty file, brings those of an older Saccade up to date, and writes once even where there is
/// nothing to do, so that a file that cannot be written fails here. Within the caller's transaction. Errors: those of
/// Campaign::open.
[[nodiscard]] Status make_campaign_tables(const SqliteFile& file);

}  // namespace saccade
