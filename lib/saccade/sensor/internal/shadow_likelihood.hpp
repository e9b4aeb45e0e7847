// SPDX-License-Identifier: Apache-2.0
#pragma once
// ShadowLikelihood: finds points of a row that the emitter cannot light, and doubtful ones.
// docs/guides/depth-filter.md.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace saccade {

struct ShadowDoubtConfig {
  double baseline_m{0.08};            ///< Δ, distance from the camera to the emitter
  double baseline_uncertainty{0.15};  ///< relative to Δ
  double pixel{0.0};                  ///< spacing of columns, at z = 1
  float jump_per_m{0.0F};             ///< neighbours farther apart than this times their depth are two surfaces
  double tolerance_m{0.004};          ///< a point lies on a surface within tolerance_m + tolerance_per_m · z
  double tolerance_per_m{0.004};
};

enum class ShadowState : std::uint8_t {
  no_return,
  clear,      ///< lit
  in_shadow,  ///< a visible surface blocks the light
  cleared,    ///< Algorithm 5 would remove it, but it lies on the background beside the shadow
  suspect,    ///< Algorithm 5 removes it, and it does not lie on the background
  beyond,     ///< lit, but not if the baseline is somewhat longer, and not on the background
};

/// Tells whether neighbours in an image belong to two surfaces.
[[nodiscard]] inline bool is_depth_jump(float z, float z_next, float jump_per_m) {
  return std::abs(z - z_next) > jump_per_m * std::min(z, z_next);
}

/// Classifies one row after the other; keeps only its memory between them.
class ShadowLikelihood {
 public:
  /// x: of the ray through each column at z = 1, ascending. Column 0 is at the emitter's side.
  ShadowLikelihood(const ShadowDoubtConfig& config, std::vector<double> x);

  /// z: depths of a row, one per column. states: no_return where there is no depth; the others are written here.
  /// O(columns + shadowed columns · runs before them in the row): worst for a fence of many thin objects.
  void classify(const float* z, ShadowState* states);

 private:
  /// Adjacent columns with growing β and without a jump in depth.
  struct Run {
    std::size_t begin;
    std::size_t end;  ///< last column
  };
  /// Columns behind one run that are not clear.
  struct Group {
    std::size_t begin;
    std::size_t end;  ///< the clear column behind them, or the row's end
    std::size_t caster_begin;
  };
  /// Sums of x and w = 1/z over columns that may be one flat surface.
  struct Sums {
    double n{0.0}, x{0.0}, w{0.0}, xx{0.0}, xw{0.0}, ww{0.0};
    void add(const Sums& other);
  };
  /// A flat surface: 1/z is linear in x.
  struct Line {
    double n{0.0}, x{0.0}, w{0.0}, slope{0.0};
    double spread2{0.0};  ///< four times the points' variance
    double var_x{0.0};
    static Line through(const Sums& sums);
    /// Tells whether 1/z = w at x is predicted with certainty, and agrees.
    [[nodiscard]] bool holds(double at_x, double at_w, double tolerance) const;
  };

  void sweep(const float* z, ShadowState* states);
  void settle(const Group& group, ShadowState* states) const;
  [[nodiscard]] bool is_hidden(std::size_t i) const;
  [[nodiscard]] double margin(std::size_t caster, std::size_t i) const;
  [[nodiscard]] Sums background(std::ptrdiff_t first, std::ptrdiff_t step, const ShadowState* states) const;

  ShadowDoubtConfig config_;
  std::vector<double> x_;
  std::vector<double> inverse_z_;
  std::vector<double> beta_;
  std::vector<std::uint8_t> jumps_;  ///< jump between each column and the one before
  std::vector<Run> runs_;
  std::vector<Group> groups_;
};

}  // namespace saccade
