// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/internal/shadow_likelihood.hpp"

#include <array>
#include <limits>
#include <utility>

namespace saccade {
namespace {

constexpr std::ptrdiff_t kBackgroundColumns{16};
constexpr std::ptrdiff_t kEdgeColumns{2};  // columns beside an edge that may be mixed
constexpr double kLeastColumns{4.0};
constexpr std::size_t kNone{static_cast<std::size_t>(-1)};

}  // namespace

ShadowLikelihood::ShadowLikelihood(const ShadowDoubtConfig& config, std::vector<double> x)
    : config_{config}, x_{std::move(x)}, inverse_z_(x_.size()), beta_(x_.size()), jumps_(x_.size(), 1) {}

void ShadowLikelihood::classify(const float* z, ShadowState* states) {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    inverse_z_[i] = 1.0 / static_cast<double>(z[i]);
    beta_[i] = x_[i] + config_.baseline_m * inverse_z_[i];
  }
  for (std::size_t i = 1; i < x_.size(); ++i) {
    jumps_[i] = static_cast<std::uint8_t>(is_depth_jump(z[i - 1], z[i], config_.jump_per_m));
  }
  sweep(z, states);
  for (const Group& group : groups_) settle(group, states);
}

/// Runs Algorithm 5 and classifies the points that it removes.
void ShadowLikelihood::sweep(const float* z, ShadowState* states) {
  runs_.clear();
  groups_.clear();
  double max_beta{-std::numeric_limits<double>::infinity()};
  std::size_t farthest = kNone;  // its column
  std::size_t caster = kNone;    // column of the point behind which points were last removed
  bool in_group{false};
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (states[i] == ShadowState::no_return) continue;
    if (beta_[i] <= max_beta) {
      caster = farthest;
      runs_.back().end = farthest;
      states[i] = is_hidden(i) ? ShadowState::in_shadow : ShadowState::suspect;
      if (!in_group) groups_.push_back({i, x_.size(), runs_.back().begin});
      in_group = true;
      continue;
    }
    if (in_group) {
      const bool beyond = z[i] > z[caster] && beta_[i] <= beta_[caster] + margin(caster, i);
      states[i] = beyond ? ShadowState::beyond : ShadowState::clear;
      if (!beyond) groups_.back().end = i;
      in_group = beyond;
    }
    if (farthest == kNone || farthest + 1 != i || jumps_[i] != 0) {
      if (farthest != kNone) runs_.back().end = farthest;
      runs_.push_back({i, i});
    }
    farthest = i;
    max_beta = beta_[i];
  }
}

/// Tells whether a visible surface blocks the light to point i for every position of the emitter within its
/// uncertainty.
bool ShadowLikelihood::is_hidden(std::size_t i) const {
  for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) {
    if (beta_[run->begin] + margin(run->begin, i) > beta_[i]) continue;
    return beta_[i] + margin(run->end, i) <= beta_[run->end];
  }
  return false;
}

/// Returns how far the shadow of one column's point on another may be off, as β.
double ShadowLikelihood::margin(std::size_t caster, std::size_t i) const {
  const double shift = config_.baseline_m * std::max(0.0, inverse_z_[caster] - inverse_z_[i]);
  return config_.baseline_uncertainty * shift + 0.5 * config_.pixel;
}

/// Clears doubtful points on the flat surface to both sides of the shadow and its object, or to one side.
void ShadowLikelihood::settle(const Group& group, ShadowState* states) const {
  const Sums left = background(static_cast<std::ptrdiff_t>(group.caster_begin) - 1 - kEdgeColumns, -1, states);
  const Sums right = background(static_cast<std::ptrdiff_t>(group.end) + kEdgeColumns, 1, states);
  Sums both;
  if (left.n >= kLeastColumns && right.n >= kLeastColumns) {
    both = left;
    both.add(right);
  }
  const std::array surfaces{Line::through(both), Line::through(left), Line::through(right)};
  for (std::size_t i = group.begin; i < group.end; ++i) {
    if (states[i] != ShadowState::suspect && states[i] != ShadowState::beyond) continue;
    const double z = 1.0 / inverse_z_[i];
    const double tolerance = (config_.tolerance_m + config_.tolerance_per_m * z) / (z * z);  // tolerance in 1/z
    const bool on_surface = std::any_of(surfaces.begin(), surfaces.end(), [&](const Line& surface) {
      return surface.holds(x_[i], inverse_z_[i], tolerance);
    });
    if (!on_surface) continue;
    states[i] = states[i] == ShadowState::suspect ? ShadowState::cleared : ShadowState::clear;
  }
}

ShadowLikelihood::Sums ShadowLikelihood::background(std::ptrdiff_t first, std::ptrdiff_t step,
                                                    const ShadowState* states) const {
  Sums sums;
  const auto columns = static_cast<std::ptrdiff_t>(x_.size());
  for (std::ptrdiff_t k = 0; k < kBackgroundColumns; ++k) {
    const std::ptrdiff_t column = first + k * step;
    if (column < 0 || column >= columns) break;
    const auto i = static_cast<std::size_t>(column);
    if (states[i] != ShadowState::clear) break;
    if (k > 0 && jumps_[step > 0 ? i : i + 1] != 0) break;
    sums.add({1.0, x_[i], inverse_z_[i], x_[i] * x_[i], x_[i] * inverse_z_[i], inverse_z_[i] * inverse_z_[i]});
  }
  return sums;
}

void ShadowLikelihood::Sums::add(const Sums& other) {
  n += other.n;
  x += other.x;
  w += other.w;
  xx += other.xx;
  xw += other.xw;
  ww += other.ww;
}

ShadowLikelihood::Line ShadowLikelihood::Line::through(const Sums& sums) {
  Line line;
  if (sums.n < kLeastColumns) return line;
  line.n = sums.n;
  line.x = sums.x / sums.n;
  line.w = sums.w / sums.n;
  line.var_x = sums.xx - sums.x * line.x;
  const double cov = sums.xw - sums.x * line.w;
  line.slope = cov / line.var_x;
  line.spread2 = 4.0 * std::max(0.0, sums.ww - sums.w * line.w - line.slope * cov) / (sums.n - 2.0);
  return line;
}

/// Tests the line: the points form a plane when twice their deviation is within the tolerance, and this is certain when
/// twice its standard error is.
bool ShadowLikelihood::Line::holds(double at_x, double at_w, double tolerance) const {
  if (n < kLeastColumns) return false;
  const double off_x = at_x - x;
  const double uncertainty2 = spread2 * (1.0 / n + off_x * off_x / var_x);
  return std::max(spread2, uncertainty2) <= tolerance * tolerance && std::abs(at_w - w - slope * off_x) <= tolerance;
}

}  // namespace saccade
