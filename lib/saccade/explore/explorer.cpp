// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/explorer.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr double kLeastOnWay_s{0.01};  // no camera is faster, and each planned frame costs a look at the map

std::vector<Pose> poses_of(std::span<const RankedView> views) {
  std::vector<Pose> poses;
  for (const RankedView& view : views) poses.push_back(view.T_world_camera);
  return poses;
}

RegionResult& result_of(RunRecord& run, std::size_t region) {
  if (run.regions.size() <= region) run.regions.resize(region + 1);
  return run.regions[region];
}

/// Records the results of regions that a ranking left.
void note_left(RunRecord& run, const Ranking& ranking) {
  for (const auto& [region, result] : ranking.left()) {
    result_of(run, region) = result;
    if (result.status == RegionStatus::out_of_reach) run.refused_at_end = result.refused;
  }
}

StopReason reason_without_views(const RunRecord& run) {
  const bool out_of_reach = std::any_of(run.regions.begin(), run.regions.end(), [](const RegionResult& region) {
    return region.status == RegionStatus::out_of_reach;
  });
  return out_of_reach ? StopReason::no_candidate : StopReason::regions_done;
}

}  // namespace

Status ExplorerConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "exploration"}; };
  if (!(good_enough > 0.0 && good_enough <= 1.0)) return fail("the share that is good enough is within 0 and 1");
  if (max_views < 0) return fail("the number of views must not be negative");
  if (oscillation_frames < 1) return fail("a view needs one frame at least");
  if (lookahead < 1) return fail("one view at least is looked ahead");
  if (!(oscillation_rad >= 0.0 && oscillation_rad < 1.5)) return fail("the oscillation is within 0 and 85 degrees");
  SACCADE_CHECK(icp.validate());
  if (!(frame_on_way_s == 0.0 || (frame_on_way_s >= kLeastOnWay_s && std::isfinite(frame_on_way_s))))
    return fail("frames on the way need 10 ms between them at least");
  return {};
}

Result<RunRecord> Explorer::explore(ViewPlanner& planner, RunRecord run) {
  SACCADE_CHECK(config_.validate());
  attempts_ = Attempts{run.views};
  region_ = run.views.empty() ? 0 : run.views.back().region;  // regions finished by an earlier call stay finished
  std::optional<StopReason> reason;
  while (!(reason = stopped(run))) {
    ViewRecord view;
    const auto follow = [&] { return parts_.robot.follow(parts_.map.content(), parts_.executor); };
    SACCADE_CHECK(view.times.measure(Phase::obstacles, follow));
    SACCADE_TRY(const Outcome outcome, go_to_next(planner, run, view));  // 5–12
    if (outcome == Outcome::cancelled) reason = StopReason::cancelled;
    if (outcome == Outcome::nowhere_to_go) reason = reason_without_views(run);
    if (reason) break;
    SACCADE_CHECK(look(view));  // 13
    check_promise(view);
    if (parts_.recorder != nullptr) SACCADE_CHECK(parts_.recorder->viewed(view, parts_.map.content(), frames_));
    attempts_.add_view(view);
    run.views.push_back(std::move(view));
    if (parts_.progress != nullptr) {
      parts_.progress->report("exploring", run.views.size(), static_cast<std::size_t>(config_.max_views));
    }
  }
  run.stopped_because = *reason;
  const bool ended_early = *reason == StopReason::views_used_up || *reason == StopReason::cancelled;
  if (ended_early) result_of(run, region_).status = RegionStatus::interrupted;
  if (parts_.recorder != nullptr) SACCADE_CHECK(parts_.recorder->ended(run));
  return run;
}

Result<RunRecord> Explorer::update(std::span<const RegionOfInterest> changed, const ViewPlanner& planner) {
  SACCADE_CHECK(forget(changed));  // 1–3
  RegionsInTurn in_turn{changed};
  ViewPlanner of_regions = planner.with(in_turn);
  SACCADE_TRY(RunRecord run, explore(of_regions));  // 4–16
  if (run.stopped_because == StopReason::cancelled) return run;
  SACCADE_TRY([[maybe_unused]] const StandByResult back, return_to_stand_by());  // 17
  return run;
}

Status Explorer::forget(std::span<const RegionOfInterest> regions) {
  for (const RegionOfInterest& region : regions) SACCADE_CHECK(parts_.map.forget(region.bounds));
  return {};
}

