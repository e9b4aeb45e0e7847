// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/refusal.hpp"

namespace saccade {

std::string in_words(const RefusalCounts& refused) {
  constexpr std::array<const char*, kRefusals.size()> kWords{"out of reach",       "beyond a joint's limits",
                                                             "in collision there", "in collision at the start",
                                                             "without a path",     "declined by the robot"};
  std::string words;
  for (const Refusal reason : kRefusals) {
    if (refused.of(reason) == 0) continue;
    words += (words.empty() ? "" : ", ") + std::to_string(refused.of(reason)) + " ";
    words += kWords[static_cast<std::size_t>(reason)];
  }
  return words;
}

}  // namespace saccade
