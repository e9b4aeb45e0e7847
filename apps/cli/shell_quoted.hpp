// SPDX-License-Identifier: Apache-2.0
#pragma once
// shell_quoted: a word of a command that is shown or written to a script.

#include <string>

namespace saccade::cli {

/// Returns the word as a shell reads it back: in quotes where it holds blanks or other characters of the shell's own.
[[nodiscard]] std::string shell_quoted(const std::string& word);

}  // namespace saccade::cli
