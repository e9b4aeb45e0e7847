// SPDX-License-Identifier: Apache-2.0
// Parses the command line, runs the chosen subcommand, and turns its outcome into an exit status.
#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <new>

#include "add_value.hpp"
#include "command.hpp"
#include "command_tree.hpp"
#include "exit_status.hpp"
#include "help_formatter.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "saccade/core/freed_memory.hpp"
#include "saccade/core/version.hpp"
#include "unknown_argument.hpp"

namespace saccade::cli {
namespace {

constexpr const char* kFooter{
    "Exit status: 0 done, 1 a bug, 2 usage, 3 bad input, 4 not available here, 5 finished without any result,\n"
    "129, 130, 140 or 143 interrupted (SIGHUP, Ctrl-C, SIGUSR2, SIGTERM): what was done is kept.\n"
    "A second Ctrl-C ends at once.\n"
    "Lengths are in metres; points and poses are in the map's world frame; angles on the command line are in degrees."};

void add_global_options(CLI::App& program, GlobalOptions& global) {
  add_value(program, "--threads", global.threads, "N", "threads to use; 0: all cores. Results do not depend on it")
      ->check(CLI::Range(std::size_t{0}, std::size_t{4096}));
  add_value(program, "--seed", global.seed, "N", "seed of everything random")->check(check_whole_number);
  program.add_flag("--quiet,-q", global.quiet, "no progress and no notes on standard error");
  add_value(program, "--json", global.json, "FILE",
            "write the machine-readable result to a file; -: to standard output");
}

/// No option of the program or its subcommands takes an empty value, as a script's unset variable would be.
void refuse_empty_values(CLI::App& program) {
  for (CLI::Option* option : program.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    option->check([](const std::string& value) { return std::string{value.empty() ? "must not be empty" : ""}; });
  }
  for (CLI::App* subcommand : program.get_subcommands({})) refuse_empty_values(*subcommand);
}

/// "scene render": the command that was chosen, and those above it.
std::string chosen_path(const CLI::App& program) {
  const CLI::App* chosen = chosen_command(program);
  std::string path;
  for (; chosen != nullptr && chosen != &program; chosen = chosen->get_parent()) {
    path = chosen->get_name() + (path.empty() ? "" : " ") + path;
  }
  return path;
}

int fail(const CLI::App& program, ExitStatus status, const std::string& text) {
  const auto chosen = program.get_subcommands();
  print_error(chosen.empty() ? "" : chosen.front()->get_name(), text);
  return static_cast<int>(status);
}

int usage(const CLI::App& program, const std::string& text) {
  const std::string path = chosen_path(program);
  return fail(program, ExitStatus::usage, text + " (see saccade " + path + (path.empty() ? "" : " ") + "--help)");
}

/// What is wrong with arguments that were not parsed. One that is not known is said first: it may be why another one
/// is missing.
std::string parse_problem(const CLI::App& program, const CLI::ParseError& error) {
  const bool may_be_unknown = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                              dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (!may_be_unknown) return error.what();
  if (std::string unknown = unknown_argument(program); !unknown.empty()) return unknown;
  const CLI::App& chosen = *chosen_command(program);
  if (chosen.get_require_subcommand_min() > 0 && chosen.get_subcommands().empty()) {
    return "name what to do: " + listed(visible_commands(chosen));
  }
  return error.what();
}

int run(int argc, char** argv, CLI::App& program, Planners planners) {
  GlobalOptions global;
  global.planners = std::move(planners);
  if (argc > 1) global.arguments.assign(argv + 1, argv + argc);
  Action action;
  program.set_version_flag("--version", std::string{"saccade "}.append(version()));
  program.require_subcommand(1);
  program.fallthrough();
  program.footer(kFooter);
  program.formatter(std::make_shared<HelpFormatter>());
  add_global_options(program, global);
  for (AddCommand* add :
       {add_annotate, add_attend, add_benchmark, add_calibrate, add_cell,   add_compare, add_explore,
        add_filter,   add_fuse,   add_generate,  add_nbv,       add_info,   add_scene,   add_reproduce,
        add_robot,    add_score,  add_segment,   add_show,      add_sample, add_surfels, add_update}) {
    add(program, global, action);
  }
  refuse_empty_values(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help and --version
    return usage(program, parse_problem(program, error));
  }
  const Result<int> status = action();
  std::cout.flush();
  if (!std::cout) return fail(program, ExitStatus::bad_input, "standard output: cannot write the result");
  if (status) return *status;
  if (status.error().code == Errc::cancelled && interrupted()) {
    fail(program, ExitStatus::done, "interrupted; no result was written");
    return interrupt_status();
  }
  return fail(program, exit_status_of(status.error().code), status.error().to_string());
}

}  // namespace

int run_command_line(int argc, char** argv, Planners planners) {
  CLI::App program{"Saccade decides where a depth camera should look next, and builds the 3-D map as it goes.",
                   "saccade"};
  try {
    keep_freed_memory();
    install_interrupt_handler();
    return run(argc, argv, program, std::move(planners));
  } catch (const std::bad_alloc&) {
    return fail(program, ExitStatus::unavailable, "out of memory; use larger voxels or a smaller range");
  } catch (const std::exception& error) {
    return fail(program, ExitStatus::bug, std::string{"a bug in saccade, please report it: "} + error.what());
  }
}

}  // namespace saccade::cli
