// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/view_planner.hpp"

#include <cmath>

namespace saccade {
namespace {

/// Returns a pointer to a part with another owner.
template <class T>
std::shared_ptr<T> borrowed(T& part) {
  return {std::shared_ptr<T>{}, &part};
}

}  // namespace

Status ViewPlannerConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "view planner"}; };
  if (!(min_gain >= 0.0 && std::isfinite(min_gain))) return fail("the least gain must be a number of at least 0");
  if (!(rival_share > 0.0 && rival_share <= 1.0)) return fail("the share that makes a rival lies above 0, at most 1");
  if (tries == 0) return fail("one view at least must be tried at a time");
  return {};
}

ViewPlanner::ViewPlanner(AttentionSource& attention, ViewGenerator& generator, Gain& gain,
                         const ViewPlannerConfig& config)
    : parts_{borrowed(attention), borrowed(generator), borrowed(gain), config} {}

ViewPlanner ViewPlanner::with(AttentionSource& attention) const {
  PlannerParts parts = parts_;
  parts.attention = borrowed(attention);
  return ViewPlanner{std::move(parts)};
}

Result<Ranking> ViewPlanner::rank(const PlanningScene& scene) {
  const auto& [attention, generator, gain, config] = parts_;
  SACCADE_CHECK(config.validate());
  Ranking ranking{config.min_gain};
  std::shared_ptr<const ExpectedSurface> expected;  // attention, views and gain share it
  PlanningContext whole = scene.context();
  whole.expected = &expected;
  SACCADE_TRY(const std::vector<RegionOfInterest> regions,  // 3–6
              whole.measure(Phase::saliency, [&] { return parts_.attention->regions(whole); }));
  for (const RegionOfInterest& region : regions) {  // 7
    if (region.index < scene.first_region) continue;
    if (!ranking.competes(region, config.rival_share)) break;
    PlanningContext context = scene.context(region.index);
    context.expected = &expected;
    ViewCandidates found;
    RankedViews ranked;
    RefusalCounts refused;
    if (context.views_taken < config.views_per_region) {
      SACCADE_TRY(found, context.measure(Phase::candidates, [&] {  // 1, 2, 8, 9
        return parts_.generator->views(context, region);
      }));
      if (config.asks_robot_first) refused = scene.remove_unreachable(found.T_world_camera);
      SACCADE_TRY(ranked, context.measure(Phase::gain, [&] {  // 10, 11
        return parts_.gain->best(context, region, found.T_world_camera, parts_.config.tries);
      }));
    }
    ranking.add(region, found, refused, std::move(ranked), scene);  // 12–16
  }
  ranking.end(scene);
  return ranking;  // 18
}

}  // namespace saccade
