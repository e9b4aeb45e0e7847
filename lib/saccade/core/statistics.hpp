// SPDX-License-Identifier: Apache-2.0
#pragma once
// Medians, means and rank correlation; MeanEstimate: a mean and its uncertainty, by Student's t distribution.

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

namespace saccade {

/// Returns the value that would be at `index` if the values were sorted. Reorders them. Expects index < size. O(n).
template <class Range>
[[nodiscard]] auto nth_smallest(Range&& values, std::size_t index) {
  const auto nth = std::next(std::begin(values), static_cast<std::ptrdiff_t>(index));
  std::nth_element(std::begin(values), nth, std::end(values));
  return *nth;
}

/// Returns the middle value, the larger of the two where the number is even. Reorders. Expects a value. O(n).
template <class Range>
[[nodiscard]] auto upper_median(Range&& values) {
  return nth_smallest(values, std::size(values) / 2);
}

/// Returns the middle value, the mean of the two where the number is even; 0 without values.
[[nodiscard]] double median(std::vector<double> values);

/// Returns the mean, summed from the first value to the last; 0 without values.
[[nodiscard]] double mean(std::span<const double> values);

/// Returns Spearman's rank correlation: Pearson's of the ranks, where equal values share their mean rank. Expects
/// equally long `a` and `b` without NaN. nullopt for fewer than two pairs, or where `a` or `b` is constant. O(n log n).
[[nodiscard]] std::optional<double> rank_correlation(std::span<const double> a, std::span<const double> b);

/// Share of repetitions in which an interval holds the true mean.
constexpr double kConfidence{0.95};

struct MeanEstimate {
  std::size_t n{0};
  double mean{0.0};
  std::optional<double> standard_deviation;  ///< sample standard deviation, with n − 1; none for n < 2
  std::optional<double> half_width;          ///< half the width of the mean's confidence interval; none for n < 2

  [[nodiscard]] std::optional<double> low() const;
  [[nodiscard]] std::optional<double> high() const;
};

/// Estimates mean ± t·s/√n, where t is the two-sided quantile for n − 1 degrees of freedom. The values are taken as
/// independent and normally distributed. Expects finite values and a confidence within (0, 1). O(n).
[[nodiscard]] MeanEstimate estimate_mean(std::span<const double> values, double confidence = kConfidence);

/// Tells whether both intervals exist and have no point in common.
[[nodiscard]] bool are_apart(const MeanEstimate& a, const MeanEstimate& b);

/// Returns the probability that a variable of Student's t distribution lies within ±t. Uses the finite series for whole
/// degrees of freedom (Abramowitz and Stegun, 26.7.3 and 26.7.4). Expects t ≥ 0 and degrees ≥ 1. O(degrees).
[[nodiscard]] double student_t_probability(double t, std::size_t degrees);

/// Returns the t ≥ 0 for which student_t_probability equals `confidence`: by bisection up to 1000 degrees, from the
/// normal distribution beyond (Abramowitz and Stegun, 26.7.5), in constant time. Exact to about 1e-12 of t for a
/// confidence up to 0.9999. Expects a confidence within (0, 1) and degrees ≥ 1.
[[nodiscard]] double student_t_quantile(double confidence, std::size_t degrees);

}  // namespace saccade
