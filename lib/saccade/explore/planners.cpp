// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/planners.hpp"

#include <algorithm>

#include "saccade/core/nearest_word.hpp"
#include "saccade/views/one_shot_gain.hpp"
#include "saccade/views/surface_views.hpp"

namespace saccade {
namespace {

constexpr std::size_t kContourTries{64};
constexpr std::size_t kSurfaceTries{4};
constexpr std::size_t kForesightTries{256};
constexpr std::size_t kSpareViews{16};  // ranked in addition to the views taken, since the robot may not reach some
constexpr std::size_t kAllViews{std::numeric_limits<std::size_t>::max()};

std::shared_ptr<AttentionSource> regions_in_turn(const PlannerSetup& setup) {
  return std::make_shared<RegionsInTurn>(std::span<const Region>{setup.regions});
}

std::shared_ptr<ViewGenerator> contour_views_of(const PlannerSetup& setup) {
  return std::make_shared<ContourViews>(setup.contour_views, setup.contours);
}

std::shared_ptr<ViewGenerator> surface_views_of(const PlannerSetup& setup) {
  SurfaceViewsConfig config;
  config.sphere.radii_m = setup.contour_views.distances_m;
  return std::make_shared<SurfaceViews>(contour_views_of(setup), config);
}

std::shared_ptr<Gain> rays(const PlannerSetup& setup) {
  return std::make_shared<RayGain>(setup.gain, setup.as_printed ? Trust::blind : Trust::credible);
}

std::shared_ptr<Gain> by_chance(const PlannerSetup& setup, bool anew) {
  return std::make_shared<RandomOrder>(rays(setup), RandomOrderConfig{setup.seed, anew});
}

ViewPlannerConfig with_tries(const PlannerSetup& setup, std::size_t tries) {
  ViewPlannerConfig config = setup.planner;
  config.tries = tries;
  return config;
}

PlannerParts make_random(const PlannerSetup& setup) {
  PlannerParts parts{regions_in_turn(setup), std::make_shared<SphereViews>(setup.sphere), by_chance(setup, false),
                     with_tries(setup, kSpareViews)};
  const std::size_t regions = std::max<std::size_t>(1, setup.regions.size());
  parts.config.views_per_region = (setup.max_views + regions - 1) / regions;
  return parts;
}

}  // namespace

void Planners::add(NamedPlanner planner) {
  const auto same = [&](const NamedPlanner& other) { return other.name == planner.name; };
  const auto found = std::find_if(planners_.begin(), planners_.end(), same);
  if (found != planners_.end()) {
    *found = std::move(planner);
  } else {
    planners_.push_back(std::move(planner));
  }
}

Result<NamedPlanner> Planners::find(std::string_view name) const {
  for (const NamedPlanner& planner : planners_) {
    if (planner.name == name) return planner;
  }
  std::vector<std::string_view> known;
  for (const NamedPlanner& planner : planners_) known.emplace_back(planner.name);
  return Error{Errc::invalid_argument,
               "there is no strategy \"" + std::string{name} + "\"; known: " + names() + did_you_mean(name, known), ""};
}

std::string Planners::names() const { return joined(planners_, ", ", &NamedPlanner::name); }

NamedPlanner surface_planner() {
  const auto make = [](const PlannerSetup& setup) {
    const SurfaceGainConfig gain{.sensor = setup.gain.sensor,
                                 .tilt_rad = setup.gain.tilt_rad,
                                 .least_share = setup.least_share,
                                 .one_roll = setup.looks_ahead};
    std::shared_ptr<AttentionSource> attention = std::make_shared<WholeWorkspace>();
    if (setup.weigh_by_saliency) attention = std::make_shared<SalientWorkspace>(setup.attention);
    return PlannerParts{std::move(attention), surface_views_of(setup), std::make_shared<SurfaceGain>(gain, setup.sight),
                        with_tries(setup, setup.looks_ahead ? kForesightTries : kSurfaceTries)};
  };
  return {"surface", "views of contours and of what is missing, by the surface that they are expected to show, in cm²",
          2.0,       false,
          false,     make,
          "cm²",     false};
}

NamedPlanner attention_planner() {
  const auto make = [](const PlannerSetup& setup) {
    SalientObjectsConfig attention = setup.attention;
    ViewPlannerConfig planner = setup.planner;
    if (setup.as_printed) {
      attention.scrap_length_m = 0.0;
      planner.rival_share = 1.0;
    }
    return PlannerParts{std::make_shared<SalientObjects>(attention), contour_views_of(setup), rays(setup), planner};
  };
  return {"attention", "views of the contours of what looks like an object, the most salient first",
          50.0,        false,
          false,       make,
          "rays",      false};
}

NamedPlanner one_shot(const NamedPlanner& planner) {
  NamedPlanner once = planner;
  once.name += kOneShotSuffix;
  once.text = "as " + planner.name + ", but all views are chosen at once after the first look";
  once.make = [make = planner.make](const PlannerSetup& setup) {
    PlannerParts parts = make(setup);
    const OneShotConfig plan{.max_views = setup.max_views, .min_addition = parts.config.min_gain};
    parts.gain = std::make_shared<OneShotGain>(parts.gain, plan);
    return parts;
  };
  return once;
}

Planners builtin_planners() {
  Planners planners;
  const auto add_without_chance = [&planners](NamedPlanner planner) {
    planner.uses_seed = false;
    planners.add(std::move(planner));
  };
  planners.add(surface_planner());
  planners.add(attention_planner());
  add_without_chance({"standard", "of all contours, the view of most unknown space", 200.0, false, false,
                      [](const PlannerSetup& setup) {
                        return PlannerParts{std::make_shared<WholeWorkspace>(), contour_views_of(setup), rays(setup),
                                            with_tries(setup, kContourTries)};
                      }});
  add_without_chance(
      {"sphere", "best gain on the view sphere around each region", 200.0, true, false, [](const PlannerSetup& setup) {
         ViewPlannerConfig planner = with_tries(setup, kAllViews);
         planner.asks_robot_first = !setup.as_printed;
         return PlannerParts{regions_in_turn(setup), std::make_shared<SphereViews>(setup.sphere), rays(setup), planner};
       }});
  planners.add({"random", "poses of sphere in random order", 200.0, true, false, make_random});
  planners.add(
      {"random-contours", "poses of standard in random order", 200.0, false, false, [](const PlannerSetup& setup) {
         return PlannerParts{std::make_shared<WholeWorkspace>(), contour_views_of(setup), by_chance(setup, true),
                             with_tries(setup, kContourTries)};
       }});
  return planners;
}

}  // namespace saccade
