// SPDX-License-Identifier: Apache-2.0
// No include guard of the usual kind: files with vector kernels include this once per instruction set.
//
// Pairs of points in vectors of pixels: points moved into the model's frame, and products of a pair's Jacobian added up
// lane by lane.
#if defined(SACCADE_PAIR_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SACCADE_PAIR_LANES_INL
#undef SACCADE_PAIR_LANES_INL
#else
#define SACCADE_PAIR_LANES_INL
#endif

#include <array>
#include <cstddef>

#include "saccade/tracking/internal/icp_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using PairTag = hn::CappedTag<float, kPairLanes>;
using PairIndexTag = hn::RebindToSigned<PairTag>;
using V = hn::Vec<PairTag>;
using M = hn::Mask<PairTag>;

HWY_INLINE V set(float value) { return hn::Set(PairTag{}, value); }

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

struct PairPoint {
  V x, y, z;
};

/// Moves points of depth z on the rays (ray_x, ray_y, 1) by R (row by row) and t.
HWY_INLINE PairPoint moved(const std::array<float, 9>& R, const std::array<float, 3>& t, V ray_x, V ray_y, V z) {
  const V x = hn::Mul(ray_x, z);
  const V y = hn::Mul(ray_y, z);
  return {hn::Add(dot(set(R[0]), set(R[1]), set(R[2]), x, y, z), set(t[0])),
          hn::Add(dot(set(R[3]), set(R[4]), set(R[5]), x, y, z), set(t[1])),
          hn::Add(dot(set(R[6]), set(R[7]), set(R[8]), x, y, z), set(t[2]))};
}

HWY_INLINE void add_to(float* sum, V value) {
  const PairTag d;
  hn::Store(hn::Add(hn::Load(d, sum), value), d, sum);
}

template <class... Vs>
HWY_INLINE void add_products(float* sums, V factor, Vs... others) {
  ((add_to(sums, hn::Mul(factor, others)), sums += kPairLanes), ...);
}

/// Adds w J_i J_j of the pairs in the lanes from `lane` on, with J = (p × n, n, r).
HWY_INLINE void add_pairs(PairProducts& products, int lane, V w, const PairPoint& p, V nx, V ny, V nz, V r) {
  const V j0 = hn::Sub(hn::Mul(p.y, nz), hn::Mul(p.z, ny));
  const V j1 = hn::Sub(hn::Mul(p.z, nx), hn::Mul(p.x, nz));
  const V j2 = hn::Sub(hn::Mul(p.x, ny), hn::Mul(p.y, nx));
  const auto at = [&products, lane](std::size_t product) HWY_ATTR { return products[product].data() + lane; };
  add_products(at(0), hn::Mul(w, j0), j0, j1, j2, nx, ny, nz, r);
  add_products(at(7), hn::Mul(w, j1), j1, j2, nx, ny, nz, r);
  add_products(at(13), hn::Mul(w, j2), j2, nx, ny, nz, r);
  add_products(at(18), hn::Mul(w, nx), nx, ny, nz, r);
  add_products(at(22), hn::Mul(w, ny), ny, nz, r);
  add_products(at(25), hn::Mul(w, nz), nz, r);
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
