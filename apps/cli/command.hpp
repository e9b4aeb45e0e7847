// SPDX-License-Identifier: Apache-2.0
#pragma once
// GlobalOptions; Command, CommandInfo, Outcome and add_command: a command declares its options, checks them and runs.
// What is the same for all of them is done here once: parsing, the folder of results, the progress bar, Ctrl-C, the
// envelope of the JSON result, the text for people, and the exit status.

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/explore/planners.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

class Context;
class Options;

struct GlobalOptions {
  Planners planners{};     ///< strategies that have a name
  std::size_t threads{0};  ///< 0: all cores
  std::uint64_t seed{1};
  bool quiet{false};
  std::string json;                      ///< a file, "-" for standard output, or empty
  std::vector<std::string> arguments{};  ///< the command line after the program's name, as it was given

  [[nodiscard]] Executor executor() const { return Executor::with_threads(threads); }
  [[nodiscard]] bool json_to_stdout() const { return json == "-"; }
};

struct CommandInfo {
  std::string name;
  std::string description;
  std::string result_name{};  ///< its name in the JSON result and in errors; empty: the name
  bool hidden{false};         ///< not listed in the help
};

/// Result of a command. The scaffold writes it and ends the program accordingly.
struct Outcome {
  nlohmann::json result{};  ///< for machines; goes into the envelope; null: no JSON result is written
  std::string text{};       ///< for people; printed unless the JSON result goes to standard output
  std::string empty{};      ///< why there is nothing to show for the work; exit status 5
  std::string cut_short{};  ///< what was kept of work that did not come to its end
  std::vector<std::string> warnings{};
  std::function<void()> afterwards{};  ///< runs when all is written: a page is served until Ctrl-C

  /// Says that there is nothing to show, where that is so.
  [[nodiscard]] Outcome empty_if(bool is_empty, std::string why) && {
    if (is_empty) empty = std::move(why);
    return std::move(*this);
  }
};

/// A command of the program. It neither prints nor names an exit status (tests/layers/check_commands.py).
class Command {
 public:
  Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;
  virtual ~Command() = default;

  [[nodiscard]] virtual CommandInfo info() const = 0;
  /// Declares arguments and options; what they set outlives the parsing.
  virtual void declare(Options& /*options*/) {}
  /// Checks what no option sees alone. Throws usage errors (options.hpp).
  virtual void check(const GlobalOptions& /*global*/) {}
  [[nodiscard]] virtual Result<Outcome> run(Context& /*context*/) { return Outcome{}; }
  /// Commands below this one; where there are any, one of them has to be named, and this one is not run.
  [[nodiscard]] virtual std::vector<std::unique_ptr<Command>> parts() const { return {}; }
};

/// Returns the exit status, or an Error for main() to print.
using Action = std::function<Result<int>()>;

/// Adds a command and the commands below it. `global` and `action` outlive the parsing; the chosen command becomes the
/// action.
void add_command(CLI::App& program, const GlobalOptions& global, Action& action, std::shared_ptr<Command> command);

template <class C>
void add_command(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command(program, global, action, std::make_shared<C>());
}

/// Adds a subcommand. `global` and `action` outlive the parsing. Options are checked while they are parsed; what is
/// wrong with them is thrown as CLI::ValidationError.
using AddCommand = void(CLI::App& program, const GlobalOptions& global, Action& action);
AddCommand add_annotate, add_attend, add_benchmark, add_calibrate, add_cell, add_compare, add_explore, add_filter,
    add_fuse, add_generate, add_info, add_nbv, add_reproduce, add_robot, add_sample, add_scene, add_score, add_segment,
    add_show, add_surfels, add_update;

}  // namespace saccade::cli
