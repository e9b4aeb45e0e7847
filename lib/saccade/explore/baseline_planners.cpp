// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/baseline_planners.hpp"

#include "saccade/views/baseline_gains.hpp"

namespace saccade {
namespace {

constexpr std::size_t kTries{64};
constexpr double kAnyGain{1e-9};

using MakeGain = std::function<std::shared_ptr<Gain>(const BaselineGainConfig& config)>;

NamedPlanner baseline(std::string name, std::string text, std::string unit, MakeGain make_gain) {
  const auto make = [make_gain = std::move(make_gain)](const PlannerSetup& setup) {
    PlannerParts parts{std::make_shared<WholeWorkspace>(),
                       std::make_shared<ContourViews>(setup.contour_views, setup.contours),
                       make_gain({.sensor = setup.gain.sensor, .tilt_rad = setup.gain.tilt_rad}), setup.planner};
    parts.config.tries = kTries;
    return parts;
  };
  return {std::move(name), std::move(text), kAnyGain, false, false, make, std::move(unit), false};
}

NamedPlanner volumetric(VolumetricInformation information, std::string text, std::string unit) {
  return baseline(std::string{kVolumetricInformationNames.of(information)}, std::move(text), std::move(unit),
                  [information](const BaselineGainConfig& config) { return volumetric_gain(information, config); });
}

}  // namespace

std::vector<NamedPlanner> baseline_planners() {
  using enum VolumetricInformation;
  return {
      volumetric(occlusion_aware, "entropy that is visible along rays (Delmerico et al. 2018)", "nats"),
      volumetric(unobserved_voxel, "entropy of unknown voxels that is visible (Delmerico et al. 2018)", "nats"),
      volumetric(rear_side_voxel, "rays onto the rear sides of surfaces (Delmerico et al. 2018)", "rays"),
      volumetric(rear_side_entropy, "visible entropy before rear sides of surfaces (Delmerico et al. 2018)", "nats"),
      volumetric(proximity_count, "unknown voxels by their nearness to surfaces (Delmerico et al. 2018)", "voxels"),
      volumetric(average_entropy, "mean entropy along rays that end on surfaces (Kriegel et al. 2015)", "nats"),
      volumetric(area_factor, "shares of voxels seen, against those wished for (Vasquez-Gomez et al. 2014)", "points"),
      baseline("surface-edge", "frontier points at the edges of surfaces (after Border and Gammell 2024)", "points",
               [](const BaselineGainConfig& config) { return surface_edge_gain(config); }),
      baseline("projection", "area of frontiers as ellipsoids in the image (after Jia et al. 2025)", "pixels",
               [](const BaselineGainConfig& config) { return projection_gain(config); }),
  };
}

}  // namespace saccade
