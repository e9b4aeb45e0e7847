// SPDX-License-Identifier: Apache-2.0
// Each row beside the definitions of docs/guides/depth-filter.md in plain loops.
#include "saccade/sensor/internal/shadow_likelihood.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <random>

#include "support/depth_rows.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

using States = std::vector<ShadowState>;

/// One row by the definitions: every question is answered anew, by looking at the whole row.
class NaiveRow {
 public:
  NaiveRow(const ShadowDoubtConfig& config, const std::vector<double>& x, const std::vector<float>& z)
      : config_{config}, x_{x}, z_{z} {}

  [[nodiscard]] States states() const {
    States states(columns(), ShadowState::no_return);
    for (int i = 0; i < n(); ++i) {
      if (!is_return(i)) continue;
      if (is_candidate(i)) {
        states[at(i)] = is_hidden(i) ? ShadowState::in_shadow : ShadowState::suspect;
      } else {
        states[at(i)] = is_beyond(i) ? ShadowState::beyond : ShadowState::clear;
      }
    }
    settle(states);
    return states;
  }

 private:
  [[nodiscard]] static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] std::size_t columns() const { return x_.size(); }
  [[nodiscard]] int n() const { return static_cast<int>(x_.size()); }
  [[nodiscard]] bool is_return(int i) const { return z_[at(i)] > 0.0F && std::isfinite(z_[at(i)]); }
  [[nodiscard]] double w(int i) const { return 1.0 / static_cast<double>(z_[at(i)]); }
  [[nodiscard]] double beta(int i) const { return x_[at(i)] + config_.baseline_m * w(i); }
  [[nodiscard]] double margin(int k, int i) const {
    return config_.baseline_uncertainty * (config_.baseline_m * std::max(0.0, w(k) - w(i))) + 0.5 * config_.pixel;
  }
  [[nodiscard]] bool jumps(int i, int k) const {
    const float a = z_[at(i)];
    const float b = z_[at(k)];
    return std::abs(a - b) > config_.jump_per_m * std::min(a, b);
  }
  /// Column of the largest β before i; −1: none.
  [[nodiscard]] int farthest_before(int i) const {
    int farthest = -1;
    for (int k = 0; k < i; ++k) {
      if (is_return(k) && (farthest < 0 || beta(k) > beta(farthest))) farthest = k;
    }
    return farthest;
  }
  [[nodiscard]] bool is_candidate(int i) const {
    const int k = farthest_before(i);
    return is_return(i) && k >= 0 && beta(i) <= beta(k);
  }
  [[nodiscard]] bool is_record(int i) const { return is_return(i) && !is_candidate(i); }
  /// Tells whether columns i and i + 1 are of one run.
  [[nodiscard]] bool is_joined(int i) const { return is_record(i) && is_record(i + 1) && !jumps(i, i + 1); }
  [[nodiscard]] int run_begin(int i) const {
    while (i > 0 && is_joined(i - 1)) --i;
    return i;
  }
  [[nodiscard]] bool is_hidden(int i) const {
    for (int begin = 0; begin < i; ++begin) {
      if (!is_record(begin) || run_begin(begin) != begin) continue;
      int end = begin;
      while (end + 1 < i && is_joined(end)) ++end;
      if (beta(begin) + margin(begin, i) <= beta(i) && beta(i) + margin(end, i) <= beta(end)) return true;
    }
    return false;
  }
  [[nodiscard]] bool is_beyond(int i) const {
    int before = i - 1;
    while (before >= 0 && !is_return(before)) --before;
    if (before < 0 || (!is_candidate(before) && !is_beyond(before))) return false;
    int last = before;
    while (!is_candidate(last)) --last;
    const int caster = farthest_before(last);
    return z_[at(i)] > z_[at(caster)] && beta(i) <= beta(caster) + margin(caster, i);
  }

  [[nodiscard]] std::vector<int> background(int first, int step, const States& states) const {
    std::vector<int> found;
    for (int i = first; i >= 0 && i < n() && found.size() < 16; i += step) {
      if (states[at(i)] != ShadowState::clear) break;
      if (!found.empty() && jumps(i, i - step)) break;
      found.push_back(i);
    }
    return found;
  }
  [[nodiscard]] bool holds(const std::vector<int>& surface, int i) const {
    if (surface.size() < 4) return false;
    const auto rows = static_cast<Eigen::Index>(surface.size());
    Eigen::MatrixXd A(rows, 2);
    Eigen::VectorXd b(rows);
    for (Eigen::Index r = 0; r < rows; ++r) {
      const int k = surface[static_cast<std::size_t>(r)];
      A.row(r) << 1.0, x_[at(k)] - x_[at(i)];
      b[r] = w(k);
    }
    const Eigen::Vector2d line = A.colPivHouseholderQr().solve(b);
    const double spread2 = 4.0 * (A * line - b).squaredNorm() / static_cast<double>(rows - 2);
    const double uncertainty2 = spread2 * (A.transpose() * A).inverse()(0, 0);
    const double z = 1.0 / w(i);
    const double tolerance = (config_.tolerance_m + config_.tolerance_per_m * z) / (z * z);
    return std::max(spread2, uncertainty2) <= tolerance * tolerance && std::abs(w(i) - line[0]) <= tolerance;
  }
  /// Group by group, as surfaces are judged by what earlier groups left clear.
  void settle(States& states) const {
    const auto sweep = states;
    const auto is_clear = [&](int i) { return sweep[at(i)] == ShadowState::clear; };
    for (int begin = 0; begin < n();) {
      if (!is_return(begin) || is_clear(begin)) {
        ++begin;
        continue;
      }
      int end = begin;
      while (end < n() && (!is_return(end) || !is_clear(end))) ++end;
      const std::vector<int> left = background(run_begin(farthest_before(begin)) - 3, -1, states);
      const std::vector<int> right = background(end + 2, 1, states);
      std::vector<int> both = left;
      both.insert(both.end(), right.begin(), right.end());
      if (left.size() < 4 || right.size() < 4) both.clear();
      for (int i = begin; i < end; ++i) {
        const bool doubted = sweep[at(i)] == ShadowState::suspect || sweep[at(i)] == ShadowState::beyond;
        if (!doubted || (!holds(both, i) && !holds(left, i) && !holds(right, i))) continue;
        states[at(i)] = sweep[at(i)] == ShadowState::suspect ? ShadowState::cleared : ShadowState::clear;
      }
      begin = end;
    }
  }

  const ShadowDoubtConfig& config_;
  const std::vector<double>& x_;
  const std::vector<float>& z_;
};

