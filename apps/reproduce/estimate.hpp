// SPDX-License-Identifier: Apache-2.0
#pragma once
// Estimate: how long tables take on this machine, and how long those that are left.

#include <span>
#include <string>
#include <vector>

#include "saccade/core/clock.hpp"
#include "saccade/core/executor.hpp"
#include "tables.hpp"

namespace saccade::reproduce {

/// How many times longer than on the machine of TableEntry::cost work takes here: measured on a map that is fused,
/// which takes a tenth of a second.
[[nodiscard]] double machine_factor(const Executor& executor);

/// "20 s", "3 min", "2 h 10 min".
[[nodiscard]] std::string duration_text(double seconds);

/// Each experiment counts once, for the first table that needs it.
class Estimate {
 public:
  Estimate(const std::vector<const TableEntry*>& tables, bool quick, double factor);

  [[nodiscard]] double total_s() const;
  /// What is expected of one table, on top of the experiments of those before it.
  [[nodiscard]] double table_s(std::size_t table) const { return expected_s_.at(table); }
  /// Tells that a table took so long; what is left is scaled by that.
  void done(std::size_t table, double took_s);
  /// What is left, `running_s` after the table that is being made was begun.
  [[nodiscard]] double left_s(double running_s) const;

 private:
  std::vector<double> expected_s_;
  std::size_t next_{0};
  double took_s_{0.0};
};

}  // namespace saccade::reproduce
