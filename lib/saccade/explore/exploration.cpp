// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/exploration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/explore/look.hpp"

namespace saccade {
namespace {

/// A pose that was written to a file and read again is the same.
bool is_same(const Pose& a, const Pose& b) {
  constexpr double kSame{1e-9};
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() <= kSame;
}

bool is_among(const std::vector<Pose>& poses, const Pose& pose) {
  return std::any_of(poses.begin(), poses.end(), [&](const Pose& other) { return is_same(other, pose); });
}

/// The region that is being explored, and the poses that were tried in it without success.
struct OpenRegion {
  std::size_t index{0};
  const Region& region;
  std::vector<Pose> passed_over{};  ///< as the caller said
  std::vector<Pose> unreached{};
};

/// How trying one view after the other came out: the view that the robot now stands at, if any.
struct Choice {
  std::optional<Proposal> view{};
  bool stop{false};  ///< the caller said so
};

struct Loop {
  TsdfMap& map;
  ExplorationCell& cell;
  const Strategy& strategy;
  const ExplorationConfig& config;
  const Executor& executor;
  const ExplorationHooks& hooks;
  const Progress& progress;
  ExplorationResult& result;
  std::vector<ExploredView>& views{result.views};

  [[nodiscard]] std::size_t views_of(std::size_t region) const {
    return static_cast<std::size_t>(std::count_if(
        views.begin(), views.end(), [region](const ExploredView& view) { return view.region == region; }));
  }

  /// Whether the pose was gone to, or tried, for this region.
  [[nodiscard]] bool attempted(const Pose& pose, const OpenRegion& open) const {
    return is_among(open.unreached, pose) || is_among(open.passed_over, pose) ||
           std::any_of(views.begin(), views.end(), [&](const ExploredView& view) {
             return view.region == open.index && is_same(view.T_world_camera, pose);
           });
  }

  [[nodiscard]] bool gains_enough(const Proposal& view, bool by_gain) const {
    return !by_gain || view.gain >= config.min_gain;
  }

  /// Whether the robot could not take a view that would still gain enough, or not a single one.
  [[nodiscard]] bool is_out_of_reach(const Proposals& proposals, const OpenRegion& open) const {
    if (proposals.views.empty()) return proposals.refused.total() > 0;
    return std::any_of(proposals.views.begin(), proposals.views.end(), [&](const Proposal& view) {
      return gains_enough(view, proposals.by_gain) && is_among(open.unreached, view.T_world_camera);
    });
  }

  /// Views that gain enough and were not tried, in their order.
  [[nodiscard]] std::vector<Proposal> worth_trying(const Proposals& proposals, const OpenRegion& open) const {
    std::vector<Proposal> left;
    std::copy_if(proposals.views.begin(), proposals.views.end(), std::back_inserter(left), [&](const Proposal& view) {
      return gains_enough(view, proposals.by_gain) && !attempted(view.T_world_camera, open);
    });
    return left;
  }

  /// The first one and those behind it that are as good.
  [[nodiscard]] std::span<const Proposal> best_of(std::span<const Proposal> left, bool by_gain) const {
    constexpr std::size_t kMost{64};
    std::size_t count = 1;
    while (by_gain && count < std::min(kMost, left.size()) && left[count].gain >= config.good_enough * left[0].gain) {
      ++count;
    }
    return left.first(count);
  }

  /// Of the best view that was not attempted.
  [[nodiscard]] double gain_left(const Proposals& proposals, const OpenRegion& open) const {
    double gain = 0.0;
    for (const Proposal& view : proposals.views) {
      if (view.gain > gain && !attempted(view.T_world_camera, open)) gain = view.gain;
    }
    return gain;
  }

  /// Makes the motion, and looks on the way where that is wanted.
  [[nodiscard]] Result<std::optional<Arrival>> move(const Motion& motion, ExploredView& view) const {
    Status fused;
    double fusing_ms = 0.0;
    double next_s = config.frame_on_way_s;
    const OnWay on_way = [&](const CameraSample& sample) {
      view.path.emplace_back(sample.T_world_camera.translation());
      if (config.frame_on_way_s <= 0.0 || sample.t_s < next_s || !fused.ok() || progress.cancelled()) return;
      next_s += config.frame_on_way_s;
      const Stopwatch stopwatch;
      fused = fuse_frame(map, cell, sample.T_world_camera, executor);
      fusing_ms += stopwatch.elapsed_ms();
      ++view.frames_on_way;
    };
    Stopwatch stopwatch;
    auto arrival = cell.robot.execute(motion, on_way);
    view.motion_ms += stopwatch.lap_ms() - fusing_ms;
    view.fusion_ms += fusing_ms;
    if (!fused.ok()) return fused.error();
    return arrival;
  }

