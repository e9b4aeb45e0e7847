// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/color_kernels.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/tracking/internal/color_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"
#include "saccade/tracking/internal/pair_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

/// Adds the pairs of one vector of pixels, from `lane` on in its block, with rays (ray_x, ray_y, 1).
HWY_INLINE void add_grey(const ColorTask& task, const float* z_from, const float* grey_from, int lane, V ray_x, V ray_y,
                         ColorSums& sums) {
  const PairTag d;
  const PairIndexTag di;
  const V zero = hn::Zero(d);
  const V z = hn::LoadU(d, z_from + lane);
  const V grey = hn::LoadU(d, grey_from + lane);
  const PairPoint p = moved(task.R, task.t, ray_x, ray_y, z);
  const auto& [px, py, pz] = p;

  // The reference's pixel.
  const float level = 1.0F / static_cast<float>(task.measured.stride);
  V inverse_z = hn::Div(set(1.0F), pz);
  V u = hn::Mul(hn::Add(hn::Mul(hn::Mul(px, inverse_z), set(task.fx)), set(task.cx)), set(level));
  V v = hn::Mul(hn::Add(hn::Mul(hn::Mul(py, inverse_z), set(task.fy)), set(task.cy)), set(level));
  const V half = set(0.5F);
  const V u_cell = hn::Add(u, half);
  const V v_cell = hn::Add(v, half);
  auto pair = hn::And(hn::And(hn::Gt(z, zero), hn::Gt(grey, zero)), hn::Gt(pz, set(kMinModelDepth_m)));
  pair = hn::And(pair, hn::And(hn::Ge(u_cell, zero), hn::Lt(u_cell, set(static_cast<float>(task.reference.width)))));
  pair = hn::And(pair, hn::And(hn::Ge(v_cell, zero), hn::Lt(v_cell, set(static_cast<float>(task.reference.height)))));
  if (hn::AllFalse(d, pair)) return;
  const auto column = hn::ConvertTo(di, hn::IfThenElseZero(pair, u_cell));
  const auto row = hn::ConvertTo(di, hn::IfThenElseZero(pair, v_cell));
  const auto index = hn::Add(hn::Mul(row, hn::Set(di, task.reference.width)), column);
  const V qz = hn::GatherIndex(d, task.reference.z, index);
  const V reach = hn::Add(set(kSameSurface_m), hn::Mul(set(kSameSurfaceGrowth), qz));
  pair = hn::And(pair, hn::And(hn::Gt(qz, zero), hn::Le(hn::Abs(hn::Sub(pz, qz)), reach)));
  if (hn::AllFalse(d, pair)) return;

  // Its grey, continued to the point's place, and its slopes in space. Other lanes hold no infinity, whose product with
  // their weight of zero is none.
  inverse_z = hn::IfThenElseZero(pair, inverse_z);
  u = hn::IfThenElseZero(pair, u);
  v = hn::IfThenElseZero(pair, v);
  const V slope_u = hn::GatherIndex(d, task.reference.slope_u, index);
  const V slope_v = hn::GatherIndex(d, task.reference.slope_v, index);
  const V aside = hn::Mul(slope_u, hn::Sub(u, hn::ConvertTo(d, column)));
  const V below = hn::Mul(slope_v, hn::Sub(v, hn::ConvertTo(d, row)));
  const V reference = hn::Add(hn::GatherIndex(d, task.reference.grey, index), hn::Add(aside, below));
  const V r = hn::Sub(reference, hn::Mul(set(task.gain), grey));
  const V gx = hn::Mul(hn::Mul(slope_u, set(task.fx * level)), inverse_z);
  const V gy = hn::Mul(hn::Mul(slope_v, set(task.fy * level)), inverse_z);
  const V gz = hn::Mul(hn::Sub(zero, hn::Add(hn::Mul(gx, px), hn::Mul(gy, py))), inverse_z);

  const V size = hn::Abs(r);
  const V linear_from = hn::Max(set(task.sigma), hn::Mul(size, set(1.0F / kColorHuberSigmas)));
  const V w = hn::IfThenElseZero(pair, hn::Div(set(1e-6F), hn::Mul(set(task.sigma), linear_from)));
  add_pairs(sums.products, lane, w, p, gx, gy, gz, r);
  add_to(sums.reference.data() + lane, hn::IfThenElseZero(pair, reference));
  add_to(sums.measured.data() + lane, hn::IfThenElseZero(pair, grey));
  sums.pairs += hn::CountTrue(d, pair);
  sums.agreeing += hn::CountTrue(d, hn::And(pair, hn::Lt(size, set(kAgreeingSigmas * task.sigma))));
}

void linearize_grey(const ColorTask& task, int begin, int end, ColorSums& sums) {
  const PairTag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const LevelPoints& points = task.measured;
  const V stride = set(static_cast<float>(points.stride));
  std::array<float, kPairLanes> z_tail{};
  std::array<float, kPairLanes> grey_tail{};
  for (int row = begin; row < end; ++row) {
    const V ray_y = set((static_cast<float>(row * points.stride) - task.cy) * task.inverse_fy);
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row) * points.width;
    for (int column = 0; column < points.width; column += kPairLanes) {
      const float* z = points.z + first + column;
      const float* grey = task.measured_grey + first + column;
      const int rest = points.width - column;
      if (rest < kPairLanes) {  // the last columns of a row, padded with pixels without return
        z_tail.fill(0.0F);
        grey_tail.fill(0.0F);
        z = (std::copy_n(z, rest, z_tail.begin()), z_tail.data());
        grey = (std::copy_n(grey, rest, grey_tail.begin()), grey_tail.data());
      }
      for (int lane = 0; lane < kPairLanes; lane += lanes) {
        const V u = hn::Mul(hn::Iota(d, static_cast<float>(column + lane)), stride);
        const V ray_x = hn::Mul(hn::Sub(u, set(task.cx)), set(task.inverse_fx));
        add_grey(task, z, grey, lane, ray_x, ray_y, sums);
      }
    }
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(linearize_grey);

}  // namespace

void linearize_color_rows(const ColorTask& task, int begin, int end, ColorSums& sums) {
  HWY_DYNAMIC_DISPATCH(linearize_grey)(task, begin, end, sums);
}

}  // namespace saccade
#endif  // HWY_ONCE
