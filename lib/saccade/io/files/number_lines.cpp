// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/text_scan.hpp"

#include <utility>

namespace saccade {

Error bad_line(std::size_t line, std::string what) {
  return {Errc::corrupt_data, std::move(what), "line " + std::to_string(line)};
}

Result<std::vector<NumberLine>> number_lines(LineScanner& lines) {
  std::vector<NumberLine> result;
  while (const auto line = lines.next()) {
    NumberLine numbers{lines.line(), {}};
    TokenScanner tokens{*line};
    while (const auto token = tokens.next()) {
      if (token->front() == '#') break;
      const auto value = parse_number(*token);
      if (!value) return bad_line(lines.line(), in_quotes(*token) + " is not a number");
      numbers.values.push_back(*value);
    }
    if (!numbers.values.empty()) result.push_back(std::move(numbers));
  }
  return result;
}

Result<std::vector<NumberLine>> number_lines(std::string_view text) {
  LineScanner lines{text};
  return number_lines(lines);
}

}  // namespace saccade
