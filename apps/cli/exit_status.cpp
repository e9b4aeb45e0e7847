// SPDX-License-Identifier: Apache-2.0
#include "exit_status.hpp"

#include <iostream>
#include <string>

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

void print_error(std::string_view command, std::string_view text) {
  std::string line{"saccade"};
  if (!command.empty()) line.append(" ").append(command);
  line += ": ";
  for (const char c : text) line += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  std::cerr << line + '\n' << std::flush;
}

}  // namespace saccade::cli
