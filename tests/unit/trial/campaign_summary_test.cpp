// SPDX-License-Identifier: Apache-2.0
// Results of runs: areas, views to a coverage, object-directed views, means over seeds and over scenes.
#include "saccade/trial/campaign_summary.hpp"

#include <gtest/gtest.h>

namespace saccade {
namespace {

/// A run whose coverage is this after the scan and after each view.
CampaignEntry covering(const std::vector<double>& coverage, std::uint64_t seed = 1,
                       const std::string& strategy = "sphere", const std::string& scene = "jug") {
  CampaignEntry entry{{scene, "00", strategy, "none", seed, "{}"}, {}, 0.0, {}, {}};
  RunRecord& run = entry.run;
  run.scan.measures.coverage = coverage.front();
  run.scan.measures.unknown_near_objects = 100;
  for (std::size_t i = 1; i < coverage.size(); ++i) {
    ViewRecord& view = run.views.emplace_back();
    view.measures.coverage = coverage[i];
    view.measures.unknown_near_objects = 100 - 10 * i;
    view.path_m = 0.5;
    view.refused.add(Refusal::no_ik, 3);
    view.times.add(Phase::fusion, 250.0);
  }
  run.stopped_because = StopReason::views_used_up;
  return entry;
}

CampaignEntry with_marks(const std::vector<bool>& marks) {
  CampaignEntry run = covering(std::vector<double>(marks.size() + 1, 0.5));
  for (std::size_t i = 0; i < marks.size(); ++i) run.run.views[i].reveals_object = marks[i];
  return run;
}

std::optional<double> figure(const CampaignEntry& run, std::string_view name, std::size_t budget = 5) {
  return run_figures()[run_figure_index(name)].of(run, budget);
}

TEST(CampaignFigures, AreaIsTheMeanCoverageOverTheBudget) {
  const CampaignEntry run = covering({0.2, 0.6, 1.0});
  EXPECT_DOUBLE_EQ(coverage_area(run, 0), 0.2);
  EXPECT_DOUBLE_EQ(coverage_area(run, 2), 0.6);
  EXPECT_DOUBLE_EQ(coverage_area(run, 4), (0.2 + 0.6 + 3.0) / 5.0);  // it goes on with its last value
  EXPECT_DOUBLE_EQ(coverage_area(run, 1), 0.4);                      // later views do not count
  EXPECT_DOUBLE_EQ(coverage_area(covering({0.3}), 7), 0.3);
}

TEST(CampaignFigures, ViewsToACoverage) {
  EXPECT_EQ(views_to_coverage(covering({0.2, 0.9, 0.8, 0.96}), 0.9), 1U);
  EXPECT_EQ(views_to_coverage(covering({0.2, 0.9, 0.8, 0.96}), 0.95), 3U);
  EXPECT_EQ(views_to_coverage(covering({0.97}), 0.95), 0U);
  EXPECT_EQ(views_to_coverage(covering({0.2, 0.9}), 0.95), std::nullopt);
}

TEST(CampaignFigures, ObjectDirectedViewsAreThoseOfTheFirstFive) {
  const CampaignEntry first = with_marks({true, true, false, false, false, true});
  EXPECT_EQ(object_views(first), 2U);
  EXPECT_EQ(objects_come_first(first), true);
  const CampaignEntry mixed = with_marks({false, true});
  EXPECT_EQ(object_views(mixed), 1U);
  EXPECT_EQ(objects_come_first(mixed), false);
  EXPECT_EQ(objects_come_first(with_marks({})), std::nullopt);
  EXPECT_EQ(objects_come_first(with_marks({false, false})), std::nullopt);
  EXPECT_EQ(objects_come_first(with_marks({false, false, false, false, false, true})), std::nullopt);
}

TEST(CampaignFigures, SumsAreOverAllViews) {
  const CampaignEntry run = covering({0.2, 0.4, 0.6});
  EXPECT_EQ(figure(run, "path_m"), 1.0);
  EXPECT_EQ(figure(run, "refused"), 6.0);
  EXPECT_EQ(figure(run, "refused_no_ik"), 6.0);
  EXPECT_EQ(figure(run, "refused_no_path"), 0.0);
  EXPECT_EQ(figure(run, "fusion_ms"), 500.0);
  EXPECT_EQ(figure(run, "unknown_near_objects_at_5"), 80.0);
  EXPECT_EQ(figure(run, "f_score"), std::nullopt);
}

TEST(CampaignSummary, IsTheMeanOverSeeds) {
  std::vector<CampaignEntry> runs;
  for (const std::uint64_t seed : {1U, 2U, 4U}) {
    runs.push_back(covering({0.25, 0.5, 0.6 + 0.001 * static_cast<double>(seed)}, seed));
  }
  for (const std::uint64_t seed : {1U, 4U, 9U}) runs.push_back(covering({0.25, 0.5}, seed, "random"));
  runs.back().run.stopped_because = StopReason::no_candidate;
  const std::vector<CampaignSummary> summaries = summarize(runs, 2);
  ASSERT_EQ(summaries.size(), 2U);  // one scene: none over all scenes
  EXPECT_EQ(summaries[0].group, (CampaignGroup{"jug", "sphere", "none"}));
  EXPECT_EQ(summaries[0].runs, 3U);
  EXPECT_NEAR(summaries[0].of("coverage").mean, 0.6 + 0.007 / 3.0, 1e-12);
  EXPECT_EQ(summaries[0].of("initial_coverage").half_width.value(), 0.0);
  EXPECT_EQ(summaries[0].of("accuracy_m").n, 0U);
  EXPECT_EQ(summaries[1].of("views").mean, 1.0);
  EXPECT_EQ(summaries[1].stopped.at("no_candidate"), 1U);
  EXPECT_EQ(summaries[1].stopped.at("views_used_up"), 2U);

  const auto coverage = [](const Measures& map) { return map.coverage.value_or(0.0); };
  const std::vector<MeanEstimate> curve = over_views(runs, summaries[0].group, 3, coverage);
  ASSERT_EQ(curve.size(), 4U);
  EXPECT_EQ(curve[0].mean, 0.25);
  EXPECT_NEAR(curve[2].mean, 0.6 + 0.007 / 3.0, 1e-12);
  EXPECT_EQ(curve[3].mean, curve[2].mean);
  EXPECT_TRUE(over_views(runs, {"jug", "none", "none"}, 3, coverage).empty());

  const MeanEstimate gap = paired_gaps(runs, summaries[0].group, summaries[1].group, 2)[run_figure_index("coverage")];
  EXPECT_EQ(gap.n, 2U);  // seeds 1 and 4
  EXPECT_NEAR(gap.mean, 0.1 + 0.0025, 1e-12);
}

TEST(CampaignSummary, PromisesAreJudgedOverTheViewsOfAllRuns) {
  std::vector<CampaignEntry> runs{covering({0.2, 0.4, 0.5, 0.6}, 1), covering({0.2, 0.4, 0.5}, 2)};
  const auto promise = [](ViewRecord& view, double promised, double observed) {
    view.gain_predicted = promised;
    view.gain_observed = observed;
  };
  promise(runs[0].run.views[0], 1000.0, 900.0);
  promise(runs[0].run.views[1], 500.0, 250.0);
  promise(runs[1].run.views[0], 800.0, 800.0);
  promise(runs[1].run.views[1], 600.0, 30.0);
  runs[0].run.views[2].gain_predicted = 100.0;  // was not checked
  const Calibration calibration = summarize(runs, 3).front().calibration;
  EXPECT_EQ(calibration.views, 4U);
  EXPECT_DOUBLE_EQ(calibration.median_kept.value(), 0.7);
  EXPECT_EQ(calibration.broken, 1U);
  EXPECT_DOUBLE_EQ(calibration.rank_correlation.value(), 0.8);  // one pair of neighbours is swapped
  const Calibration none = calibration_of({});
  EXPECT_TRUE(none.views == 0 && !none.median_kept && !none.rank_correlation);
}

TEST(CampaignSummary, OverAllScenesEachSceneCountsOnce) {
  // Ten alike runs of one scene are no more than one: seeds of a scene are no samples of scenes.
  std::vector<CampaignEntry> runs;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) runs.push_back(covering({0.2, 0.4}, seed, "sphere", "a"));
  runs.push_back(covering({0.2, 0.8}, 1, "sphere", "b"));
  runs.push_back(covering({0.2, 0.3}, 1, "random", "a"));
  runs.push_back(covering({0.2, 0.5}, 1, "random", "b"));
  const std::vector<CampaignSummary> summaries = summarize(runs, 1);
  ASSERT_EQ(summaries.size(), 6U);
  EXPECT_EQ(summaries[4].group, (CampaignGroup{std::nullopt, "sphere", "none"}));
  EXPECT_EQ(summaries[4].runs, 11U);
  EXPECT_EQ(summaries[4].of("coverage").n, 2U);
  EXPECT_NEAR(summaries[4].of("coverage").mean, 0.6, 1e-12);
  const MeanEstimate gap = paired_gaps(runs, summaries[4].group, summaries[5].group, 1)[run_figure_index("coverage")];
  EXPECT_EQ(gap.n, 2U);
  EXPECT_NEAR(gap.mean, 0.5 * (0.1 + 0.3), 1e-12);
}

TEST(CampaignSummary, SharesOfViewsAreOverTheRunsThatTookThem) {
  std::vector<CampaignEntry> runs{with_marks({true, false}), with_marks({true})};
  runs[1].key.seed = 2;
  const std::vector<MeanEstimate> shares = object_view_shares(runs, {"jug", "sphere", "none"});
  ASSERT_EQ(shares.size(), kFirstViews);
  EXPECT_EQ(shares[0].mean, 1.0);
  EXPECT_EQ(shares[1].n, 1U);
  EXPECT_EQ(shares[1].mean, 0.0);
  EXPECT_EQ(shares[2].n, 0U);
}

}  // namespace
}  // namespace saccade
