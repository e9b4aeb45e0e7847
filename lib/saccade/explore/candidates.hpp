// SPDX-License-Identifier: Apache-2.0
#pragma once
// keep_reachable, judge, keep_best, order_by_gain: the steps that strategies have in common.

#include "saccade/explore/strategy.hpp"

namespace saccade {

/// The poses that the robot may take, in their order, none of them judged, as views of `proposals`, behind those that
/// are there; counts the others and the time.
void keep_reachable(std::span<const Pose> T_world_camera, const Situation& situation, Proposals& proposals);

/// Fills in the gains in a region of views [first, end). size_mismatch when the function returns another number of
/// values than it got poses; its own errors.
[[nodiscard]] Status judge(Proposals& proposals, std::size_t first, std::size_t end, const Region& region,
                           const Situation& situation, const GainFunction& gain);

/// Leaves, of views that are not judged, the best that were not attempted, at most `count`, by decreasing gain, and
/// behind them all that were attempted, judged; `complete` when no other was left out. Counts all as evaluated. Errors
/// of best_views.
[[nodiscard]] Status keep_best(Proposals& proposals, std::size_t count, const Region& region,
                               const Situation& situation, const GainConfig& gain);

/// The largest gain first, ties in their order.
void order_by_gain(std::span<Proposal> views);

/// In an order that depends on the seed alone, on every platform.
void shuffle(std::span<Proposal> views, std::uint64_t seed);

}  // namespace saccade