TEST(ShadowLikelihood, IsItsDefinition) {
  constexpr std::size_t kColumns{96};
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> share{0.0, 1.0};
  std::array<std::size_t, 6> seen{};
  const int cases = test::scaled_cases(60);
  for (int n = 0; n < cases; ++n) {
    ShadowDoubtConfig config;
    config.baseline_m = 0.02 + 0.15 * share(random);
    config.baseline_uncertainty = 0.3 * share(random);
    config.pixel = 1.0 / (100.0 + 300.0 * share(random));
    config.jump_per_m = static_cast<float>(config.pixel / std::tan(0.05 + 0.3 * share(random)));
    std::vector<double> x;
    for (std::size_t i = 0; i < kColumns; ++i) x.push_back((static_cast<double>(i) - 48.0) * config.pixel);
    ShadowLikelihood doubt{config, x};
    for (int repeat = 0; repeat < 4; ++repeat) {  // the object keeps its memory
      const std::vector<float> z = test::random_depth_row(kColumns, random);
      States states(kColumns);
      for (std::size_t i = 0; i < kColumns; ++i) {
        states[i] = z[i] > 0.0F && std::isfinite(z[i]) ? ShadowState::clear : ShadowState::no_return;
      }
      doubt.classify(z.data(), states.data());
      const States expected = NaiveRow(config, x, z).states();
      for (std::size_t i = 0; i < kColumns; ++i) {
        ASSERT_EQ(static_cast<int>(states[i]), static_cast<int>(expected[i]))
            << "case " << n << ", row " << repeat << ", column " << i << ", depth " << z[i];
      }
      for (const ShadowState state : states) ++seen.at(static_cast<std::size_t>(state));
    }
  }
  for (const std::size_t count : seen) EXPECT_GT(count, static_cast<std::size_t>(cases));
}

}  // namespace
}  // namespace saccade
