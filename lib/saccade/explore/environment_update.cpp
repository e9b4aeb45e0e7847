// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/environment_update.hpp"

#include "saccade/core/clock.hpp"

namespace saccade {

std::string_view to_string(FuseWhen when) { return when == FuseWhen::viewpoints ? "viewpoints" : "motion"; }

std::vector<Region> bounds_of(std::span<const RegionOfInterest> regions) {
  std::vector<Region> bounds;
  bounds.reserve(regions.size());
  for (const RegionOfInterest& region : regions) bounds.push_back(region.bounds);
  return bounds;
}

UnknownOfRegions count_unknown(const TsdfSnapshot& map, std::span<const RegionOfInterest> regions) {
  UnknownOfRegions counts;
  counts.reserve(regions.size());
  for (const RegionOfInterest& region : regions) counts.push_back(count_unknown(map, region.bounds));
  return counts;
}

Status forget_around(TsdfMap& map, std::span<const RegionOfInterest> regions) {
  for (const RegionOfInterest& region : regions) SACCADE_CHECK(map.forget(region.bounds));
  return {};
}

Result<Return> return_to_stand_by(const TsdfMap& map, Robot& robot, const Executor& executor) {
  SACCADE_CHECK(robot.follow(map.content(), executor));
  SACCADE_TRY(const PlannedMotion planned, robot.plan_to_stand_by());
  if (!planned.motion) return Return{false, planned.refusal, 0.0};
  SACCADE_TRY(const std::optional<Arrival> arrival, robot.execute(*planned.motion));
  if (!arrival) return Return{false, Refusal::declined, 0.0};
  return Return{true, std::nullopt, arrival->motion_s};
}

Result<UpdateResult> update_environment(TsdfMap& map, ExplorationCell& cell, std::span<const RegionOfInterest> regions,
                                        const Strategy& strategy, const ExplorationConfig& config,
                                        const Executor& executor, const ExplorationHooks& hooks,
                                        const Progress& progress) {
  UpdateResult result;
  const Stopwatch stopwatch;
  SACCADE_CHECK(forget_around(map, regions));
  result.forgetting_ms = stopwatch.elapsed_ms();
  result.unknown_after_task = count_unknown(map.content(), regions);

  ExplorationHooks counting = hooks;
  counting.after_view = [&](const ExploredView& view, const Proposals& proposals) {
    result.unknown_after_view.push_back(count_unknown(map.content(), regions));
    return !hooks.after_view || hooks.after_view(view, proposals);
  };
  SACCADE_TRY(result.exploration,
              explore(map, cell, bounds_of(regions), strategy, config, executor, counting, progress));
  if (result.exploration.stopped_because == StopReason::cancelled) return result;
  SACCADE_TRY(result.back, return_to_stand_by(map, cell.robot, executor));
  return result;
}

}  // namespace saccade
