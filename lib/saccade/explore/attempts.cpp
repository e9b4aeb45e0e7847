// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/attempts.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr double kSame{1e-9};

bool is_same(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() <= kSame; }

/// Tells whether two poses differ by a roll at most: one place, one optical axis.
bool is_roll_of(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).rightCols<2>().cwiseAbs().maxCoeff() <= kSame;
}

/// Tells whether all candidates that the robot can take were evaluated, as when gains choose. Chance evaluates a few.
bool was_chosen_by_gain(const ViewRecord& view) { return view.evaluated + view.refused.total() >= view.candidates; }

}  // namespace

Attempts::Attempts(std::span<const ViewRecord> views) {
  for (const ViewRecord& view : views) add_view(view);
}

void Attempts::add_view(const ViewRecord& view) {
  const bool is_checked = view.gain_predicted > 0.0 && std::isfinite(view.gain_observed);
  // Planners that make no promises leave every view unchecked, and may want other rolls.
  const bool all_rolls = view.gain_predicted > 0.0 && !is_checked && !checked_.empty() && was_chosen_by_gain(view);
  attempts_.push_back({view.region, view.T_world_camera, Attempt::Outcome::taken, all_rolls});
  if (is_checked) {
    checked_.push_back({view.T_world_camera, view.gain_observed / view.gain_predicted});
  }
  refusals_.clear();
}

void Attempts::add_refused(std::size_t region, std::span<const RankedView> views, Refusal refusal) {
  for (const RankedView& view : views) attempts_.push_back({region, view.T_world_camera, Attempt::Outcome::refused});
  auto found = std::find_if(refusals_.begin(), refusals_.end(), [&](const auto& of) { return of.first == region; });
  if (found == refusals_.end()) found = refusals_.insert(refusals_.end(), {region, {}});
  found->second.add(refusal, views.size());
}

void Attempts::add_skipped(std::size_t region, const Pose& T_world_camera) {
  attempts_.push_back({region, T_world_camera, Attempt::Outcome::skipped});
}

bool Attempts::contains(std::size_t region, const Pose& T_world_camera) const {
  return std::any_of(attempts_.begin(), attempts_.end(), [&](const Attempt& attempt) {
    return attempt.region == region && (is_same(attempt.T_world_camera, T_world_camera) ||
                                        (attempt.all_rolls && is_roll_of(attempt.T_world_camera, T_world_camera)));
  });
}

bool Attempts::was_refused(std::size_t region, const Pose& T_world_camera) const {
  return std::any_of(attempts_.begin(), attempts_.end(), [&](const Attempt& attempt) {
    return attempt.region == region && attempt.outcome == Attempt::Outcome::refused &&
           is_same(attempt.T_world_camera, T_world_camera);
  });
}

std::size_t Attempts::views_of(std::size_t region) const {
  return static_cast<std::size_t>(std::count_if(attempts_.begin(), attempts_.end(), [&](const Attempt& attempt) {
    return attempt.region == region && attempt.outcome == Attempt::Outcome::taken;
  }));
}

RefusalCounts Attempts::refusals_of(std::size_t region) const {
  for (const auto& [of, counts] : refusals_) {
    if (of == region) return counts;
  }
  return {};
}

}  // namespace saccade
