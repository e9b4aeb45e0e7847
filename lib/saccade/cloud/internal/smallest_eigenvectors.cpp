// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/internal/smallest_eigenvectors.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/cloud/internal/smallest_eigenvectors.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, Covariances::kCount>;
using FloatTag = hn::Rebind<float, Tag>;
using V = hn::Vec<Tag>;
using M = hn::Mask<Tag>;

struct Vector {
  V x, y, z;
};

HWY_INLINE V set(double value) { return hn::Set(Tag{}, value); }

HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE V squared_norm(const Vector& a) {
  return hn::Add(hn::Add(hn::Mul(a.x, a.x), hn::Mul(a.y, a.y)), hn::Mul(a.z, a.z));
}

HWY_INLINE Vector select(M mask, const Vector& a, const Vector& b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y), hn::IfThenElse(mask, a.z, b.z)};
}

HWY_INLINE Vector longest(const Vector& a, const Vector& b, const Vector& c) {
  const Vector longer = select(hn::Gt(squared_norm(b), squared_norm(a)), b, a);
  return select(hn::Gt(squared_norm(c), squared_norm(longer)), c, longer);
}

struct Symmetric {
  V xx, xy, xz, yy, yz, zz;
};

HWY_INLINE V minor_of(V a, V b, V off) { return hn::Sub(hn::Mul(a, b), hn::Mul(off, off)); }

/// Returns the smallest eigenvalue of a covariance of trace 1: the smallest root of its characteristic polynomial.
/// Newton's method approaches it from 0 without overshooting, as the polynomial rises and is concave there.
HWY_INLINE V least_eigenvalue(const Symmetric& c) {
  constexpr int kSteps{20};
  const Tag d;
  const V determinant = hn::Sub(hn::Add(hn::Mul(c.xx, minor_of(c.yy, c.zz, c.yz)),
                                        hn::Mul(c.xz, hn::Sub(hn::Mul(c.xy, c.yz), hn::Mul(c.yy, c.xz)))),
                                hn::Mul(c.xy, hn::Sub(hn::Mul(c.xy, c.zz), hn::Mul(c.yz, c.xz))));
  const V minors = hn::Add(hn::Add(minor_of(c.xx, c.yy, c.xy), minor_of(c.xx, c.zz, c.xz)), minor_of(c.yy, c.zz, c.yz));
  V root = hn::Zero(d);
  for (int i = 0; i < kSteps; ++i) {
    const V slope = hn::Add(hn::Mul(hn::Sub(hn::Mul(set(3.0), root), set(2.0)), root), minors);
    const V value = hn::Sub(hn::Mul(hn::Add(hn::Mul(hn::Sub(root, set(1.0)), root), minors), root), determinant);
    const M on = hn::And(hn::Gt(slope, hn::Zero(d)), hn::Le(value, hn::Mul(set(-1e-12), slope)));
    if (hn::AllFalse(d, on)) break;
    root = hn::Sub(root, hn::IfThenElseZero(on, hn::Div(value, slope)));
  }
  return root;
}

/// Returns the direction perpendicular to the rows of a symmetric matrix of rank 2, or to the largest row for rank 1.
HWY_INLINE Vector perpendicular_to_rows(const Symmetric& m) {
  const Tag d;
  const V parallel = set(1e-20);  // squared
  const Vector a{m.xx, m.xy, m.xz};
  const Vector b{m.xy, m.yy, m.yz};
  const Vector c{m.xz, m.yz, m.zz};
  Vector found = longest(cross(a, b), cross(b, c), cross(c, a));
  const M parallel_rows = hn::Not(hn::Gt(squared_norm(found), parallel));
  if (!hn::AllFalse(d, parallel_rows)) {
    const Vector row = longest(a, b, c);
    const V zero = hn::Zero(d);
    const M along_z = hn::Gt(hn::Abs(row.z), hn::Max(hn::Abs(row.x), hn::Abs(row.y)));
    const Vector beside = select(along_z, {zero, row.z, hn::Neg(row.y)}, {row.y, hn::Neg(row.x), zero});
    found = select(parallel_rows, beside, found);
  }
  const V squared = squared_norm(found);
  const V norm = hn::Sqrt(squared);
  const M any = hn::Gt(squared, parallel);  // otherwise equal in all directions
  const V scale = hn::IfThenElseZero(any, hn::Div(set(1.0), norm));
  return {hn::Mul(found.x, scale), hn::Mul(found.y, scale), hn::Mul(found.z, scale)};
}

void least_directions_kernel(const Covariances& covariances, Directions& directions) {
  const Tag d;
  const FloatTag df;
  for (std::size_t lane = 0; lane < Covariances::kCount; lane += hn::Lanes(d)) {
    const auto entry = [&](std::size_t i)
                           HWY_ATTR { return hn::PromoteTo(d, hn::Load(df, covariances.entries[i].data() + lane)); };
    Symmetric c{entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)};
    const V trace = hn::Add(hn::Add(c.xx, c.yy), c.zz);
    const V all = hn::Add(hn::Add(trace, c.xy), hn::Add(c.xz, c.yz));
    const M usable = hn::And(hn::Gt(trace, hn::Zero(d)), hn::Eq(hn::Sub(all, all), hn::Zero(d)));
    const V scale = hn::IfThenElseZero(usable, hn::Div(set(1.0), trace));
    const auto scaled = [&](V value) HWY_ATTR { return hn::IfThenElseZero(usable, hn::Mul(value, scale)); };
    c = {scaled(c.xx), scaled(c.xy), scaled(c.xz), scaled(c.yy), scaled(c.yz), scaled(c.zz)};
    const V least = least_eigenvalue(c);
    c.xx = hn::Sub(c.xx, least);
    c.yy = hn::Sub(c.yy, least);
    c.zz = hn::Sub(c.zz, least);
    const Vector found = perpendicular_to_rows(c);
    hn::Store(hn::DemoteTo(df, found.x), df, directions.xyz[0].data() + lane);
    hn::Store(hn::DemoteTo(df, found.y), df, directions.xyz[1].data() + lane);
    hn::Store(hn::DemoteTo(df, found.z), df, directions.xyz[2].data() + lane);
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(least_directions_kernel);

}  // namespace

Directions smallest_eigenvectors(const Covariances& covariances) {
  Directions directions;
  HWY_DYNAMIC_DISPATCH(least_directions_kernel)(covariances, directions);
  return directions;
}

}  // namespace saccade
#endif  // HWY_ONCE