Result<StandByResult> Explorer::return_to_stand_by() {
  SACCADE_CHECK(parts_.robot.follow(parts_.map.content(), parts_.executor));
  SACCADE_TRY(const PlannedMotion planned, parts_.robot.plan_to_stand_by());
  if (!planned.motion) return StandByResult{false, planned.refusal, 0.0};
  SACCADE_TRY(const std::optional<Arrival> arrival, parts_.robot.execute(*planned.motion));
  if (!arrival) return StandByResult{false, Refusal::declined, 0.0};
  return StandByResult{!arrival->stopped, std::nullopt, arrival->motion_s};
}

PlanningScene Explorer::scene(PhaseTimes& times) const {
  const PinholeCamera sensor = widened_vertically(parts_.camera.intrinsics(), config_.oscillation_rad);
  return {parts_.map.content(), parts_.executor, &times, &parts_.robot, &attempts_, region_, sensor, parts_.device};
}

std::optional<StopReason> Explorer::stopped(const RunRecord& run) const {
  const StopRule rule{static_cast<std::size_t>(config_.max_views)};
  if (const auto reason = rule.reached(run)) return reason;
  if (parts_.stopping != nullptr) {
    if (const auto reason = parts_.stopping->reached(run)) return reason;
  }
  return cancelled() ? std::optional{StopReason::cancelled} : std::nullopt;
}

Result<Explorer::Outcome> Explorer::go_to_next(ViewPlanner& planner, RunRecord& run, ViewRecord& view) {
  for (;;) {
    SACCADE_TRY(Ranking ranking, planner.rank(scene(view.times)));  // 5, 14
    note_left(run, ranking);
    region_ = ranking.region();
    if (ranking.empty()) return Outcome::nowhere_to_go;
    SACCADE_TRY(const Outcome outcome, go_to_best(ranking, view));  // 6–12
    result_of(run, region_).gain_left = ranking.gain_left(scene(view.times));
    if (outcome == Outcome::arrived || outcome == Outcome::cancelled) return outcome;
  }
}

/// Runs lines 6–12: offers equally good views to the robot together, then the next best.
Result<Explorer::Outcome> Explorer::go_to_best(Ranking& ranking, ViewRecord& view) {
  view.candidates = ranking.candidates();
  view.evaluated = ranking.evaluated();
  SACCADE_CHECK(view.times.measure(
      Phase::planning, [&] { return look_ahead(config_.foresight(), parts_.robot, parts_.executor, ranking); }));
  while (!ranking.empty()) {
    if (cancelled()) return Outcome::cancelled;
    const std::span<const RankedView> best = ranking.as_good_as_best(config_.good_enough);  // 6–9
    SACCADE_TRY(const PlannedMotion planned,                                                // 10
                view.times.measure(Phase::planning, [&] { return parts_.robot.plan(poses_of(best)); }));
    if (!planned.motion) {  // 11
      attempts_.add_refused(ranking.region(), best, planned.refusal.value_or(Refusal::declined));
      ranking.drop_first(best.size());
      continue;
    }
    SACCADE_EXPECTS(planned.motion->goal < best.size());
    const RankedView chosen = best[planned.motion->goal];
    const Approval approval = parts_.approve ? parts_.approve(chosen) : Approval::go;
    if (approval == Approval::stop) return Outcome::cancelled;
    if (approval == Approval::go) {
      promise_ = ranking.promise(chosen.T_world_camera);
      SACCADE_TRY(const std::optional<Arrival> arrival, move(*planned.motion, view));  // 12
      if (arrival && arrival->stopped) {                                               // a new obstacle is in the way
        attempts_.add_refused(ranking.region(), std::span{&chosen, 1}, Refusal::no_path);
        return cancelled() ? Outcome::cancelled : Outcome::stopped_on_way;
      }
      if (arrival) {
        view.region = ranking.region();
        view.T_world_camera = chosen.T_world_camera;
        view.q = parts_.robot.configuration();
        view.gain_predicted = chosen.gain;
        view.motion_s = arrival->motion_s;
        view.retreat_s = planned.motion->retreat_s;
        view.refused = attempts_.refusals_of(view.region);
        view.refused.add(ranking.refused());
        view.attention = ranking.attention();
        view.choice = ranking.choice();
        return Outcome::arrived;
      }
      attempts_.add_refused(ranking.region(), std::span{&chosen, 1}, Refusal::declined);
    } else {
      attempts_.add_skipped(ranking.region(), chosen.T_world_camera);
    }
    ranking.drop(planned.motion->goal);
  }
  return Outcome::nowhere_to_go;
}

}  // namespace saccade