  /// Tries the views in their order, and says in `view` what that took.
  [[nodiscard]] Result<Choice> move_to_best(const Proposals& proposals, OpenRegion& open, ExploredView& view) const {
    std::vector<Proposal> left = worth_trying(proposals, open);
    while (!left.empty()) {
      if (progress.cancelled()) return Choice{std::nullopt, true};
      const std::span<const Proposal> best = best_of(left, proposals.by_gain);
      std::vector<Pose> poses;
      for (const Proposal& proposal : best) poses.push_back(proposal.T_world_camera);
      Stopwatch stopwatch;
      SACCADE_TRY(const PlannedMotion planned, cell.robot.plan(poses));
      view.planning_ms += stopwatch.lap_ms();
      if (!planned.motion) {
        for (std::size_t i = 0; i < poses.size(); ++i) view.refused.add(planned.refusal.value_or(Refusal::declined));
        open.unreached.insert(open.unreached.end(), poses.begin(), poses.end());
        left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(poses.size()));
        continue;
      }
      const auto chosen = left.begin() + static_cast<std::ptrdiff_t>(planned.motion->goal);
      const Consent consent = hooks.before_move ? hooks.before_move(*chosen) : Consent::go;
      if (consent == Consent::stop) return Choice{std::nullopt, true};
      if (consent == Consent::go) {
        SACCADE_TRY(const std::optional<Arrival> arrival, move(*planned.motion, view));
        if (arrival) {
          view.motion_s = arrival->motion_s;
          view.retreat_s = planned.motion->retreat_s;
          return Choice{*chosen};
        }
        view.refused.add(Refusal::declined);
      }
      (consent == Consent::go ? open.unreached : open.passed_over).push_back(chosen->T_world_camera);
      left.erase(chosen);
    }
    return Choice{};
  }

  /// What the strategy proposes now; adds to `view` what that took.
  [[nodiscard]] Result<Proposals> ask(const OpenRegion& open, ExploredView& view) const {
    const Stopwatch stopwatch;
    SACCADE_TRY(Proposals proposals,
                strategy.propose({map.content(), open.region, open.index, views_of(open.index), executor,
                                  [this](std::span<const Pose> poses) { return cell.robot.test(poses, executor); },
                                  [&](const Pose& pose) { return attempted(pose, open); }, config.min_gain}));
    view.candidates = std::max(proposals.candidates, proposals.views.size());
    view.evaluated = proposals.evaluated;
    view.candidates_ms += proposals.candidates_ms;
    view.segmentation_ms += proposals.segmentation_ms;
    view.saliency_ms += proposals.saliency_ms;
    view.reachability_ms += proposals.reachability_ms;
    view.evaluation_ms += stopwatch.elapsed_ms() - proposals.candidates_ms - proposals.segmentation_ms -
                          proposals.saliency_ms - proposals.reachability_ms;
    return proposals;
  }

  /// Asks and tries until the robot stands at a view, or nothing is left that is worth going to.
  [[nodiscard]] Result<Choice> next_best_view(OpenRegion& open, Proposals& proposals, ExploredView& view) const {
    for (;;) {
      SACCADE_TRY(proposals, ask(open, view));
      const bool nothing_to_try = worth_trying(proposals, open).empty();
      SACCADE_TRY(const Choice choice, move_to_best(proposals, open, view));
      if (choice.view || choice.stop || nothing_to_try || proposals.complete) {
        view.refused.add(proposals.refused);
        return choice;
      }
    }
  }

  /// NextBestView, move, look, until the region is done.
  [[nodiscard]] Result<StopReason> explore_region(OpenRegion open) const {
    RegionOutcome& outcome = result.regions[open.index];
    outcome.end = RegionEnd::interrupted;
    while (views.size() < static_cast<std::size_t>(config.max_views)) {
      if (progress.cancelled()) return StopReason::cancelled;
      ExploredView view;
      view.region = open.index;
      Stopwatch stopwatch;
      SACCADE_CHECK(cell.robot.follow(map.content(), executor));
      view.planner_map_ms = stopwatch.lap_ms();
      Proposals proposals;
      SACCADE_TRY(const Choice choice, next_best_view(open, proposals, view));
      outcome.gain_left = gain_left(proposals, open);
      if (choice.stop) return StopReason::cancelled;
      if (!choice.view) {
        outcome.end = is_out_of_reach(proposals, open) ? RegionEnd::out_of_reach : RegionEnd::done;
        if (outcome.end == RegionEnd::done) return StopReason::regions_done;
        outcome.refused = result.refused_at_end = view.refused;
        return StopReason::no_candidate;
      }
      view.gain = choice.view->gain;
      view.T_world_camera = choice.view->T_world_camera;
      view.q = cell.robot.configuration();
      stopwatch.lap_ms();
      SACCADE_TRY(const Look seen, look(map, cell, view.T_world_camera, config, executor));
      view.frames = seen.frames;
      view.tilt = seen.tilt;
      view.motion_s += seen.motion_s;
      view.fusion_ms += stopwatch.lap_ms();
      views.push_back(view);
      progress.report("exploring", views.size(), static_cast<std::size_t>(config.max_views));
      if (hooks.after_view && !hooks.after_view(view, proposals)) return StopReason::cancelled;
    }
    return StopReason::views_used_up;
  }
};

}  // namespace

