// SPDX-License-Identifier: Apache-2.0
#pragma once
// ReproduceArguments: what `saccade reproduce` is told. Two programs read them: saccade, which starts saccade-reproduce
// (start_reproduce.cpp), and saccade-reproduce, which makes the tables (apps/reproduce/run_tables.cpp). Each links its
// own run_reproduce, so that options, help, errors and exit statuses are written once.

#include <filesystem>
#include <string>
#include <vector>

#include "command.hpp"
#include "reproduce/table_options.hpp"

namespace saccade::cli {

struct ReproduceArguments {
  std::vector<std::string> numbers;  ///< tables and figures
  reproduce::TableOptions options;
  bool all{false};
  bool list{false};
  std::filesystem::path markdown;
  std::filesystem::path out;  ///< folder for plots, pictures and the page of the tables; empty: none
  bool force{false};
  std::vector<std::string> words;  ///< the command line after the word reproduce, global options included
};

/// Throws a usage error for what makes no sense; saccade leaves that to saccade-reproduce.
void check_reproduce(ReproduceArguments& arguments, const GlobalOptions& global);
/// Makes or lists the tables, and returns the exit status.
[[nodiscard]] Result<int> run_reproduce(const ReproduceArguments& arguments, const GlobalOptions& global);

}  // namespace saccade::cli
