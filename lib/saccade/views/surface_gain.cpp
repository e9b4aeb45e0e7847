// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/surface_gain.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "saccade/views/internal/lazy_ranking.hpp"
#include "saccade/views/internal/surface_prospect.hpp"

namespace saccade {
namespace {

Status check_finite(std::span<const Pose> T_world_camera) {
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (T_world_camera[i].matrix().allFinite()) continue;
    return Error{Errc::invalid_argument, "pose " + std::to_string(i) + " contains NaN or infinity", "surface gain"};
  }
  return {};
}

/// Poses of one camera centre, and the most that one of them can gain.
struct Center {
  std::size_t begin{0};
  std::size_t end{0};
  double most{0.0};
};

/// Sets the gain of each pose to what `sights` show of it.
template <class Views>
double fill_in(const SurfaceProspect& prospect, std::span<const SurfaceProspect::Sight> sights, const Center& center,
               Views& views) {
  double most{0.0};
  for (std::size_t i = center.begin; i < center.end; ++i) {
    views[i].gain = prospect.area_in_picture(sights, views[i].T_world_camera);
    most = std::max(most, views[i].gain);
  }
  return most;
}

}  // namespace

Status SurfaceGainConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "surface gain"}; };
  SACCADE_CHECK(sensor.validate());
  if (!(tilt_rad >= 0.0 && std::isfinite(tilt_rad))) return fail("the tilt must not be negative");
  if (!(least_share >= 0.0 && least_share <= 1.0)) return fail("the least share of a view lies within 0 and 1");
  return surface.validate();
}

SurfaceGain::SurfaceGain(const SurfaceGainConfig& config)
    : config_{config}, widened_{widened_vertically(config_.sensor, config_.tilt_rad)} {
  SACCADE_EXPECTS(config_.validate().ok());
}

Result<std::vector<double>> SurfaceGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                  std::span<const Pose> T_world_camera) {
  SACCADE_CHECK(check_finite(T_world_camera));
  SACCADE_TRY(ExpectedSurface surface, expected_surface(context.map, config_.surface, context.executor));
  SACCADE_TRY(const SurfaceProspect prospect, SurfaceProspect::create(context, region, std::move(surface), widened_));
  std::vector<double> gains(T_world_camera.size());
  context.executor.parallel_for(gains.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) gains[i] = prospect.promise(T_world_camera[i]).worth();
  });
  return gains;
}

Result<RankedViews> SurfaceGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                      std::span<const Pose> T_world_camera, std::size_t count) {
  SACCADE_CHECK(check_finite(T_world_camera));
  SACCADE_TRY(ExpectedSurface surface, expected_surface(context.map, config_.surface, context.executor));
  SACCADE_TRY(SurfaceProspect made, SurfaceProspect::create(context, region, std::move(surface), widened_));
  const auto prospect = std::make_shared<const SurfaceProspect>(std::move(made));
  RankedViews ranked;
  ranked.least_gain = config_.least_share * prospect->surface().seen_cm2;
  ranked.promise = [prospect](const Pose& pose) { return prospect->promise(pose); };
  ranked.evaluated = T_world_camera.size();

  // A bound for each pose, by camera centres; then lines of sight from the centres that come near the best.
  std::vector<RankedView> views;
  for (const Pose& pose : T_world_camera) views.push_back({pose});
  const std::vector<std::size_t> starts = starts_of_centers(T_world_camera);
  std::vector<Center> centers(starts.size() - 1);
  context.executor.parallel_for(centers.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      centers[i] = {starts[i], starts[i + 1]};
      const auto facing = prospect->facing(T_world_camera[starts[i]].translation());
      centers[i].most = fill_in(*prospect, facing, centers[i], views);
    }
  });
  const auto by_most = [](const Center& a, const Center& b) { return a.most > b.most; };
  std::stable_sort(centers.begin(), centers.end(), by_most);
  constexpr double kNothing{-std::numeric_limits<double>::infinity()};
  const FirmBest seen = firm_best(
      centers, kNothing, count, [](const Center& center) { return center.most; },
      [&](std::size_t from, std::size_t to) {
        context.executor.parallel_for(to - from, 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = from + begin; i < from + end; ++i) {
            const auto visible = prospect->visible(views[centers[i].begin].T_world_camera.translation());
            centers[i].most = fill_in(*prospect, visible, centers[i], views);
          }
        });
      });
  for (std::size_t i = 0; i < seen.looked; ++i) {
    for (std::size_t j = centers[i].begin; j < centers[i].end; ++j) ranked.views.push_back(views[j]);
  }
  order_by_gain(ranked.views);

  // What the robot's own body hides of the views that are left, again the best alone.
  const double beyond = seen.looked < centers.size() ? centers[seen.looked].most : kNothing;
  const auto look = [&](std::size_t from, std::size_t to) {
    context.executor.parallel_for(to - from, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = from + begin; i < from + end; ++i) {
        ranked.views[i].gain = prospect->promise(ranked.views[i].T_world_camera).worth();
      }
    });
  };
  FirmBest best{ranked.views.size(), ranked.views.size()};
  if (prospect->knows_body()) {
    best = firm_best(
        ranked.views, beyond, count, [](const RankedView& view) { return view.gain; }, look);
  } else {
    best.firm = static_cast<std::size_t>(std::count_if(ranked.views.begin(), ranked.views.end(),
                                                       [&](const RankedView& view) { return view.gain >= beyond; }));
  }
  ranked.complete = best.firm == views.size();
  ranked.views.resize(best.firm);
  return ranked;
}

}  // namespace saccade
