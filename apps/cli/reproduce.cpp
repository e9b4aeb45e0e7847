// SPDX-License-Identifier: Apache-2.0
// saccade reproduce TABLE…: tables of the thesis, ours beside theirs.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>

#include "command.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "saccade/core/clock.hpp"
#include "tables/thesis_table.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

Result<int> list_tables(const GlobalOptions& global) {
  const Stopwatch clock;
  SACCADE_CHECK(check_json_output(global));
  json tables = json::array();
  for (const ThesisTable& table : thesis_tables()) {
    tables.push_back({{"table", table.number}, {"title", table.title}});
    if (!global.json_to_stdout()) std::cout << std::left << std::setw(6) << table.number << table.title << '\n';
  }
  SACCADE_CHECK(write_json_output(global, json_envelope("reproduce", global, global.executor(),
                                                        {{"total", clock.elapsed_ms()}}, {{"known", tables}})));
  return static_cast<int>(ExitStatus::done);
}

json json_of(const std::string& number, const ReproducedTable& table) {
  json entry = table.figures;
  entry["table"] = number;
  entry["caption"] = table.caption;
  entry["notes"] = table.notes;
  return entry;
}

/// Prints one table after the other as they are done. After a failure `tables` has those before it.
Status reproduce_each(const std::vector<std::string>& numbers, const ReproduceOptions& options,
                      const GlobalOptions& global, const Executor& executor, json& tables, TimingsMs& timings_ms) {
  ProgressBar bar{global.quiet};
  Progress progress{
      [&bar](std::string_view stage, std::size_t done, std::size_t total) { bar.update(stage, done, total); }};
  const CancelOnInterrupt cancel{progress};
  for (const std::string& number : numbers) {
    const Stopwatch of_table;
    SACCADE_TRY(const ReproducedTable table, find_thesis_table(number)->reproduce(options, executor, progress));
    timings_ms["table " + number] = of_table.elapsed_ms();
    bar.finish();
    if (!global.json_to_stdout()) {
      if (!tables.empty()) std::cout << '\n';
      print(std::cout, table);
      std::cout << std::flush;
    }
    tables.push_back(json_of(number, table));
  }
  return {};
}

Result<int> run_reproduce(const std::vector<std::string>& numbers, const ReproduceOptions& options,
                          const GlobalOptions& global) {
  if (numbers.empty()) return list_tables(global);
  const Stopwatch clock;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_json_output(global));
  TimingsMs timings_ms;
  json tables = json::array();
  const Status status = reproduce_each(numbers, options, global, executor, tables, timings_ms);
  const std::size_t done = tables.size();
  if (done == 0) return status.error();
  timings_ms["total"] = clock.elapsed_ms();
  SACCADE_CHECK(write_json_output(
      global, json_envelope("reproduce", global, executor, timings_ms, {{"tables", std::move(tables)}})));
  if (status.ok()) return static_cast<int>(ExitStatus::done);
  if (status.error().code != Errc::cancelled) return status.error();
  const bool in_file = !global.json.empty() && !global.json_to_stdout();
  print_error("reproduce", "interrupted after " + std::to_string(done) + " of " + std::to_string(numbers.size()) +
                               " tables; what is done is on standard output" +
                               (in_file ? " and in " + global.json : ""));
  return interrupt_status();
}

/// Throws a usage error for a table that is not there, or that is named twice.
void check_numbers(const std::vector<std::string>& numbers) {
  for (auto number = numbers.begin(); number != numbers.end(); ++number) {
    if (std::find(numbers.begin(), number, *number) != number) usage_error("TABLE", *number + " is named twice");
    if (find_thesis_table(*number) != nullptr) continue;
    std::string known;
    for (const ThesisTable& table : thesis_tables()) known += (known.empty() ? "" : ", ") + std::string{table.number};
    usage_error("TABLE", "there is no table \"" + *number + "\"; known: " + known);
  }
}

}  // namespace

void add_reproduce(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("reproduce", "tables of the thesis, ours beside theirs");
  auto numbers = std::make_shared<std::vector<std::string>>();
  auto options = std::make_shared<ReproduceOptions>();
  command->add_option("tables", *numbers, "tables by their number; none: lists those that there are")
      ->type_name("TABLE");
  command
      ->add_option("--poses", options->poses,
                   "evaluate only so many of the view poses of Table 2.9: quicker, but no longer what the thesis did "
                   "(default: all)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}))
      ->type_name("N");
  command->callback([numbers, options, &global, &action] {
    check_numbers(*numbers);
    options->seed = global.seed;
    action = [numbers, options, &global] { return run_reproduce(*numbers, *options, global); };
  });
}

}  // namespace saccade::cli
