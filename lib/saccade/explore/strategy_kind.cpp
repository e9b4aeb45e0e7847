// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/strategy_kind.hpp"

namespace saccade {

std::string_view to_string(StrategyKind kind) {
  switch (kind) {
    case StrategyKind::attention: return "attention";
    case StrategyKind::standard: return "standard";
    case StrategyKind::sphere: return "sphere";
    case StrategyKind::random: return "random";
    case StrategyKind::random_contours: return "random-contours";
    default: return "oracle";
  }
}

std::string strategy_names() {
  std::string names;
  for (const StrategyKind kind : kStrategies) names += (names.empty() ? "" : ", ") + std::string{to_string(kind)};
  return names;
}

Result<StrategyKind> strategy_kind(std::string_view name) {
  for (const StrategyKind kind : kStrategies) {
    if (to_string(kind) == name) return kind;
  }
  return Error{Errc::invalid_argument, "there is no strategy \"" + std::string{name} + "\"; known: " + strategy_names(),
               ""};
}

}  // namespace saccade
