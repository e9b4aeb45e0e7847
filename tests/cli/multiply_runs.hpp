// SPDX-License-Identifier: Apache-2.0
#pragma once
// multiply_runs: a campaign of many runs, made of a few by SQL.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "saccade/io/files/sqlite_file.hpp"

namespace saccade::test {

/// Copies the runs of seed 1 to the seeds first … last, and takes those of seed 1 away where first is not 2.
inline void multiply_runs(const std::filesystem::path& file, std::uint64_t first, std::uint64_t last) {
  const SqliteFile database = SqliteFile::open(file, 1000).value();
  const std::string many = std::to_string(database.integer("SELECT max(id) FROM runs").value());
  const auto copy = [&](const std::string& table, const std::string& id) {
    auto names = SqliteStatement::prepare(database, "SELECT name FROM pragma_table_info('" + table + "')");
    std::string columns;
    std::string values;
    while (*names->step()) {
      const std::string name = names->text();
      columns += (columns.empty() ? "" : ", ") + name;
      values += (values.empty() ? "" : ", ") + (name == id       ? name + " + " + many + " * n"
                                                : name == "seed" ? "n"
                                                                 : name);
    }
    ASSERT_TRUE(database.run("WITH RECURSIVE seeds(n) AS (SELECT " + std::to_string(first) +
                             " UNION ALL SELECT n + 1 FROM seeds WHERE n < " + std::to_string(last) + ") INSERT INTO " +
                             table + " (" + columns + ") SELECT " + values + " FROM seeds, (SELECT * FROM " + table +
                             ")"));
  };
  ASSERT_TRUE(database.run("PRAGMA synchronous = OFF; PRAGMA foreign_keys = OFF"));
  copy("views", "run");
  copy("runs", "id");
  if (first == 2) return;
  ASSERT_TRUE(database.run("DELETE FROM views WHERE run <= " + many + "; DELETE FROM runs WHERE id <= " + many));
}

}  // namespace saccade::test
