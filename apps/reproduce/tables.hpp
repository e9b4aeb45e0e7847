// SPDX-License-Identifier: Apache-2.0
#pragma once
// TableEntry, thesis_tables: every table and figure of the thesis that can be reproduced. A further one is a source of
// its own in tables/, with a line in tables.cpp.

#include <span>
#include <string_view>

#include "reproduced_table.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/result.hpp"
#include "table_options.hpp"

namespace saccade::reproduce {

struct Experiments;

/// Makes a table from the experiments that it needs, carrying out those that no table before it needed.
using ReproduceTable = Result<ReproducedTable>(const TableOptions& options, Experiments& experiments,
                                               const Executor& executor, const Progress& progress);

/// How long something takes on the two cores that times were taken on; see machine_factor.
struct TableCost {
  double full_s{0.0};
  double quick_s{0.0};
};

struct TableEntry {
  std::string_view number;  ///< "2.1"; of a figure with a table's number "fig-4.5"
  std::string_view title;
  ReproduceTable* reproduce{nullptr};
  TableCost cost;                 ///< cost of the table alone, its experiment included
  std::string_view experiment{};  ///< carried out once for all tables that name it
  bool draws{false};              ///< plots or pictures
  bool needs_hands{false};        ///< TableOptions::hands
  bool has_printed{false};        ///< heeds TableOptions::as_printed
};

/// Lists them in the order of the thesis.
[[nodiscard]] std::span<const TableEntry> thesis_tables();
/// nullptr: there is none. A figure is found by "fig-2.12" as well as by "2.12".
[[nodiscard]] const TableEntry* find_table(std::string_view number);

}  // namespace saccade::reproduce
