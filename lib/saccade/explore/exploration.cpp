// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/exploration.hpp"

#include <optional>
#include <random>
#include <set>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/view/view_order.hpp"

namespace saccade {
namespace {

/// Candidates of one region in the order in which they are to be tried.
struct NextViews {
  std::vector<RankedView> ranked;
  double candidates_ms{0.0};
  double evaluation_ms{0.0};
};

/// A shuffle that is the same everywhere, other than std::shuffle's.
void shuffle(std::vector<RankedView>& views, std::mt19937_64& random) {
  for (std::size_t i = views.size(); i > 1; --i) std::swap(views[i - 1], views[random() % i]);
}

Result<NextViews> next_best_views(const TsdfSnapshot& map, const Region& region, const ExplorationConfig& config,
                                  std::mt19937_64& random, const Executor& executor) {
  NextViews next;
  Stopwatch stopwatch;
  const Box around = bounds(region);
  SACCADE_TRY(const std::vector<ViewCandidate> candidates, view_sphere(0.5 * (around.min + around.max), config.sphere));
  const std::vector<Pose> poses = poses_of(candidates);
  next.candidates_ms = stopwatch.lap_ms();
  SACCADE_TRY(const GainResult gains, evaluate_views(map, region, poses, config.gain, executor));
  next.ranked = order_views(gains.gains, poses);
  next.evaluation_ms = stopwatch.lap_ms();
  if (config.strategy == Strategy::random) shuffle(next.ranked, random);
  return next;
}

/// The view that the robot now stands at, if any would gain enough and could be reached.
struct Choice {
  std::optional<RankedView> view;
  bool out_of_reach{false};  ///< there were some that would, but none that could
};

/// Tries the views in their order, each once per region.
Result<Choice> move_to_best(const NextViews& next, std::uint64_t min_gain, Robot& robot,
                            std::set<std::size_t>& attempted) {
  Choice choice;
  for (const RankedView& view : next.ranked) {
    if (view.gain < min_gain || !attempted.insert(view.index).second) continue;
    SACCADE_TRY(const bool reached, robot.move_to(view.T_world_camera));
    if (reached) return Choice{view, false};
    choice.out_of_reach = true;
  }
  return choice;
}

/// PerformRobotOscillation: frames from −oscillation to +oscillation about the camera's x axis, each one fused.
Status look(TsdfMap& map, ExplorationCell& cell, const Pose& T_world_view, const ExplorationConfig& config,
            const Executor& executor) {
  for (int i = 0; i < config.oscillation_frames; ++i) {
    const double share = config.oscillation_frames > 1 ? 2.0 * i / (config.oscillation_frames - 1) - 1.0 : 0.0;
    const Pose T_world_camera =
        T_world_view * Eigen::AngleAxisd{share * config.oscillation_rad, Eigen::Vector3d::UnitX()};
    SACCADE_TRY(const bool reached, cell.robot.move_to(T_world_camera));
    if (!reached) continue;
    SACCADE_TRY(const Frame frame, cell.observe(T_world_camera));
    const ColorImage* color = frame.color ? &*frame.color : nullptr;
    SACCADE_TRY([[maybe_unused]] const FusionStats stats,
                map.integrate(cell.camera, frame.depth, T_world_camera, executor, color));
  }
  return {};
}

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
  SACCADE_CHECK(sphere.validate());
  SACCADE_CHECK(gain.validate());
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "exploration"}; };
  if (max_views < 0) return fail("the number of views must not be negative");
  if (oscillation_frames < 1) return fail("a view needs one frame at least");
  if (!(oscillation_rad >= 0.0 && oscillation_rad < 1.5)) return fail("the oscillation is within 0 and 85 degrees");
  return {};
}

Status scan(TsdfMap& map, ExplorationCell& cell, const std::vector<Pose>& T_world_camera,
            const ExplorationConfig& config, const Executor& executor) {
  SACCADE_CHECK(config.validate());
  for (const Pose& view : T_world_camera) {
    SACCADE_TRY(const bool reached, cell.robot.move_to(view));
    if (reached) SACCADE_CHECK(look(map, cell, view, config, executor));
  }
  return {};
}

Result<ExplorationResult> explore(TsdfMap& map, ExplorationCell& cell, const std::vector<Region>& regions,
                                  const ExplorationConfig& config, const Executor& executor,
                                  const std::function<bool(const ExploredView&)>& on_view, const Progress& progress) {
  SACCADE_CHECK(config.validate());
  ExplorationResult result;
  const auto stopped = [&result](StopReason reason) {
    result.stopped_because = reason;
    return result;
  };
  std::mt19937_64 random{config.seed};
  bool out_of_reach = false;
  for (std::size_t region = 0; region < regions.size(); ++region) {
    std::set<std::size_t> attempted;
    for (;;) {
      if (result.views.size() >= static_cast<std::size_t>(config.max_views)) return stopped(StopReason::views_used_up);
      if (progress.cancelled()) return stopped(StopReason::cancelled);
      SACCADE_TRY(const NextViews next, next_best_views(map.content(), regions[region], config, random, executor));
      Stopwatch stopwatch;
      SACCADE_TRY(const Choice choice, move_to_best(next, config.min_gain, cell.robot, attempted));
      if (!choice.view) {
        out_of_reach = out_of_reach || choice.out_of_reach;
        break;  // this region is done
      }
      ExploredView view{region, choice.view->gain, choice.view->T_world_camera, next.ranked.size()};
      view.candidates_ms = next.candidates_ms;
      view.evaluation_ms = next.evaluation_ms;
      view.motion_ms = stopwatch.lap_ms();
      SACCADE_CHECK(look(map, cell, view.T_world_camera, config, executor));
      view.fusion_ms = stopwatch.lap_ms();
      result.views.push_back(view);
      progress.report("exploring", result.views.size(), static_cast<std::size_t>(config.max_views));
      if (on_view && !on_view(view)) return stopped(StopReason::cancelled);
    }
  }
  return stopped(out_of_reach ? StopReason::no_candidate : StopReason::regions_done);
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