std::string_view to_string(StopReason reason) {
  switch (reason) {
    case StopReason::regions_done: return "regions_done";
    case StopReason::views_used_up: return "views_used_up";
    case StopReason::no_candidate: return "no_candidate";
    default: return "cancelled";
  }
}

std::string_view to_string(RegionEnd end) {
  switch (end) {
    case RegionEnd::not_begun: return "not_begun";
    case RegionEnd::done: return "done";
    case RegionEnd::out_of_reach: return "out_of_reach";
    default: return "interrupted";
  }
}

Status ExplorationConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "exploration"}; };
  if (std::isnan(min_gain)) return fail("the least gain is not a number");
  if (!(good_enough > 0.0 && good_enough <= 1.0)) return fail("the share that is good enough is within 0 and 1");
  if (max_views < 0) return fail("the number of views must not be negative");
  if (oscillation_frames < 1) return fail("a view needs one frame at least");
  if (!(oscillation_rad >= 0.0 && oscillation_rad < 1.5)) return fail("the oscillation is within 0 and 85 degrees");
  if (!(frame_on_way_s >= 0.0 && std::isfinite(frame_on_way_s))) return fail("frames on the way need a time between");
  return {};
}

Result<ScanResult> scan(TsdfMap& map, ExplorationCell& cell, const std::vector<Pose>& T_world_camera,
                        const ExplorationConfig& config, const Executor& executor, const ExplorationHooks& hooks,
                        const Progress& progress) {
  SACCADE_CHECK(config.validate());
  ScanResult result;
  const auto stopped = [&result] {
    result.complete = false;
    return result;
  };
  std::vector<Pose> way;
  for (const Pose& pose : T_world_camera) {
    way.push_back(pose);
    for (const double end_rad : {-oscillation_rad(config), oscillation_rad(config)}) {
      for (const double tilt_rad : tilts_towards(end_rad)) way.push_back(tilted(pose, tilt_rad));
    }
  }
  SACCADE_CHECK(cell.robot.follow(map.content(), executor));
  SACCADE_TRY(const std::vector<Box> swept, cell.robot.swept_by(way));
  for (const Box& box : swept) SACCADE_CHECK(map.free(box));
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    progress.report("initial scan", i, T_world_camera.size());
    if (progress.cancelled()) return stopped();
    SACCADE_CHECK(cell.robot.follow(map.content(), executor));
    SACCADE_TRY(const PlannedMotion planned, cell.robot.plan(std::span{&T_world_camera[i], 1}));
    if (!planned.motion) {
      result.refused.add(planned.refusal.value_or(Refusal::declined));
      continue;
    }
    const Consent consent = hooks.before_move ? hooks.before_move({T_world_camera[i], 0.0}) : Consent::go;
    if (consent == Consent::stop) return stopped();
    if (consent == Consent::pass_over) continue;
    SACCADE_TRY(const std::optional<Arrival> arrival, cell.robot.execute(*planned.motion));
    if (!arrival) {
      result.refused.add(Refusal::declined);
      continue;
    }
    SACCADE_TRY([[maybe_unused]] const Look seen, look(map, cell, T_world_camera[i], config, executor));
    ++result.views;
  }
  return result;
}

Result<ExplorationResult> explore(TsdfMap& map, ExplorationCell& cell, const std::vector<Region>& regions,
                                  const Strategy& strategy, const ExplorationConfig& config, const Executor& executor,
                                  const ExplorationHooks& hooks, const Progress& progress,
                                  std::vector<ExploredView> so_far) {
  SACCADE_CHECK(config.validate());
  ExplorationResult result;
  result.views = std::move(so_far);
  result.regions.resize(regions.size());
  const Loop loop{map, cell, strategy, config, executor, hooks, progress, result};
  // What an earlier call was done with stays done.
  for (std::size_t i = result.views.empty() ? 0 : result.views.back().region; i < regions.size(); ++i) {
    SACCADE_TRY(const StopReason reason, loop.explore_region({i, regions[i]}));
    if (hooks.after_region) hooks.after_region(i, result.regions[i]);
    if (reason != StopReason::regions_done) result.stopped_because = reason;
    if (reason == StopReason::views_used_up || reason == StopReason::cancelled) break;
  }
  return result;
}

std::size_t count_unknown(const TsdfSnapshot& map, const Region& region) {
  const double e = map.config.voxel_size_m;
  const IndexBox box = voxels_with_center_in(bounds(region), e);
  std::size_t count = 0;
  for (std::int32_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int32_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int32_t x = box.lo.x; x < box.hi.x; ++x) {
        const Eigen::Vector3d p = voxel_center({x, y, z}, e);
        if (!contains(region, p) || (map.config.workspace && !contains(*map.config.workspace, p))) continue;
        count += map.grid.state({x, y, z}) == VoxelState::unknown ? 1 : 0;
      }
    }
  }
  return count;
}

}  // namespace saccade
