// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/foresight.hpp"

#include <algorithm>

#include "saccade/views/view_set.hpp"

namespace saccade {
namespace {

constexpr std::size_t kPool{256};  // views to choose a set from
constexpr std::size_t kRivals{8};  // default size of a set
constexpr double kLook_s{1.0};     // duration of a view besides the motion to it

/// Returns the best view of each camera centre: its other rolls show almost the same.
std::vector<std::size_t> best_of_centers(std::span<const RankedView> views) {
  std::vector<std::size_t> best;
  std::vector<Eigen::Vector3d> centers;
  for (std::size_t i = 0; i < views.size() && best.size() < kPool; ++i) {
    const Eigen::Vector3d center = views[i].T_world_camera.translation();
    if (std::find(centers.begin(), centers.end(), center) != centers.end()) continue;
    centers.push_back(center);
    best.push_back(i);
  }
  return best;
}

std::vector<Promise> promises_of(const Ranking& ranking, std::span<const std::size_t> views, const Executor& executor) {
  std::vector<Promise> promises(views.size());
  executor.parallel_for(views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      promises[i] = ranking.promise(ranking.untried()[views[i]].T_world_camera);
    }
  });
  return promises;
}

/// Returns the worth of a motion: the view's promise, and those of the frames during it.
double worth_with_way(const Promise& view, const Motion& motion, const Foresight& foresight, const Robot& robot,
                      const Ranking& ranking) {
  if (!(foresight.frame_on_way_s > 0.0)) return view.worth();
  std::vector<Promise> promises{view};
  for (const MotionSample& sample : robot.camera_on_way(motion, foresight.frame_on_way_s)) {
    promises.push_back(ranking.promise(sample.T_world_camera));
  }
  return worth_together(promises);
}

}  // namespace

Status look_ahead(const Foresight& foresight, Robot& robot, const Executor& executor, Ranking& ranking) {
  if (!foresight.is_needed() || ranking.empty() || !ranking.makes_promises()) return {};
  const std::vector<std::size_t> pool = best_of_centers(ranking.untried());
  const std::vector<Promise> promises = promises_of(ranking, pool, executor);
  const std::size_t count = foresight.lookahead > 1 ? foresight.lookahead : kRivals;
  struct Weighed {
    std::size_t view;
    double value;
  };
  std::vector<Weighed> set;
  for (const std::size_t i : best_sequence(promises, count, executor)) {
    const Pose& pose = ranking.untried()[pool[i]].T_world_camera;
    SACCADE_TRY(const PlannedMotion planned, robot.plan(std::span{&pose, 1}));
    if (!planned.motion) continue;
    double value = worth_with_way(promises[i], *planned.motion, foresight, robot, ranking);
    if (foresight.objective == Objective::surface_per_second) {
      value /= planned.motion->trajectory.duration_s() + kLook_s;
    }
    set.push_back({pool[i], value});
  }
  std::stable_sort(set.begin(), set.end(), [](const Weighed& a, const Weighed& b) { return a.value > b.value; });
  std::vector<std::size_t> first;
  for (const Weighed& view : set) first.push_back(view.view);
  ranking.put_first(first);
  return {};
}

}  // namespace saccade
