// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/surface_gain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "saccade/views/internal/check_finite.hpp"
#include "saccade/views/internal/lazy_ranking.hpp"
#include "saccade/views/internal/surface_prospect.hpp"

namespace saccade {
namespace {

constexpr double kBroken{0.25};       // share of a promise below which the map stays unreliable
constexpr double kDisappointed{0.5};  // share below which it is unreliable for the next view

/// Poses of one camera centre, and the largest gain that one of them can have.
struct Center {
  std::size_t begin{0};
  std::size_t end{0};
  double most{0.0};
};

/// Sets the gain of each pose to the area that `sights` show in it.
template <class Views>
double fill_in(const SurfaceProspect& prospect, std::span<const SurfaceProspect::TileVisibility> sights,
               const Center& center, Views& views) {
  double most{0.0};
  for (std::size_t i = center.begin; i < center.end; ++i) {
    views[i].gain = prospect.area_in_picture(sights, views[i].T_world_camera);
    most = std::max(most, views[i].gain);
  }
  return most;
}

/// Gains of poses whose centres are close to the best, by decreasing gain.
struct Sighted {
  std::vector<RankedView> views{};
  double beyond{-std::numeric_limits<double>::infinity()};  ///< upper bound of the gains of all others
};

/// Bounds each pose by the surface that faces its camera, and traces lines of sight from the centres close to the best.
Sighted sighted(const SurfaceProspect& prospect, std::span<const Pose> T_world_camera, std::size_t count, bool one_roll,
                const Executor& executor, ViewDevice* device) {
  std::vector<RankedView> views;
  for (const Pose& pose : T_world_camera) views.push_back({pose});
  const std::vector<std::size_t> starts = starts_of_centers(T_world_camera);
  std::vector<Center> centers(starts.size() - 1);
  const auto position = [&](const Center& center) { return T_world_camera[center.begin].translation(); };
  executor.parallel_for(centers.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      centers[i] = {starts[i], starts[i + 1]};
      centers[i].most = fill_in(prospect, prospect.facing(position(centers[i])), centers[i], views);
    }
  });
  std::stable_sort(centers.begin(), centers.end(), [](const Center& a, const Center& b) { return a.most > b.most; });
  Sighted result;
  const auto look = [&](std::size_t from, std::size_t to) {
    std::vector<std::span<const Pose>> places;
    for (std::size_t i = from; i < to; ++i)
      places.push_back(T_world_camera.subspan(centers[i].begin, centers[i].end - centers[i].begin));
    const auto sights = prospect.visible(places, executor, device);
    executor.parallel_for(to - from, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        centers[from + i].most = fill_in(prospect, sights[i], centers[from + i], views);
    });
  };
  const FirmBest best = firm_best(
      centers, result.beyond, count, [](const Center& center) { return center.most; }, look);
  for (std::size_t i = 0; i < best.looked; ++i) {
    const auto begin = views.begin() + static_cast<std::ptrdiff_t>(centers[i].begin);
    const auto end = views.begin() + static_cast<std::ptrdiff_t>(centers[i].end);
    const auto by_gain = [](const RankedView& a, const RankedView& b) { return a.gain < b.gain; };
    if (one_roll) {
      result.views.push_back(*std::max_element(begin, end, by_gain));
    } else {
      result.views.insert(result.views.end(), begin, end);
    }
  }
  order_by_gain(result.views);
  if (best.looked < centers.size()) result.beyond = centers[best.looked].most;
  return result;
}

/// Computes gains, with the robot's own body taken into account.
void tell_gains(const SurfaceProspect& prospect, std::span<RankedView> views, const Executor& executor) {
  executor.parallel_for(views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) views[i].gain = prospect.promise(views[i].T_world_camera).worth();
  });
}

/// Subtracts what the robot's own body hides, and drops views that others might beat.
void without_body(const SurfaceProspect& prospect, Sighted& sighted, std::size_t count, const Executor& executor) {
  std::vector<RankedView>& views = sighted.views;
  if (!prospect.knows_body()) {
    std::erase_if(views, [&](const RankedView& view) { return !(view.gain >= sighted.beyond); });
    return;
  }
  const auto look = [&](std::size_t from, std::size_t to) {
    tell_gains(prospect, std::span{views}.subspan(from, to - from), executor);
  };
  views.resize(firm_best(
                   views, sighted.beyond, count, [](const RankedView& view) { return view.gain; }, look)
                   .firm);
}

