// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/internal/pair_oracle.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "saccade/map/voxel_index.hpp"

namespace saccade {
namespace {

std::size_t count_of(const ShownPoints& shown) {
  std::size_t count{0};
  for (const std::uint64_t word : shown) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

std::size_t count_of_union(const ShownPoints& a, const ShownPoints& b) {
  std::size_t count{0};
  for (std::size_t i = 0; i < a.size(); ++i) count += static_cast<std::size_t>(std::popcount(a[i] | b[i]));
  return count;
}

}  // namespace

std::optional<ViewPair> best_pair(std::span<const ShownPoints> shown, const Executor& executor) {
  const std::size_t views = shown.size();
  if (views < 2) return std::nullopt;
  std::vector<std::size_t> count(views);
  for (std::size_t i = 0; i < views; ++i) count[i] = count_of(shown[i]);
  std::vector<std::size_t> order(views);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return count[a] > count[b]; });
  // Finds the best partner of each view behind it in the order, if together they show more than `least`.
  const auto best_with = [&](std::size_t i, std::size_t least) {
    ViewPair best{order[i], order[i], least};
    for (std::size_t j = i + 1; j < views && count[order[i]] + count[order[j]] > best.shown; ++j) {
      const std::size_t together = count_of_union(shown[order[i]], shown[order[j]]);
      if (together > best.shown) best = {order[i], order[j], together};
    }
    return best;
  };
  ViewPair best = best_with(0, 0);
  if (best.second == best.first) return ViewPair{order[0], order[1], count[order[0]]};  // no pair shows more
  constexpr std::size_t kRound{256};  // views between updates of the bound, whatever the number of threads
  for (std::size_t begin = 1; begin < views && 2 * count[order[begin]] > best.shown; begin += kRound) {
    std::vector<ViewPair> found(std::min(kRound, views - begin));
    executor.parallel_for(found.size(), 1,
                          [&](std::size_t i, std::size_t) { found[i] = best_with(begin + i, best.shown); });
    for (const ViewPair& pair : found) {
      if (pair.shown > best.shown) best = pair;
    }
  }
  return best;
}

Result<ViewCandidates> OracleViews::views(const PlanningContext& context, const RegionOfInterest& region) {
  SACCADE_TRY(ViewCandidates found, contours_->views(context, region));
  struct Cell {
    Eigen::Vector3d sum{Eigen::Vector3d::Zero()};
    double count{0.0};
  };
  const auto before = [](const Index3& a, const Index3& b) { return zyx_less(a, b); };
  std::map<Index3, Cell, decltype(before)> cells{before};
  for (const MissingPoint& point : missing_of(truth_, context.map, context.executor)) {
    Cell& cell = cells[voxel_at(point.p_world, kOracleCell_m)];
    cell.sum += point.p_world;
    cell.count += 1.0;
  }
  for (const auto& [index, cell] : cells) {
    SACCADE_TRY(const std::vector<ViewCandidate> around, view_sphere(cell.sum / cell.count, sphere_));
    const std::vector<Pose> poses = poses_of(around);
    found.T_world_camera.insert(found.T_world_camera.end(), poses.begin(), poses.end());
  }
  found.in_all = found.T_world_camera.size();
  return found;
}

PairOracle::PairOracle(GroundTruth truth, const PinholeCamera& camera, double tilt_rad, std::size_t max_views)
    : truth_{std::move(truth)}, camera_{widened_vertically(camera, tilt_rad)}, max_views_{max_views} {}

std::vector<ShownPoints> PairOracle::shown_by(const PlanningContext& context,
                                              std::span<const Pose> T_world_camera) const {
  const std::vector<MissingPoint> missing = missing_of(truth_, context.map, context.executor);
  const std::vector<std::size_t> starts = starts_of_centers(T_world_camera);
  std::vector<ShownPoints> shown(T_world_camera.size(), ShownPoints((missing.size() + 63) / 64, 0));
  context.executor.parallel_for(starts.size() - 1, 1, [&](std::size_t s, std::size_t) {
    const std::vector<std::size_t> visible =
        visible_from(T_world_camera[starts[s]].translation(), missing, truth_.scene());
    for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
      const Pose T_camera_world = T_world_camera[i].inverse(Eigen::Isometry);
      for (const std::size_t point : visible) {
        if (is_in_picture(missing[point].p_world, T_camera_world, camera_))
          shown[i][point / 64] |= std::uint64_t{1} << (point % 64);
      }
    }
  });
  return shown;
}

Result<std::vector<double>> PairOracle::evaluate(const PlanningContext& context, const RegionOfInterest& /*region*/,
                                                 std::span<const Pose> T_world_camera) {
  std::vector<double> gains;
  for (const ShownPoints& shown : shown_by(context, T_world_camera)) {
    gains.push_back(static_cast<double>(count_of(shown)));
  }
  return gains;
}

Result<RankedViews> PairOracle::best(const PlanningContext& context, const RegionOfInterest& /*region*/,
                                     std::span<const Pose> T_world_camera, std::size_t /*count*/) {
  RankedViews ranked;
  ranked.evaluated = T_world_camera.size();
  ranked.by_gain = false;
  std::vector<Pose> poses;
  for (const Pose& pose : T_world_camera) {
    if (!context.was_attempted(pose)) poses.push_back(pose);
  }
  const std::vector<ShownPoints> shown = shown_by(context, poses);
  std::optional<ViewPair> pair;
  if (context.views_taken + 1 < max_views_) pair = best_pair(shown, context.executor);
  std::vector<RankedView> ahead;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RankedView view{poses[i], static_cast<double>(count_of(shown[i]))};
    if (!(view.gain > 0.0)) continue;
    const bool of_pair = pair && (i == pair->first || i == pair->second);
    (of_pair ? ahead : ranked.views).push_back(view);
  }
  order_by_gain(ahead);
  order_by_gain(ranked.views);
  ranked.views.insert(ranked.views.begin(), ahead.begin(), ahead.end());
  return ranked;
}

NamedPlanner pair_oracle_planner() {
  const auto make = [](const PlannerSetup& setup) {
    SACCADE_EXPECTS(setup.truth != nullptr);
    auto contours = std::make_shared<ContourViews>(setup.contour_views, setup.contours);
    return PlannerParts{std::make_shared<WholeWorkspace>(),
                        std::make_shared<OracleViews>(*setup.truth, std::move(contours), setup.sphere),
                        std::make_shared<PairOracle>(*setup.truth, setup.camera, setup.gain.tilt_rad, setup.max_views),
                        setup.planner};
  };
  return {"oracle-2", "the first of the two views that together show most, chosen with the scene known",
          200.0,      false,
          true,       make,
          "points",   false};
}

}  // namespace saccade
