// SPDX-License-Identifier: Apache-2.0
#include "shell_quoted.hpp"

#include <string_view>

namespace saccade::cli {

std::string shell_quoted(const std::string& word) {
  constexpr std::string_view kPlain{"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._:,/=+-"};
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted{"'"};
  for (const char c : word) quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return quoted + '\'';
}

}  // namespace saccade::cli
