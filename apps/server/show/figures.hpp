// SPDX-License-Identifier: Apache-2.0
#pragma once
// Numbers as text, for facts.

#include <array>
#include <cstdio>
#include <string>

namespace saccade::server {

[[nodiscard]] inline std::string decimals(double value, int places) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", places, value);
  return text.data();
}
[[nodiscard]] inline std::string millimetres(double value_m) { return decimals(1e3 * value_m, 1) + " mm"; }
[[nodiscard]] inline std::string percent(double share) { return decimals(100.0 * share, 1) + " %"; }
/// Returns a number such as 12 345 678, with narrow no-break spaces.
[[nodiscard]] inline std::string grouped(std::size_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += "\u202f";
    text += digits[i];
  }
  return text;
}

}  // namespace saccade::server
