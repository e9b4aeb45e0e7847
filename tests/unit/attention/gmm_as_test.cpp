// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/gmm_as.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "support/effort.hpp"
#include "thesis/hand_figures.hpp"

namespace saccade {
namespace {

TEST(GmmAs, FindsTheActionsOfMadeUpTasks) {
  DetectionCounts counts;
  constexpr std::uint64_t kTasks{test::kSanitized ? 10 : 40};
  for (std::uint64_t seed = 0; seed < kTasks; ++seed) {
    const SyntheticTask task = synthetic_task(seed, {.actions = 1 + static_cast<int>(seed % 2)});
    const GmmAsResult result = detect_by_gmm(task.trajectory).value();
    counts += score(result.actions, task.actions_m).counts;
    for (const HandAction& action : result.actions) EXPECT_NE(action.why.find("times the mean"), std::string::npos);
  }
  EXPECT_EQ(counts.labels, kTasks / 2 * 3);
  EXPECT_GT(counts.recall().value(), 0.8);
  EXPECT_GT(counts.precision().value(), 0.95);
}

TEST(GmmAs, TheResultTellsHowItCameAbout) {
  const GmmAsConfig config;
  const GmmAsResult result = detect_by_gmm(synthetic_task(11).trajectory, config).value();
  const std::size_t count = result.gaussians.size();
  ASSERT_GE(count, 3U);
  ASSERT_GE(result.bic.size(), count);
  double least = result.bic.front();
  for (std::size_t k = 0; k < result.bic.size(); ++k) {
    least = std::min(least, result.bic[k]);
    EXPECT_EQ(result.bic[k] > least + config.bic_threshold, k + 1 == result.bic.size());
  }
  EXPECT_EQ(result.bic[count - 1], least);

  std::size_t pois{0};
  for (std::size_t g = 0; g < count; ++g) {
    const SalientGaussian& gaussian = result.gaussians[g];
    EXPECT_GE(gaussian.time_s, result.gaussians[g > 0 ? g - 1 : 0].time_s);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{gaussian.covariance_m2};
    const Eigen::Vector3d sigma = solver.eigenvalues().cwiseSqrt();
    const double saliency = sigma.prod() / std::pow(sigma.sum(), 3) * gaussian.weight * static_cast<double>(count);
    EXPECT_NEAR(gaussian.saliency, saliency, 1e-6 * saliency + 1e-9);
    ASSERT_EQ(gaussian.threshold.has_value(), g > 0 && g + 1 < count);
    if (!gaussian.threshold) continue;
    double sum{0.0};
    int neighbours{0};
    for (const std::ptrdiff_t step : {-2, -1, 1, 2}) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(g) + step;
      if (at < 0 || at >= static_cast<std::ptrdiff_t>(count)) continue;
      sum += result.gaussians[static_cast<std::size_t>(at)].saliency;
      ++neighbours;
    }
    EXPECT_NEAR(*gaussian.threshold, 2.2 * sum / neighbours, 1e-12);
    EXPECT_EQ(gaussian.is_poi, gaussian.saliency > *gaussian.threshold);
    if (!gaussian.is_poi) continue;
    ASSERT_LT(pois, result.actions.size());
    EXPECT_EQ(result.actions[pois].position_m, gaussian.mean_m);
    EXPECT_EQ(result.actions[pois].time_s, gaussian.time_s);
    ++pois;
  }
  EXPECT_EQ(pois, result.actions.size());
  EXPECT_GT(pois, 0U);
}

TEST(GmmAs, ThePrintedFormulaHasAUnit) {
  HandTrajectory task = synthetic_task(2).trajectory;
  const GmmAsResult cubed = detect_by_gmm(task).value();
  const GmmAsResult printed = detect_by_gmm(task, GmmAsConfig::as_printed()).value();
  ASSERT_EQ(cubed.gaussians.size(), printed.gaussians.size());
  for (std::size_t g = 0; g < cubed.gaussians.size(); ++g) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{cubed.gaussians[g].covariance_m2};
    const double sum = solver.eigenvalues().cwiseSqrt().sum();
    EXPECT_NEAR(printed.gaussians[g].saliency, cubed.gaussians[g].saliency * sum * sum, 1e-9);
  }
  EXPECT_EQ(GmmAsConfig::as_printed().poi_threshold, 2.5);
}

