// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/exploration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

/// PerformRobotOscillation: frames from −oscillation to +oscillation about the camera's x axis, each one fused.
/// Returns their number.
Result<std::size_t> look(TsdfMap& map, ExplorationCell& cell, const Pose& T_world_view, const ExplorationConfig& config,
                         const Executor& executor) {
  std::size_t frames = 0;
  for (int i = 0; i < config.oscillation_frames; ++i) {
    const double share = config.oscillation_frames > 1 ? 2.0 * i / (config.oscillation_frames - 1) - 1.0 : 0.0;
    const Pose wanted = T_world_view * Eigen::AngleAxisd{share * config.oscillation_rad, Eigen::Vector3d::UnitX()};
    SACCADE_TRY(const std::optional<Pose> T_world_robot, cell.robot.move_to(wanted));
    if (!T_world_robot) continue;
    SACCADE_TRY(const Frame frame, cell.observe(*T_world_robot));
    const ColorImage* color = frame.color ? &*frame.color : nullptr;
    SACCADE_TRY(
        [[maybe_unused]] const FusionStats stats,
        map.integrate(cell.camera, frame.depth, frame.T_world_camera.value_or(*T_world_robot), executor, color));
    ++frames;
  }
  return frames;
}

/// How the exploration of one region ended.
enum class RegionEnd : std::uint8_t { done, out_of_reach, views_used_up, cancelled };

/// The region that is being explored, and the poses that were tried in it without success.
struct OpenRegion {
  std::size_t index{0};
  const Region& region;
  std::vector<Pose> refused{};
  bool out_of_reach{false};  ///< some of them would have gained enough
};

/// How trying one view after the other came out: the view that the robot now stands at, if any.
struct Choice {
  std::optional<Proposal> view;
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
  std::vector<ExploredView>& views;

  [[nodiscard]] std::size_t views_of(std::size_t region) const {
    return static_cast<std::size_t>(std::count_if(
        views.begin(), views.end(), [region](const ExploredView& view) { return view.region == region; }));
  }

  /// Whether the pose was gone to, or tried, for this region.
  [[nodiscard]] bool attempted(const Pose& pose, const OpenRegion& open) const {
    constexpr double kSame{1e-9};  // a pose that was written to a file and read again
    const auto same = [&pose](const Pose& other) {
      return (other.matrix() - pose.matrix()).cwiseAbs().maxCoeff() <= kSame;
    };
    return std::any_of(open.refused.begin(), open.refused.end(), same) ||
           std::any_of(views.begin(), views.end(), [&](const ExploredView& view) {
             return view.region == open.index && same(view.T_world_camera);
           });
  }

  /// Tries the views in their order.
  [[nodiscard]] Result<Choice> move_to_best(const Proposals& proposals, OpenRegion& open) const {
    for (const Proposal& proposal : proposals.views) {
      if (proposals.by_gain && !(proposal.gain >= config.min_gain)) continue;
      if (attempted(proposal.T_world_camera, open)) continue;
      const Consent consent = hooks.before_move ? hooks.before_move(proposal) : Consent::go;
      if (consent == Consent::stop) return Choice{std::nullopt, true};
      if (consent == Consent::go) {
        SACCADE_TRY(const std::optional<Pose> reached, cell.robot.move_to(proposal.T_world_camera));
        if (reached) return Choice{proposal};
        open.out_of_reach = true;
      }
      open.refused.push_back(proposal.T_world_camera);
    }
    return Choice{};
  }

  /// NextBestView, move, look, until the region is done.
  [[nodiscard]] Result<RegionEnd> explore_region(OpenRegion open) const {
    while (views.size() < static_cast<std::size_t>(config.max_views)) {
      if (progress.cancelled()) return RegionEnd::cancelled;
      Stopwatch stopwatch;
      SACCADE_TRY(const Proposals proposals,
                  strategy.propose({map.content(), open.region, open.index, views_of(open.index), executor}));
      const double planning_ms = stopwatch.lap_ms();
      SACCADE_TRY(const Choice choice, move_to_best(proposals, open));
      if (choice.stop) return RegionEnd::cancelled;
      if (!choice.view) return open.out_of_reach ? RegionEnd::out_of_reach : RegionEnd::done;
      ExploredView view{open.index, choice.view->gain, choice.view->T_world_camera, proposals.views.size()};
      view.candidates_ms = proposals.candidates_ms;
      view.evaluation_ms = planning_ms - proposals.candidates_ms;
      view.motion_ms = stopwatch.lap_ms();
      SACCADE_TRY(view.frames, look(map, cell, view.T_world_camera, config, executor));
      view.fusion_ms = stopwatch.lap_ms();
      views.push_back(view);
      progress.report("exploring", views.size(), static_cast<std::size_t>(config.max_views));
      if (hooks.after_view && !hooks.after_view(view, proposals)) return RegionEnd::cancelled;
    }
    return RegionEnd::views_used_up;
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

Status ExplorationConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "exploration"}; };
  if (std::isnan(min_gain)) return fail("the least gain is not a number");
  if (max_views < 0) return fail("the number of views must not be negative");
  if (oscillation_frames < 1) return fail("a view needs one frame at least");
  if (!(oscillation_rad >= 0.0 && oscillation_rad < 1.5)) return fail("the oscillation is within 0 and 85 degrees");
  return {};
}

Result<bool> scan(TsdfMap& map, ExplorationCell& cell, const std::vector<Pose>& T_world_camera,
                  const ExplorationConfig& config, const Executor& executor, const ExplorationHooks& hooks,
                  const Progress& progress) {
  SACCADE_CHECK(config.validate());
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    progress.report("initial scan", i, T_world_camera.size());
    if (progress.cancelled()) return false;
    const Consent consent = hooks.before_move ? hooks.before_move({T_world_camera[i], 0.0}) : Consent::go;
    if (consent == Consent::stop) return false;
    if (consent == Consent::pass_over) continue;
    SACCADE_TRY(const std::optional<Pose> reached, cell.robot.move_to(T_world_camera[i]));
    if (!reached) continue;
    SACCADE_TRY([[maybe_unused]] const std::size_t frames, look(map, cell, T_world_camera[i], config, executor));
  }
  return true;
}

Result<ExplorationResult> explore(TsdfMap& map, ExplorationCell& cell, const std::vector<Region>& regions,
                                  const Strategy& strategy, const ExplorationConfig& config, const Executor& executor,
                                  const ExplorationHooks& hooks, const Progress& progress,
                                  std::vector<ExploredView> so_far) {
  SACCADE_CHECK(config.validate());
  ExplorationResult result;
  result.views = std::move(so_far);
  const Loop loop{map, cell, strategy, config, executor, hooks, progress, result.views};
  // What an earlier call was done with stays done.
  for (std::size_t i = result.views.empty() ? 0 : result.views.back().region; i < regions.size(); ++i) {
    SACCADE_TRY(const RegionEnd end, loop.explore_region({i, regions[i]}));
    if (end == RegionEnd::out_of_reach) result.stopped_because = StopReason::no_candidate;
    if (end == RegionEnd::views_used_up || end == RegionEnd::cancelled) {
      result.stopped_because = end == RegionEnd::cancelled ? StopReason::cancelled : StopReason::views_used_up;
      break;
    }
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
