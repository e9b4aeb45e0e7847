// SPDX-License-Identifier: Apache-2.0
#pragma once
// unknown_argument: what is not known on a command line, and the nearest thing that is.

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace saccade::cli {

/// Returns the innermost command that was named; the program itself where none was.
[[nodiscard]] const CLI::App* chosen_command(const CLI::App& program);

/// Lists the names of the commands below one, without hidden ones. They live as long as the command.
[[nodiscard]] std::vector<std::string_view> visible_commands(const CLI::App& command);

/// Says which argument of a command line that was not parsed is unknown, and suggests the nearest option or command.
/// Empty: each is known.
[[nodiscard]] std::string unknown_argument(const CLI::App& program);

}  // namespace saccade::cli
