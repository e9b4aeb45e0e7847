// SPDX-License-Identifier: Apache-2.0
// Area that views are expected to show beside the area of the true surfaces that they add to the map.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "saccade/core/statistics.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade {
namespace {

/// Shown over expected area of a flying camera's views in each scene, five at most.
std::vector<double> shown_over_expected(const std::vector<std::string>& scenes) {
  const Executor executor = Executor::with_threads(0);
  std::vector<double> ratios;
  for (const std::string& name : scenes) {
    const RayScene scene = RayScene::build(find_scene(name).value()).value();
    const GroundTruth truth = GroundTruth::build(scene, kTruthSpacing_m, executor).value();
    const double all_cm2 =
        static_cast<double>(truth.observable_points().size()) * truth.spacing_m() * truth.spacing_m() * 1e4;
    SimulatedRunConfig config;
    config.exploration.max_views = 5;
    const RunRecord run =
        run_simulated(truth, config.with(builtin_planners().find("surface").value()), executor).value();
    double before = run.scan.measures.coverage.value();
    for (const ViewRecord& view : run.views) {
      const double after = view.measures.coverage.value();
      ratios.push_back((after - before) * all_cm2 / view.gain_predicted);
      before = after;
      ::testing::Test::RecordProperty(name + "." + std::to_string(ratios.size()), std::to_string(ratios.back()));
    }
  }
  return ratios;
}

TEST(ExpectedSurfaceEvidence, ViewsShowAboutTheAreaThatIsExpected) {
  const std::vector<double> ratios =
      shown_over_expected({"clutter:101", "clutter:102", "clutter:103", "clutter:104", "tabletop-1", "tabletop-3"});
  ASSERT_GE(ratios.size(), 24U) << "some runs end before the fifth view";
  const double middle = median(ratios);
  RecordProperty("median", std::to_string(middle));
  EXPECT_GT(middle, 0.7);
  EXPECT_LT(middle, 1.4);
}

}  // namespace
}  // namespace saccade
