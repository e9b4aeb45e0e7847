// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "saccade/core/result.hpp"

namespace saccade {
namespace {

/// Returns the probability as a function of the angle θ = atan(t/√degrees), which stays bounded where t does not.
double probability_within(double theta, std::size_t degrees) {
  const double sine = std::sin(theta);
  const double cosine = std::cos(theta);
  const bool odd = degrees % 2 == 1;
  // Each term of the series is the one before times cos²θ · k/(k + 1), k = 2, 4, … for odd and 1, 3, … for even
  // degrees.
  double term = odd ? cosine : 1.0;
  double sum = 0.0;
  for (std::size_t k = odd ? 2 : 1; k < degrees; k += 2) {
    sum += term;
    term *= cosine * cosine * static_cast<double>(k) / static_cast<double>(k + 1);
  }
  return odd ? 2.0 / std::numbers::pi * (theta + sine * sum) : sine * sum;
}

/// Returns the ranks 1, 2, …; equal values share their mean rank.
std::vector<double> ranks_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(begin + end + 1);
  }
  return ranks;
}

/// Degrees of freedom up to which the series of probability_within is summed for a quantile.
constexpr std::size_t kMostSummed{1000};

/// Returns where a predicate that holds up to a point ceases to hold.
template <class Holds>
double bisect(double low, double high, const Holds& holds) {
  for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Returns the quantile of Student's t for the quantile z of the normal distribution: the expansion of Abramowitz and
/// Stegun, 26.7.5. What it leaves out falls with the fifth power of the degrees: 1e-12 at 1000 for z up to 3.9.
double student_t_from_normal(double z, double degrees) {
  const double square = z * z;
  const std::array<double, 4> terms{
      (square + 1.0) / 4.0, ((5.0 * square + 16.0) * square + 3.0) / 96.0,
      (((3.0 * square + 19.0) * square + 17.0) * square - 15.0) / 384.0,
      ((((79.0 * square + 776.0) * square + 1482.0) * square - 1920.0) * square - 945.0) / 92160.0};
  double sum = 0.0;
  for (std::size_t i = terms.size(); i-- > 0;) sum = (sum + terms[i]) / degrees;
  return z * (1.0 + sum);
}

}  // namespace

std::optional<double> MeanEstimate::low() const {
  return half_width ? std::optional{mean - *half_width} : std::nullopt;
}

std::optional<double> MeanEstimate::high() const {
  return half_width ? std::optional{mean + *half_width} : std::nullopt;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double mean(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

std::optional<double> rank_correlation(std::span<const double> a, std::span<const double> b) {
  SACCADE_EXPECTS(a.size() == b.size());
  const std::vector<double> ranks_a = ranks_of(a);
  const std::vector<double> ranks_b = ranks_of(b);
  const double middle = 0.5 * static_cast<double>(a.size() + 1);
  double shared = 0.0;
  double spread_a = 0.0;
  double spread_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    shared += (ranks_a[i] - middle) * (ranks_b[i] - middle);
    spread_a += (ranks_a[i] - middle) * (ranks_a[i] - middle);
    spread_b += (ranks_b[i] - middle) * (ranks_b[i] - middle);
  }
  if (spread_a == 0.0 || spread_b == 0.0) return std::nullopt;
  return shared / std::sqrt(spread_a * spread_b);
}

MeanEstimate estimate_mean(std::span<const double> values, double confidence) {
  SACCADE_EXPECTS(std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }));
  MeanEstimate estimate;
  estimate.n = values.size();
  if (values.empty()) return estimate;
  const auto n = static_cast<double>(values.size());
  estimate.mean = mean(values);
  if (values.size() < 2) return estimate;
  double squares = 0.0;
  for (const double value : values) squares += (value - estimate.mean) * (value - estimate.mean);
  estimate.standard_deviation = std::sqrt(squares / (n - 1.0));
  estimate.half_width = student_t_quantile(confidence, values.size() - 1) * *estimate.standard_deviation / std::sqrt(n);
  return estimate;
}

bool are_apart(const MeanEstimate& a, const MeanEstimate& b) {
  if (!a.half_width || !b.half_width) return false;
  return *a.low() > *b.high() || *b.low() > *a.high();
}

double student_t_probability(double t, std::size_t degrees) {
  SACCADE_EXPECTS(t >= 0.0 && degrees >= 1);
  return probability_within(std::atan(t / std::sqrt(static_cast<double>(degrees))), degrees);
}

double student_t_quantile(double confidence, std::size_t degrees) {
  SACCADE_EXPECTS(confidence > 0.0 && confidence < 1.0 && degrees >= 1);
  if (degrees > kMostSummed) {
    const double z = bisect(0.0, 40.0, [&](double t) { return std::erf(t * std::numbers::sqrt2 / 2.0) < confidence; });
    return student_t_from_normal(z, static_cast<double>(degrees));
  }
  const double angle =
      bisect(0.0, std::numbers::pi / 2.0, [&](double t) { return probability_within(t, degrees) < confidence; });
  return std::sqrt(static_cast<double>(degrees)) * std::tan(angle);
}

}  // namespace saccade
