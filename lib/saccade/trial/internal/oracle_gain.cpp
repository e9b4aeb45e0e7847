// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/internal/oracle_gain.hpp"

#include <algorithm>

#include "saccade/trial/internal/missing_surface.hpp"

namespace saccade {

OracleGain::OracleGain(GroundTruth truth, const PinholeCamera& camera, double tilt_rad)
    : truth_{std::move(truth)}, camera_{widened_vertically(camera, tilt_rad)} {}

Result<std::vector<double>> OracleGain::evaluate(const PlanningContext& context, const RegionOfInterest& /*region*/,
                                                 std::span<const Pose> T_world_camera) {
  const std::vector<MissingPoint> missing = missing_of(truth_, context.map, context.executor);
  const std::vector<std::size_t> starts = starts_of_centers(T_world_camera);
  std::vector<double> gains(T_world_camera.size());
  context.executor.parallel_for(starts.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3d center = T_world_camera[starts[s]].translation();
      const std::vector<std::size_t> visible = visible_from(center, missing, truth_.scene());
      for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
        const Pose T_camera_world = T_world_camera[i].inverse(Eigen::Isometry);
        gains[i] = static_cast<double>(std::count_if(visible.begin(), visible.end(), [&](std::size_t point) {
          return is_in_picture(missing[point].p_world, T_camera_world, camera_);
        }));
      }
    }
  });
  return gains;
}

Result<RankedViews> OracleGain::best(const PlanningContext& context, const RegionOfInterest& region,
                                     std::span<const Pose> T_world_camera, std::size_t count) {
  SACCADE_TRY(RankedViews ranked, Gain::best(context, region, T_world_camera, count));
  std::erase_if(ranked.views, [](const RankedView& view) { return !(view.gain > 0.0); });
  ranked.by_gain = false;
  return ranked;
}

NamedPlanner oracle_planner() {
  const auto make = [](const PlannerSetup& setup) {
    SACCADE_EXPECTS(setup.truth != nullptr);
    return PlannerParts{std::make_shared<WholeWorkspace>(),
                        std::make_shared<ContourViews>(setup.contour_views, setup.contours),
                        std::make_shared<OracleGain>(*setup.truth, setup.camera, setup.gain.tilt_rad), setup.planner};
  };
  return {"oracle", "the view that shows most, chosen with the scene known", 200.0, false, true, make, "points", false};
}

}  // namespace saccade
