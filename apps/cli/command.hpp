// SPDX-License-Identifier: Apache-2.0
#pragma once
// GlobalOptions, and the subcommands: each adds itself to the program and, when it is chosen, sets what is to be run.

#include <cstdint>
#include <functional>
#include <string>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/explore/planners.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

struct GlobalOptions {
  Planners planners{};     ///< strategies that have a name
  std::size_t threads{0};  ///< 0: all cores
  std::uint64_t seed{1};
  bool quiet{false};
  std::string json;  ///< a file, "-" for standard output, or empty

  [[nodiscard]] Executor executor() const { return Executor::with_threads(threads); }
  [[nodiscard]] bool json_to_stdout() const { return json == "-"; }
};

/// Returns the exit status, or an Error for main() to print.
using Action = std::function<Result<int>()>;

// `global` and `action` outlive the parsing. Options are checked while they are parsed; what is wrong with them is
// thrown as CLI::ValidationError.
void add_annotate(CLI::App& program, const GlobalOptions& global, Action& action);
void add_attend(CLI::App& program, const GlobalOptions& global, Action& action);
void add_filter(CLI::App& program, const GlobalOptions& global, Action& action);
void add_fuse(CLI::App& program, const GlobalOptions& global, Action& action);
void add_nbv(CLI::App& program, const GlobalOptions& global, Action& action);
void add_info(CLI::App& program, const GlobalOptions& global, Action& action);
void add_compare(CLI::App& program, const GlobalOptions& global, Action& action);
void add_explore(CLI::App& program, const GlobalOptions& global, Action& action);
void add_reproduce(CLI::App& program, const GlobalOptions& global, Action& action);
void add_robot(CLI::App& program, const GlobalOptions& global, Action& action);
void add_scene(CLI::App& program, const GlobalOptions& global, Action& action);
void add_score(CLI::App& program, const GlobalOptions& global, Action& action);
void add_segment(CLI::App& program, const GlobalOptions& global, Action& action);
void add_show(CLI::App& program, const GlobalOptions& global, Action& action);
void add_sample(CLI::App& program, const GlobalOptions& global, Action& action);
void add_surfels(CLI::App& program, const GlobalOptions& global, Action& action);
void add_update(CLI::App& program, const GlobalOptions& global, Action& action);

}  // namespace saccade::cli
