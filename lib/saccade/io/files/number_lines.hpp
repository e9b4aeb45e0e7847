// SPDX-License-Identifier: Apache-2.0
#pragma once
// number_lines: text as lines of numbers, as pose lists and hand trajectories have them.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {

/// Numbers of one line, separated by blanks or commas.
struct NumberLine {
  std::size_t line{0};  ///< from 1
  std::vector<double> values;
};

/// The rest of the lines that are neither blank nor comments ('#' to the end of the line).
/// corrupt_data with the line for a word that is no number.
[[nodiscard]] Result<std::vector<NumberLine>> number_lines(LineScanner& lines);
[[nodiscard]] Result<std::vector<NumberLine>> number_lines(std::string_view text);

/// corrupt_data at a line.
[[nodiscard]] Error bad_line(std::size_t line, std::string what);

}  // namespace saccade
