// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExitStatus, exit_status_of(Errc) and print_error: how the program ends, and its one line on standard error.

#include <string>
#include <string_view>

#include "saccade/core/result.hpp"

namespace saccade::cli {

/// Exit status of the program. After an interruption it is 128 + the signal's number: 130 for Ctrl-C, 143 for SIGTERM.
enum class ExitStatus : int {
  done = 0,
  bug = 1,
  usage = 2,        ///< the command line itself is wrong
  bad_input = 3,    ///< a file or folder cannot be read or written as asked
  unavailable = 4,  ///< this build or machine lacks what was asked for
  no_result = 5,    ///< finished, but there is nothing to show for it
};

/// Maps an error of the library to an exit status. Wrong options are found before any work and are `usage`; an invalid
/// argument that the library reports later came from a file.
[[nodiscard]] ExitStatus exit_status_of(Errc code);

/// Returns the text with blanks for control characters, which names and files may hold.
[[nodiscard]] std::string without_controls(std::string_view text);

/// "saccade COMMAND: where: what" as one line on standard error.
void print_error(std::string_view command, std::string_view text);

}  // namespace saccade::cli
