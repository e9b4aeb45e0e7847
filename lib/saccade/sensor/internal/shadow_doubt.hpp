// SPDX-License-Identifier: Apache-2.0
#pragma once
// ShadowDoubt: which points of a row the emitter cannot light, and which are in doubt.  docs/depth-filter.md.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace saccade {

struct ShadowDoubtConfig {
  double baseline_m{0.08};            ///< Δ, from the camera to the emitter
  double baseline_uncertainty{0.15};  ///< share of Δ
  double pixel{0.0};                  ///< between columns, at z = 1
  float jump_per_m{0.0F};             ///< neighbours farther apart than this times their depth are two surfaces
  double tolerance_m{0.004};          ///< a point lies on a surface within tolerance_m + tolerance_per_m · z
  double tolerance_per_m{0.004};
};

enum class ShadowVerdict : std::uint8_t {
  no_return,
  clear,      ///< lit
  in_shadow,  ///< a surface that the camera sees is in the light's way
  cleared,    ///< Algorithm 5 removes it, but it lies on the background beside the shadow
  suspect,    ///< Algorithm 5 removes it, and it does not
  beyond,     ///< lit, but not if the baseline is somewhat longer; and it does not lie on the background
};

/// Whether neighbours in an image belong to two surfaces.
[[nodiscard]] inline bool is_depth_jump(float z, float z_next, float jump_per_m) {
  return std::abs(z - z_next) > jump_per_m * std::min(z, z_next);
}

/// Judges one row after the other; keeps its memory between them, nothing else.
class ShadowDoubt {
 public:
  /// x: of the ray through each column at z = 1, ascending; column 0 is at the emitter's side.
  ShadowDoubt(const ShadowDoubtConfig& config, std::vector<double> x);

  /// z: depths of a row, as many as columns; verdicts: no_return where there is none, anything else elsewhere.
  /// O(columns + shadowed columns · runs before them in the row): a fence of many thin things is the worst.
  void judge(const float* z, ShadowVerdict* verdicts);

 private:
  /// Columns next to each other with growing β and without a jump in depth.
  struct Run {
    std::size_t begin;
    std::size_t end;  ///< last column
  };
  /// Columns that are no clear ones, behind the same run.
  struct Group {
    std::size_t begin;
    std::size_t end;  ///< the clear column behind them, or the row's end
    std::size_t caster_begin;
  };
  /// Sums over columns that may be one flat surface, of x and w = 1/z.
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
    /// Whether 1/z = w at x is predicted with certainty, and found.
    [[nodiscard]] bool holds(double at_x, double at_w, double tolerance) const;
  };

  void sweep(const float* z, ShadowVerdict* verdicts);
  void settle(const Group& group, ShadowVerdict* verdicts) const;
  [[nodiscard]] bool is_hidden(std::size_t i) const;
  [[nodiscard]] double margin(std::size_t caster, std::size_t i) const;
  [[nodiscard]] Sums background(std::ptrdiff_t first, std::ptrdiff_t step, const ShadowVerdict* verdicts) const;

  ShadowDoubtConfig config_;
  std::vector<double> x_;
  std::vector<double> inverse_z_;
  std::vector<double> beta_;
  std::vector<std::uint8_t> jumps_;  ///< between a column and that before it
  std::vector<Run> runs_;
  std::vector<Group> groups_;
};

}  // namespace saccade
