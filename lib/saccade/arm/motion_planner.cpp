// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/motion_planner.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "saccade/arm/internal/ompl_search.hpp"
#include "saccade/arm/internal/shortcut.hpp"
#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

/// Distance of a start beyond a limit that counts as rounding. rad, or m.
constexpr double kStartSlack{1e-6};

PlanOutcome refusal(Refusal reason, std::string why) {
  PlanOutcome outcome;
  outcome.refusal = reason;
  outcome.why = std::move(why);
  return outcome;
}

}  // namespace

Status MotionPlannerConfig::validate() const {
  const auto fail = [](std::string what) { return Error{Errc::invalid_argument, std::move(what), "motion planning"}; };
  const std::vector<std::string> names = planner_names();
  if (std::find(names.begin(), names.end(), planner) == names.end()) {
    return fail("there is no planner \"" + planner + "\"; known: " + joined(names));
  }
  if (max_motions < 1) return fail("a search needs one motion at least");
  if (!(budget_s > 0.0)) return fail("the time of a search must be positive");
  if (shortcut_tries < 0) return fail("the number of shortcuts must not be negative");
  return {};
}

std::vector<std::string> planner_names() { return ompl_planner_names(); }

Result<MotionPlanner> MotionPlanner::create(const ArmCollision& collision, const MotionPlannerConfig& config) {
  SACCADE_CHECK(config.validate());
  return MotionPlanner{collision, config};
}

/// Refuses unusable starts and goals; `usable` receives the usable goals, nearest first.
std::optional<PlanOutcome> MotionPlanner::refuse(const Configuration& start, std::span<const Configuration> goals,
                                                 std::vector<std::size_t>& usable, const ObstacleMap& obstacles) const {
  const ArmModel& arm = collision_.arm();
  if (!arm.within_limits(start, kStartSlack)) {
    return refusal(Refusal::outside_limits, "a joint of the start is outside its limits");
  }
  if (const auto contact = collision_.contact(start, obstacles)) {
    return refusal(Refusal::start_in_collision, "at the start " + describe(arm, *contact));
  }
  std::optional<Contact> touched;
  bool any_within{false};
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (!arm.within_limits(goals[i])) continue;
    any_within = true;
    const auto contact = collision_.contact(goals[i], obstacles);
    if (contact) touched = contact;
    if (!contact) usable.push_back(i);
  }
  if (!any_within) return refusal(Refusal::outside_limits, "every goal has a joint outside its limits");
  if (usable.empty()) return refusal(Refusal::goal_in_collision, "at the last of the goals " + describe(arm, *touched));
  std::vector<double> time_s;
  for (const Configuration& goal : goals) time_s.push_back(rest_to_rest_s(arm, start, goal));
  std::stable_sort(usable.begin(), usable.end(), [&](std::size_t a, std::size_t b) { return time_s[a] < time_s[b]; });
  return std::nullopt;
}

Result<PlanOutcome> MotionPlanner::plan_straight(const Configuration& start, std::span<const Configuration> goals,
                                                 const ObstacleMap& obstacles) const {
  const ArmModel& arm = collision_.arm();
  const auto fits = [&arm](const Configuration& q) { return q.size() == arm.dof() && q.allFinite(); };
  if (goals.empty() || !fits(start) || !std::all_of(goals.begin(), goals.end(), fits)) {
    return Error{Errc::invalid_argument,
                 "start and goals must be " + std::to_string(arm.dof()) + " numbers, and one goal is needed at least",
                 "motion planning"};
  }
  const Stopwatch stopwatch;
  std::vector<std::size_t> usable;
  if (auto refused = refuse(start, goals, usable, obstacles)) return *refused;
  PlanOutcome outcome = refusal(Refusal::no_path, "no straight motion to any goal is free");
  for (const std::size_t i : usable) {
    if (outcome.motions == config_.max_motions) break;
    ++outcome.motions;
    if (collision_.motion_contact(start, goals[i], obstacles)) continue;
    JointPath path{start, goals[i]};
    Trajectory trajectory = parametrise(arm, path);
    outcome = {MotionPlan{i, std::move(path), std::move(trajectory)}, std::nullopt, "", outcome.motions};
    break;
  }
  outcome.search_ms = stopwatch.elapsed_ms();
  return outcome;
}

