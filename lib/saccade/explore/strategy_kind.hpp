// SPDX-License-Identifier: Apache-2.0
#pragma once
// StrategyKind: the strategies that have a name.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"

namespace saccade {

enum class StrategyKind : std::uint8_t {
  attention,        ///< AttentionStrategy
  standard,         ///< StandardStrategy
  sphere,           ///< SphereStrategy
  random,           ///< RandomStrategy, views of the sphere
  random_contours,  ///< RandomContourStrategy
  oracle,           ///< OracleStrategy; for scenes whose truth is known
};
inline constexpr std::array kStrategies{StrategyKind::attention, StrategyKind::standard,        StrategyKind::sphere,
                                        StrategyKind::random,    StrategyKind::random_contours, StrategyKind::oracle};

[[nodiscard]] std::string_view to_string(StrategyKind kind);
/// invalid_argument, with the known names, for any other.
[[nodiscard]] Result<StrategyKind> strategy_kind(std::string_view name);
/// "attention, standard, …"
[[nodiscard]] std::string strategy_names();

/// IncTh of Algorithm 1 and ScoreTH of Algorithm 4 as they are unless told otherwise, in rays of a virtual sensor 160
/// pixels wide: attention counts unknown space around one segment, the others that of the whole workspace.
[[nodiscard]] constexpr double min_gain_of(StrategyKind kind) { return kind == StrategyKind::attention ? 50.0 : 200.0; }

/// Whether it looks from the view sphere of one region after the other; the others look at contours, wherever in the
/// workspace they are.
[[nodiscard]] constexpr bool looks_at_regions(StrategyKind kind) {
  return kind == StrategyKind::sphere || kind == StrategyKind::random;
}

}  // namespace saccade
