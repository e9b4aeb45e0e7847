// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/color_kernels.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/tracking/internal/color_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using GreyTag = hn::CappedTag<float, kPairLanes>;
using GreyIndexTag = hn::RebindToSigned<GreyTag>;
using GreyV = hn::Vec<GreyTag>;

HWY_INLINE GreyV all(float value) { return hn::Set(GreyTag{}, value); }

HWY_INLINE GreyV dot3(GreyV ax, GreyV ay, GreyV az, GreyV bx, GreyV by, GreyV bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

HWY_INLINE void add_value(float* sum, GreyV value) {
  const GreyTag d;
  hn::Store(hn::Add(hn::Load(d, sum), value), d, sum);
}

template <class... Vs>
HWY_INLINE void add_weighted(float* sums, GreyV factor, Vs... others) {
  ((add_value(sums, hn::Mul(factor, others)), sums += kPairLanes), ...);
}

/// Adds the pairs of one vector of pixels, from `lane` on in its block, with rays (ray_x, ray_y, 1).
HWY_INLINE void add_grey(const ColorTask& task, const float* z_from, const float* grey_from, int lane, GreyV ray_x,
                         GreyV ray_y, ColorSums& sums) {
  const GreyTag d;
  const GreyIndexTag di;
  const GreyV zero = hn::Zero(d);
  const GreyV z = hn::LoadU(d, z_from + lane);
  const GreyV grey = hn::LoadU(d, grey_from + lane);
  const GreyV x_camera = hn::Mul(ray_x, z);
  const GreyV y_camera = hn::Mul(ray_y, z);
  const std::array<float, 9>& R = task.R;
  const GreyV px = hn::Add(dot3(all(R[0]), all(R[1]), all(R[2]), x_camera, y_camera, z), all(task.t[0]));
  const GreyV py = hn::Add(dot3(all(R[3]), all(R[4]), all(R[5]), x_camera, y_camera, z), all(task.t[1]));
  const GreyV pz = hn::Add(dot3(all(R[6]), all(R[7]), all(R[8]), x_camera, y_camera, z), all(task.t[2]));

  // The reference's pixel.
  const float level = 1.0F / static_cast<float>(task.measured.stride);
  GreyV inverse_z = hn::Div(all(1.0F), pz);
  GreyV u = hn::Mul(hn::Add(hn::Mul(hn::Mul(px, inverse_z), all(task.fx)), all(task.cx)), all(level));
  GreyV v = hn::Mul(hn::Add(hn::Mul(hn::Mul(py, inverse_z), all(task.fy)), all(task.cy)), all(level));
  const GreyV half = all(0.5F);
  const GreyV u_cell = hn::Add(u, half);
  const GreyV v_cell = hn::Add(v, half);
  auto pair = hn::And(hn::And(hn::Gt(z, zero), hn::Gt(grey, zero)), hn::Gt(pz, all(kMinModelDepth_m)));
  pair = hn::And(pair, hn::And(hn::Ge(u_cell, zero), hn::Lt(u_cell, all(static_cast<float>(task.reference.width)))));
  pair = hn::And(pair, hn::And(hn::Ge(v_cell, zero), hn::Lt(v_cell, all(static_cast<float>(task.reference.height)))));
  if (hn::AllFalse(d, pair)) return;
  const auto column = hn::ConvertTo(di, hn::IfThenElseZero(pair, u_cell));
  const auto row = hn::ConvertTo(di, hn::IfThenElseZero(pair, v_cell));
  const auto index = hn::Add(hn::Mul(row, hn::Set(di, task.reference.width)), column);
  const GreyV qz = hn::GatherIndex(d, task.reference.z, index);
  const GreyV reach = hn::Add(all(kSameSurface_m), hn::Mul(all(kSameSurfaceGrowth), qz));
  pair = hn::And(pair, hn::And(hn::Gt(qz, zero), hn::Le(hn::Abs(hn::Sub(pz, qz)), reach)));
  if (hn::AllFalse(d, pair)) return;

  // Its grey, continued to the point's place, and its slopes in space. Other lanes hold no infinity, whose product with
  // their weight of zero is none.
  inverse_z = hn::IfThenElseZero(pair, inverse_z);
  u = hn::IfThenElseZero(pair, u);
  v = hn::IfThenElseZero(pair, v);
  const GreyV slope_u = hn::GatherIndex(d, task.reference.slope_u, index);
  const GreyV slope_v = hn::GatherIndex(d, task.reference.slope_v, index);
  const GreyV aside = hn::Mul(slope_u, hn::Sub(u, hn::ConvertTo(d, column)));
  const GreyV below = hn::Mul(slope_v, hn::Sub(v, hn::ConvertTo(d, row)));
  const GreyV reference = hn::Add(hn::GatherIndex(d, task.reference.grey, index), hn::Add(aside, below));
  const GreyV r = hn::Sub(reference, hn::Mul(all(task.gain), grey));
  const GreyV gx = hn::Mul(hn::Mul(slope_u, all(task.fx * level)), inverse_z);
  const GreyV gy = hn::Mul(hn::Mul(slope_v, all(task.fy * level)), inverse_z);
  const GreyV gz = hn::Mul(hn::Sub(zero, hn::Add(hn::Mul(gx, px), hn::Mul(gy, py))), inverse_z);

  const GreyV size = hn::Abs(r);
  const GreyV linear_from = hn::Max(all(task.sigma), hn::Mul(size, all(1.0F / kColorHuberSigmas)));
  const GreyV w = hn::IfThenElseZero(pair, hn::Div(all(1e-6F), hn::Mul(all(task.sigma), linear_from)));
  const GreyV j0 = hn::Sub(hn::Mul(py, gz), hn::Mul(pz, gy));
  const GreyV j1 = hn::Sub(hn::Mul(pz, gx), hn::Mul(px, gz));
  const GreyV j2 = hn::Sub(hn::Mul(px, gy), hn::Mul(py, gx));
  const auto at = [&sums, lane](std::size_t product) HWY_ATTR { return sums.products[product].data() + lane; };
  add_weighted(at(0), hn::Mul(w, j0), j0, j1, j2, gx, gy, gz, r);
  add_weighted(at(7), hn::Mul(w, j1), j1, j2, gx, gy, gz, r);
  add_weighted(at(13), hn::Mul(w, j2), j2, gx, gy, gz, r);
  add_weighted(at(18), hn::Mul(w, gx), gx, gy, gz, r);
  add_weighted(at(22), hn::Mul(w, gy), gy, gz, r);
  add_weighted(at(25), hn::Mul(w, gz), gz, r);
  add_value(sums.reference.data() + lane, hn::IfThenElseZero(pair, reference));
  add_value(sums.measured.data() + lane, hn::IfThenElseZero(pair, grey));
  sums.pairs += hn::CountTrue(d, pair);
  sums.agreeing += hn::CountTrue(d, hn::And(pair, hn::Lt(size, all(kAgreeingSigmas * task.sigma))));
}

void linearize_grey(const ColorTask& task, int begin, int end, ColorSums& sums) {
  const GreyTag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const LevelPoints& points = task.measured;
  const GreyV stride = all(static_cast<float>(points.stride));
  std::array<float, kPairLanes> z_tail{};
  std::array<float, kPairLanes> grey_tail{};
  for (int row = begin; row < end; ++row) {
    const GreyV ray_y = all((static_cast<float>(row * points.stride) - task.cy) * task.inverse_fy);
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
        const GreyV u = hn::Mul(hn::Iota(d, static_cast<float>(column + lane)), stride);
        const GreyV ray_x = hn::Mul(hn::Sub(u, all(task.cx)), all(task.inverse_fx));
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