Result<PlanOutcome> MotionPlanner::plan(const Configuration& start, std::span<const Configuration> goals,
                                        const ObstacleMap& obstacles) const {
  Stopwatch stopwatch;
  SACCADE_TRY(PlanOutcome outcome, plan_straight(start, goals, obstacles));
  if (outcome.refusal != Refusal::no_path || outcome.motions >= config_.max_motions) return outcome;

  const ArmModel& arm = collision_.arm();
  const auto motion_is_free = [&](const Configuration& from, const Configuration& to) {
    return !collision_.motion_contact(from, to, obstacles);
  };
  const auto is_free = [&](const Configuration& q) { return !collision_.contact(q, obstacles); };
  std::vector<Configuration> wanted;
  for (const Configuration& goal : goals) {
    if (arm.within_limits(goal) && is_free(goal)) wanted.push_back(goal);
  }
  SearchResult found = search_with_ompl(config_.planner, {arm, is_free, motion_is_free}, start, wanted,
                                        {config_.max_motions - outcome.motions, config_.budget_s, config_.seed});
  outcome.motions += found.motions;
  outcome.search_ms = stopwatch.lap_ms();
  if (!found.path) {
    outcome.why = found.out_of_time ? "no path was found within the time of a search"
                                    : "no path was found among " + std::to_string(outcome.motions) + " motions";
    return outcome;
  }
  JointPath path = shortcut(arm, std::move(*found.path), motion_is_free, config_.shortcut_tries, config_.seed);
  Trajectory trajectory =
      parametrise(arm, path, [&](const Trajectory::Piece& piece) { return piece_is_free(piece, obstacles); });
  const auto goal = std::find(goals.begin(), goals.end(), path.back());
  outcome.plan =
      MotionPlan{static_cast<std::size_t>(std::distance(goals.begin(), goal)), std::move(path), std::move(trajectory)};
  outcome.refusal.reset();
  outcome.why.clear();
  outcome.shortcut_ms = stopwatch.lap_ms();
  return outcome;
}

bool MotionPlanner::piece_is_free(const Trajectory::Piece& piece, const ObstacleMap& obstacles) const {
  // Speeds change linearly, so each joint is fastest at one of the ends of the piece, or of a part of it.
  const double step_m = collision_.config().max_step_m;
  const Configuration still = Configuration::Zero(piece.q.size());
  const auto fastest = [&](double from_s, double to_s) -> Configuration {
    return (piece.speed + from_s * piece.acceleration)
        .cwiseAbs()
        .cwiseMax((piece.speed + to_s * piece.acceleration).cwiseAbs());
  };
  for (double t_s = 0.0;;) {
    const Configuration q = piece.q + t_s * piece.speed + 0.5 * t_s * t_s * piece.acceleration;
    if (!collision_.arm().within_limits(q, kStartSlack) || collision_.contact(q, obstacles)) return false;
    if (t_s >= piece.duration_s) return true;
    const double travel_m_per_s = collision_.travel_bound_m(still, fastest(t_s, piece.duration_s));
    t_s = std::min(piece.duration_s, t_s + (travel_m_per_s > 0.0 ? step_m / travel_m_per_s : piece.duration_s));
  }
}

bool MotionPlanner::is_free(const Trajectory& trajectory, const ObstacleMap& obstacles) const {
  return std::all_of(trajectory.pieces().begin(), trajectory.pieces().end(),
                     [&](const Trajectory::Piece& piece) { return piece_is_free(piece, obstacles); });
}

}  // namespace saccade
