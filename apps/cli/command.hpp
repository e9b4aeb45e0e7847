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

/// Adds a subcommand. `global` and `action` outlive the parsing. Options are checked while they are parsed; what is
/// wrong with them is thrown as CLI::ValidationError.
using AddCommand = void(CLI::App& program, const GlobalOptions& global, Action& action);
AddCommand add_annotate, add_attend, add_calibrate, add_cell, add_compare, add_explore, add_filter, add_fuse,
    add_generate, add_info, add_nbv, add_reproduce, add_robot, add_sample, add_scene, add_score, add_segment, add_show,
    add_surfels, add_update;

}  // namespace saccade::cli
