// SPDX-License-Identifier: Apache-2.0
#pragma once
// StandardStrategy and RandomContourStrategy: what AttentionStrategy is compared with, with the same candidates.

#include <mutex>

#include "saccade/explore/strategy.hpp"
#include "saccade/view/contour_views.hpp"
#include "saccade/view/live_contours.hpp"

namespace saccade {

/// All views of all contour points of a map, which is followed from call to call.
class ContourCandidates {
 public:
  /// Expects valid configurations.
  ContourCandidates(const ContourConfig& contours, ContourViewConfig views);

  /// Those that the robot may take, in the order of contour_views, none of them judged.
  [[nodiscard]] Result<Proposals> reachable(const Situation& situation) const;

 private:
  ContourViewConfig views_;
  mutable std::mutex mutex_;
  mutable LiveContours contours_;
};

/// Next best views without attention: of all contour views the one that shows the most unknown space of the region,
/// which is usually the whole workspace. Thesis §3.2.2, "standard".
class StandardStrategy final : public Strategy {
 public:
  /// Expects valid configurations.
  StandardStrategy(const ContourConfig& contours, ContourViewConfig views, const GainConfig& gain)
      : candidates_{contours, std::move(views)}, gain_{gain} {}
  /// The best few; more of them when it is asked again after these were attempted.
  [[nodiscard]] Result<Proposals> propose(const Situation& situation) const override;

 private:
  ContourCandidates candidates_;
  GainConfig gain_;
};

/// Contour views in random order, whatever they gain.
class RandomContourStrategy final : public Strategy {
 public:
  /// Expects valid configurations.
  RandomContourStrategy(const ContourConfig& contours, ContourViewConfig views, GainFunction gain, std::uint64_t seed)
      : candidates_{contours, std::move(views)}, gain_{std::move(gain)}, seed_{seed} {}
  /// A few, their gains only told.
  [[nodiscard]] Result<Proposals> propose(const Situation& situation) const override;

 private:
  ContourCandidates candidates_;
  GainFunction gain_;
  std::uint64_t seed_;
};

}  // namespace saccade