/// Tells whether there may be more to see than the known empty space suggests.
bool is_doubtful(std::span<const CheckedView> checked) {
  if (!checked.empty() && checked.back().kept_share < kDisappointed) return true;
  return std::any_of(checked.begin(), checked.end(), [](const CheckedView& view) { return view.kept_share < kBroken; });
}

/// Tells whether a view that was not attempted promises enough.
bool is_worth_going(const PlanningContext& context, const RankedViews& ranked) {
  return std::any_of(ranked.views.begin(), ranked.views.end(), [&](const RankedView& view) {
    return view.gain > 0.0 && view.gain >= ranked.least_gain && !context.was_attempted(view.T_world_camera);
  });
}

}  // namespace

Status SurfaceGainConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "surface gain"}; };
  SACCADE_CHECK(sensor.validate());
  if (!(tilt_rad >= 0.0 && std::isfinite(tilt_rad))) return fail("the tilt must not be negative");
  if (!(least_share >= 0.0 && least_share <= 1.0)) return fail("the least share of a view lies within 0 and 1");
  if (!(doubtful_share >= 0.0 && doubtful_share <= 1.0)) return fail("the doubtful share lies within 0 and 1");
  return surface.validate();
}

SurfaceGain::SurfaceGain(const SurfaceGainConfig& config, MakeSight sight)
    : config_{config}, widened_{widened_vertically(config_.sensor, config_.tilt_rad)}, sight_{std::move(sight)} {
  SACCADE_EXPECTS(config_.validate().ok());
}

Result<std::shared_ptr<const LinesOfSight>> SurfaceGain::sight_to(std::shared_ptr<const ExpectedSurface> surface,
                                                                  const Executor& executor) const {
  if (sight_) return sight_(std::move(surface), executor);
  return voxel_sight(std::move(surface));
}

Result<std::vector<double>> SurfaceGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                  std::span<const Pose> T_world_camera) {
  SACCADE_CHECK(check_finite(T_world_camera, "surface gain"));
  SACCADE_TRY(auto surface, expected_surface(context, config_.surface));
  SACCADE_TRY(auto sight, sight_to(surface, context.executor));
  SACCADE_TRY(const SurfaceProspect prospect,
              SurfaceProspect::create(context, region, std::move(surface), std::move(sight), widened_, 0.0));
  std::vector<double> gains(T_world_camera.size());
  context.executor.parallel_for(gains.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) gains[i] = prospect.promise(T_world_camera[i]).worth();
  });
  return gains;
}

Result<RankedViews> SurfaceGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                      std::span<const Pose> T_world_camera, std::size_t count) {
  SACCADE_CHECK(check_finite(T_world_camera, "surface gain"));
  const bool doubtful = is_doubtful(context.checked);
  SACCADE_TRY(RankedViews views,
              ranked(context, region, T_world_camera, count, doubtful ? config_.doubtful_share : 0.0));
  if (doubtful || is_worth_going(context, views)) return views;
  return ranked(context, region, T_world_camera, count, config_.doubtful_share);
}

Result<RankedViews> SurfaceGain::ranked(const PlanningContext& context, const RegionOfInterest& region,
                                        std::span<const Pose> T_world_camera, std::size_t count,
                                        double doubtful_share) const {
  SACCADE_TRY(auto surface, expected_surface(context, config_.surface));
  SACCADE_TRY(auto sight, sight_to(surface, context.executor));
  SACCADE_TRY(SurfaceProspect made,
              SurfaceProspect::create(context, region, std::move(surface), std::move(sight), widened_, doubtful_share));
  const auto prospect = std::make_shared<const SurfaceProspect>(std::move(made));
  std::vector<Pose> others;
  std::vector<RankedView> attempted;
  for (const Pose& pose : T_world_camera) {
    if (context.was_attempted(pose)) {
      attempted.push_back({pose});
    } else {
      others.push_back(pose);
    }
  }
  ViewDevice* const device = sight_ ? nullptr : context.device;  // it looks along voxels
  Sighted best = sighted(*prospect, others, count, config_.one_roll, context.executor, device);
  without_body(*prospect, best, count, context.executor);
  RankedViews ranked;
  ranked.complete = best.views.size() == others.size();
  ranked.views = std::move(best.views);
  tell_gains(*prospect, attempted, context.executor);
  ranked.views.insert(ranked.views.end(), attempted.begin(), attempted.end());
  order_by_gain(ranked.views);
  ranked.evaluated = T_world_camera.size();
  ranked.least_gain = config_.least_share * prospect->surface().seen_cm2;
  ranked.promise = [prospect](const Pose& pose) { return prospect->promise(pose); };
  return ranked;
}

}  // namespace saccade
