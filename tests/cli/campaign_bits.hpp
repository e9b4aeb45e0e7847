// SPDX-License-Identifier: Apache-2.0
#pragma once
// bits_of: what a campaign holds but its times, every number with all its bits. shard_file: a slice's campaign.

#include <algorithm>
#include <string>
#include <vector>

#include "run_program.hpp"
#include "saccade/io/files/sqlite_file.hpp"

namespace saccade::test {

/// A table of a campaign without its times, row by row and sorted; numbers with all their bits.
inline std::vector<std::string> rows_of(const SqliteFile& file, const std::string& table, const std::string& from) {
  auto names = SqliteStatement::prepare(file, "SELECT name FROM pragma_table_info('" + table + "')");
  std::string columns{"''"};
  while (*names->step()) {
    const std::string name = names->text();
    if (name == "id" || name == "run" || name == "seconds" || name == "finished_at" || name.ends_with("_ms")) continue;
    columns += "||' '||quote(" + table + '.' + name + ')';
  }
  auto rows = SqliteStatement::prepare(file, "SELECT " + columns + " FROM " + from);
  std::vector<std::string> all;
  while (*rows->step()) all.push_back(rows->text());
  std::sort(all.begin(), all.end());
  return all;
}

/// Runs and views.
inline std::vector<std::vector<std::string>> bits_of(const fs::path& out) {
  const SqliteFile file = SqliteFile::open_existing(out / "campaign.sqlite", 1000).value();
  return {rows_of(file, "runs", "runs"), rows_of(file, "views", "views JOIN runs ON runs.id = views.run")};
}

inline fs::path shard_file(const fs::path& out, const std::string& name) {
  return out / "shards" / name / "campaign.sqlite";
}

}  // namespace saccade::test
