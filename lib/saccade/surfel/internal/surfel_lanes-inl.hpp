// SPDX-License-Identifier: Apache-2.0
// No include guard of the usual kind: files with vector kernels include this once per instruction set.
//
// Points of surfels in vectors of lanes. Sums follow Eigen's order, x + (y + z), so that scalar code gives equal bits.
#if defined(SACCADE_SURFEL_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SACCADE_SURFEL_LANES_INL
#undef SACCADE_SURFEL_LANES_INL
#else
#define SACCADE_SURFEL_LANES_INL
#endif

#include <Eigen/Core>
#include <cstddef>

#include "saccade/surfel/surfel_association.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kMostLanes{16};
using Tag = hn::CappedTag<float, kMostLanes>;
using V = hn::Vec<Tag>;

HWY_INLINE V set(float value) { return hn::Set(Tag{}, value); }
HWY_INLINE V load(const float* from) { return hn::LoadU(Tag{}, from); }

struct Vector {
  V x, y, z;
};

HWY_INLINE Vector set(const Eigen::Vector3f& p) { return {set(p.x()), set(p.y()), set(p.z())}; }
HWY_INLINE Vector sum(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector difference(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Mul(a.x, b.x), hn::Add(hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)));
}
HWY_INLINE V row_dot(const Eigen::Matrix3f& R, Eigen::Index row, const Vector& p) {
  return dot({set(R(row, 0)), set(R(row, 1)), set(R(row, 2))}, p);
}
HWY_INLINE Vector turned(const Eigen::Matrix3f& R, const Vector& p) {
  return {row_dot(R, 0, p), row_dot(R, 1, p), row_dot(R, 2, p)};
}

/// Returns weighted_mean with `share` = weight_b / (weight_a + weight_b).
HWY_INLINE V mean(V a, V b, V share) { return hn::Add(a, hn::Mul(hn::Sub(b, a), share)); }
HWY_INLINE Vector mean(const Vector& a, const Vector& b, V share) {
  return {mean(a.x, b.x, share), mean(a.y, b.y, share), mean(a.z, b.z, share)};
}

/// Returns `yes` where the mask is true, otherwise `no`.
template <class Mask>
HWY_INLINE Vector choose(Mask mask, const Vector& yes, const Vector& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

HWY_INLINE Vector back_projected(const BackProjection& to_world, V u, V v, V depth_m) {
  const V x = hn::Mul(hn::Sub(u, set(to_world.cx)), set(to_world.inverse_fx));
  const V y = hn::Mul(hn::Sub(v, set(to_world.cy)), set(to_world.inverse_fy));
  return sum(set(to_world.center_world),
             turned(to_world.R_world_camera, {hn::Mul(x, depth_m), hn::Mul(y, depth_m), depth_m}));
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per instruction set
