// SPDX-License-Identifier: Apache-2.0
#include "exit_status.hpp"

#include <algorithm>
#include <iostream>

namespace saccade::cli {

ExitStatus exit_status_of(Errc code) {
  switch (code) {
    case Errc::unavailable: return ExitStatus::unavailable;
    case Errc::invalid_argument:
    case Errc::not_found:
    case Errc::io_failure:
    case Errc::corrupt_data:
    case Errc::unsupported:
    case Errc::size_mismatch:
    case Errc::cancelled: return ExitStatus::bad_input;
  }
  return ExitStatus::bug;
}

std::string without_controls(std::string_view text) {
  std::string line{text};
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return line;
}

void print_error(std::string_view command, std::string_view text) {
  std::string line{"saccade"};
  if (!command.empty()) line.append(" ").append(command);
  line += ": ";
  std::cerr << line + without_controls(text) + '\n' << std::flush;
}

}  // namespace saccade::cli
