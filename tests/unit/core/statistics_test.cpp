// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {
namespace {

TEST(Statistics, MediansAndMeans) {
  EXPECT_EQ(median({}), 0.0);
  EXPECT_EQ(median({7.0}), 7.0);
  EXPECT_EQ(median({9.0, 1.0, 4.0}), 4.0);
  EXPECT_EQ(median({9.0, 1.0, 4.0, 2.0}), 3.0);
  EXPECT_EQ(upper_median(std::vector<int>{9, 1, 4, 2}), 4);
  EXPECT_EQ(upper_median(std::vector<int>{3}), 3);
  EXPECT_EQ(nth_smallest(std::vector<float>{9.0F, 1.0F, 4.0F, 2.0F}, 1), 2.0F);
  EXPECT_EQ(mean(std::vector<double>{}), 0.0);
  EXPECT_EQ(mean(std::vector<double>{1.0, 2.0, 6.0}), 3.0);
}

TEST(Statistics, TheQuantilesAreThoseOfThePrintedTables) {
  struct Row {
    std::size_t degrees;
    double at_95;  // two-sided
    double at_99;
  };
  constexpr std::array<Row, 12> kTable{{{1, 12.7062, 63.6567},
                                        {2, 4.30265, 9.92484},
                                        {3, 3.18245, 5.84091},
                                        {4, 2.77645, 4.60409},
                                        {5, 2.57058, 4.03214},
                                        {7, 2.36462, 3.49948},
                                        {9, 2.26216, 3.24984},
                                        {10, 2.22814, 3.16927},
                                        {19, 2.09302, 2.86093},
                                        {30, 2.04227, 2.75000},
                                        {120, 1.97993, 2.61742},
                                        {1000000, 1.95996, 2.57583}}};
  for (const Row& row : kTable) {
    EXPECT_NEAR(student_t_quantile(0.95, row.degrees), row.at_95, 6e-6 * row.at_95) << row.degrees;
    EXPECT_NEAR(student_t_quantile(0.99, row.degrees), row.at_99, 6e-6 * row.at_99) << row.degrees;
  }
}

TEST(Statistics, TheProbabilityIsTheIntegralOfTheDensity) {
  int cases = 0;
  for (const std::size_t degrees : {1U, 2U, 3U, 6U, 11U, 40U}) {
    const auto nu = static_cast<double>(degrees);
    const auto density = [nu](double x) { return std::pow(1.0 + x * x / nu, -0.5 * (nu + 1.0)); };
    const double scale = std::tgamma(0.5 * (nu + 1.0)) / (std::sqrt(nu * std::acos(-1.0)) * std::tgamma(0.5 * nu));
    for (const double t : {0.0, 0.3, 1.0, 2.5, 6.0}) {
      constexpr int kSteps{4000};  // Simpson's rule
      double sum = density(0.0) + density(t);
      for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * density(t * i / kSteps);
      EXPECT_NEAR(student_t_probability(t, degrees), 2.0 * scale * sum * t / kSteps / 3.0, 1e-11)
          << degrees << ' ' << t;
      ++cases;
    }
    for (const double confidence : {0.05, 0.5, 0.95, 0.9999})
      EXPECT_NEAR(student_t_probability(student_t_quantile(confidence, degrees), degrees), confidence, 1e-13);
  }
  EXPECT_EQ(cases, 30);
}

TEST(Statistics, QuantilesOfManyDegreesAreThoseOfTheSeries) {
  for (const std::size_t degrees : {1000U, 1001U, 1002U, 5001U, 60000U}) {
    for (const double confidence : {0.05, 0.5, 0.95, 0.9999})
      EXPECT_NEAR(student_t_probability(student_t_quantile(confidence, degrees), degrees), confidence, 1e-12)
          << degrees << ' ' << confidence;
  }
}

TEST(Statistics, MeanAndIntervalOfAFewValues) {
  const MeanEstimate estimate = estimate_mean(std::vector<double>{2.0, 4.0, 4.0, 6.0});
  EXPECT_EQ(estimate.n, 4U);
  EXPECT_EQ(estimate.mean, 4.0);
  EXPECT_NEAR(estimate.standard_deviation.value(), std::sqrt(8.0 / 3.0), 1e-15);
  EXPECT_NEAR(estimate.half_width.value(), 3.182446305284263 * std::sqrt(8.0 / 3.0) / 2.0, 1e-12);
  EXPECT_EQ(estimate.low().value(), 4.0 - estimate.half_width.value());
  EXPECT_EQ(estimate.high().value(), 4.0 + estimate.half_width.value());
  EXPECT_EQ(estimate_mean(std::vector<double>{0.25, 0.25, 0.25}).half_width.value(), 0.0);
}

TEST(Statistics, OneValueHasNoInterval) {
  const MeanEstimate one = estimate_mean(std::vector<double>{0.7});
  EXPECT_EQ(one.mean, 0.7);
  EXPECT_FALSE(one.standard_deviation || one.half_width || one.low() || one.high());
  EXPECT_EQ(estimate_mean({}).n, 0U);
  EXPECT_THROW(static_cast<void>(estimate_mean(std::vector<double>{1.0, std::nan("")})), ContractViolation);
}

TEST(Statistics, TheIntervalHoldsTheTrueMeanAsOftenAsItSays) {
  constexpr std::uint64_t kSeed{20240611};
  constexpr int kRepetitions{20000};
  std::mt19937_64 random{kSeed};
  std::normal_distribution<double> normal{3.0, 2.0};
  int held = 0;
  for (int i = 0; i < kRepetitions; ++i) {
    std::array<double, 4> sample{};
    for (double& value : sample) value = normal(random);
    const MeanEstimate estimate = estimate_mean(sample);
    held += *estimate.low() <= 3.0 && 3.0 <= *estimate.high() ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(held) / kRepetitions, 0.95, 0.006) << "seed " << kSeed;  // four standard errors
}

TEST(Statistics, RankCorrelationHeedsTheOrderAlone) {
  using Values = std::vector<double>;
  EXPECT_DOUBLE_EQ(rank_correlation(Values{1, 2, 3, 4}, Values{1, 10, 100, 1e6}).value(), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation(Values{1, 2, 3, 4}, Values{9, 5, 4, -1}).value(), -1.0);
  // 1 − 6 Σd²/(n(n² − 1)) with d = 0, 1, −1, 1, −1.
  EXPECT_DOUBLE_EQ(rank_correlation(Values{10, 20, 30, 40, 50}, Values{1, 3, 2, 5, 4}).value(), 1.0 - 24.0 / 120.0);
  // Ties share their mean rank: 1.5, 1.5, 3 against 1, 2, 3.
  EXPECT_DOUBLE_EQ(rank_correlation(Values{7, 7, 8}, Values{1, 2, 3}).value(), 1.5 / std::sqrt(1.5 * 2.0));
  EXPECT_FALSE(rank_correlation(Values{}, Values{}) || rank_correlation(Values{1}, Values{1}));
  EXPECT_FALSE(rank_correlation(Values{1, 1}, Values{1, 2}));
}

TEST(Statistics, IntervalsAreApartOrNot) {
  const MeanEstimate low = estimate_mean(std::vector<double>{0.0, 0.1, 0.2});
  const MeanEstimate near = estimate_mean(std::vector<double>{0.3, 0.4, 0.5});
  const MeanEstimate far = estimate_mean(std::vector<double>{1.0, 1.1, 1.2});
  EXPECT_TRUE(are_apart(low, far) && are_apart(far, low));
  EXPECT_FALSE(are_apart(low, near) || are_apart(near, low));
  EXPECT_FALSE(are_apart(low, estimate_mean(std::vector<double>{9.0})));
}

}  // namespace
}  // namespace saccade
