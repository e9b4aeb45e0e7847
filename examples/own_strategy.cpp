// SPDX-License-Identifier: Apache-2.0
// A strategy and a gain of one's own in Saccade's command line: `own_strategy compare --strategies level,sphere …` runs
// them against the others, with the same database, intervals and page; `own_strategy explore --strategy level …` too.
#include <cmath>

#include "command_line.hpp"
#include "saccade/trial/simulated_run.hpp"

using namespace saccade;

/// Counts rays, those of views that look far down half.
class LevelGain final : public Gain {
 public:
  explicit LevelGain(const GainConfig& rays) : rays_{rays} {}

  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> poses) override {
    SACCADE_TRY(std::vector<double> gains, rays_.evaluate(context, region, poses));
    for (std::size_t i = 0; i < poses.size(); ++i) gains[i] *= poses[i].linear()(2, 2) < -0.7 ? 0.5 : 1.0;
    return gains;
  }

 private:
  RayGain rays_;
};

/// Every 60 degrees around the region's centre, at two heights.
class TwoRings final : public ViewGenerator {
 public:
  [[nodiscard]] Result<ViewCandidates> views(const PlanningContext& /*context*/,
                                             const RegionOfInterest& region) override {
    const Box box = bounds(region.bounds);
    const Eigen::Vector3d center = 0.5 * (box.min + box.max);
    ViewCandidates found;
    for (const double height_m : {0.4, 0.7}) {
      for (double angle_rad = 0.0; angle_rad < 6.2; angle_rad += 1.0472) {
        const Eigen::Vector3d offset{0.7 * std::cos(angle_rad), 0.7 * std::sin(angle_rad), height_m};
        found.T_world_camera.push_back(look_at(center + offset, center));
      }
    }
    return found;
  }
};

int main(int argc, char** argv) {
  Planners planners = trial_planners();
  planners.add({"level", "two rings around the workspace, level views first", 200.0, false, false,
                [](const PlannerSetup& setup) {
                  return PlannerParts{std::make_shared<WholeWorkspace>(), std::make_shared<TwoRings>(),
                                      std::make_shared<LevelGain>(setup.gain), setup.planner};
                }});
  return cli::run_command_line(argc, argv, planners);
}
