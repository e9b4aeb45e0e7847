// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/refusal.hpp"

namespace saccade {

std::string in_words(const RefusalCounts& refused) {
  std::string words;
  for (const Refusal reason : kRefusalTexts.values) {
    if (refused.of(reason) == 0) continue;
    words.append(words.empty() ? "" : ", ").append(std::to_string(refused.of(reason)) + " ");
    words.append(kRefusalTexts.of(reason));
  }
  return words;
}

}  // namespace saccade