/// From the saliencies that the thesis prints come the thresholds that it prints, within one of their sixth decimal.
void expect_thresholds(std::span<const thesis::GaussianSaliency> printed) {
  std::vector<double> saliencies;
  for (const thesis::GaussianSaliency& gaussian : printed) saliencies.push_back(gaussian.saliency);
  const auto means = mean_neighbour_saliencies(saliencies, GmmAsConfig{}.neighbours);
  ASSERT_EQ(means.size(), printed.size());
  for (std::size_t g = 0; g < printed.size(); ++g) {
    ASSERT_EQ(means[g].has_value(), printed[g].threshold.has_value()) << g;
    if (!means[g]) continue;
    const double threshold = thesis::kThresholdFactor * *means[g];
    EXPECT_NEAR(threshold, *printed[g].threshold, 1e-6) << g;
    EXPECT_EQ(saliencies[g] > threshold, printed[g].is_poi) << g;
    EXPECT_EQ(saliencies[g] > GmmAsConfig{}.poi_threshold * *means[g], printed[g].is_poi) << g;
  }
}

TEST(GmmAs, ThresholdsOfTheThesisAreOneAndAHalfTimesItsNeighbours) {
  expect_thresholds(thesis::kTable2_5);
  expect_thresholds(thesis::kTable2_6);
}

TEST(GmmAs, TheFirstAndTheLastGaussianHaveNoThreshold) {
  EXPECT_TRUE(mean_neighbour_saliencies({}, 2).empty());
  EXPECT_EQ(mean_neighbour_saliencies(std::vector{1.0, 2.0}, 2), (std::vector<std::optional<double>>(2)));
  const auto means = mean_neighbour_saliencies(std::vector{1.0, 8.0, 3.0, 5.0}, 1);
  EXPECT_EQ(means, (std::vector<std::optional<double>>{std::nullopt, 2.0, 6.5, std::nullopt}));
  EXPECT_THROW((void)mean_neighbour_saliencies(std::vector{1.0, 2.0, 3.0}, 0), ContractViolation);
}

TEST(GmmAs, TimesDoNotDependOnTheClock) {
  const HandTrajectory task = synthetic_task(6).trajectory;
  HandTrajectory other = task;
  for (HandSample& sample : other) sample.time_s = 1.7e9 + 0.25 * sample.time_s;
  const GmmAsResult here = detect_by_gmm(task).value();
  const GmmAsResult there = detect_by_gmm(other).value();
  ASSERT_EQ(here.actions.size(), there.actions.size());
  ASSERT_FALSE(here.actions.empty());
  for (std::size_t i = 0; i < here.actions.size(); ++i) {
    EXPECT_LT((here.actions[i].position_m - there.actions[i].position_m).norm(), 1e-3);
    EXPECT_NEAR(there.actions[i].time_s, 1.7e9 + 0.25 * here.actions[i].time_s, 1e-2);
  }
}

TEST(GmmAs, LittleOrNothingGivesNoAction) {
  EXPECT_TRUE(detect_by_gmm({}).value().actions.empty());
  HandTrajectory few;
  for (int i = 0; i < 5; ++i) {
    few.push_back({0.01 * i, {0.1 * i, 0.0, 0.0}, std::nullopt});
    const GmmAsResult result = detect_by_gmm(few).value();
    EXPECT_TRUE(result.actions.empty()) << few.size() << " samples";
    EXPECT_FALSE(result.gaussians.empty());
  }
  HandTrajectory still, line;
  for (int i = 0; i < 500; ++i) {
    still.push_back({0.01 * i, {0.3, 0.3, 0.3}, std::nullopt});
    line.push_back({0.01 * i, {0.002 * i, 0.001 * i, 0.0}, std::nullopt});
  }
  EXPECT_TRUE(detect_by_gmm(still).value().actions.empty());
  EXPECT_TRUE(detect_by_gmm(line).value().actions.empty());
}

TEST(GmmAs, BadSamplesAndConfigurationsAreRefused) {
  HandTrajectory task = synthetic_task(1).trajectory;
  GmmAsConfig config;
  config.neighbours = 0;
  EXPECT_FALSE(detect_by_gmm(task, config));
  config = {};
  config.max_gaussians = 0;
  EXPECT_FALSE(detect_by_gmm(task, config));
  config = {};
  config.em.max_iterations = 0;
  EXPECT_FALSE(detect_by_gmm(task, config));
  task[7].position_m.x() = std::nan("");
  const auto result = detect_by_gmm(task);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().context, "sample 7");
}

}  // namespace
}  // namespace saccade
