// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/octant_views.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/map/internal/octant_views.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::fusion::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Slack of the conservative tests: far above the rounding of the per-voxel floats, far below a voxel.
constexpr float kSlackM{1e-4F};
constexpr float kSlackPx{0.6F};  // rounding to the nearest pixel, with some margin
constexpr float kNearestProjected{0.02F};

float dot(const tsdf::Float3& a, const tsdf::Float3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Returns lane i of the mask as bit i.
template <class D>
HWY_INLINE unsigned bits_of(D d, hn::Mask<D> mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  return bytes[0] & ((1U << hn::Lanes(d)) - 1U);
}

void view_octants_kernel(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, int edge, OctantViews& out) {
  const hn::CappedTag<float, kOctants> d;
  const hn::RebindToSigned<decltype(d)> di;
  using Vec = hn::Vec<decltype(d)>;
  const auto set = [&](float x) HWY_ATTR { return hn::Set(d, x); };
  alignas(32) constexpr std::array<std::array<float, kOctants>, 3> kUpper{
      {{0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}}};
  const float octant_edge = 0.5F * static_cast<float>(edge);
  const float half_vox = 0.5F * (octant_edge - 1.0F);  // half the box of voxel centres
  const std::array<tsdf::Float3, 3> steps{frame.step_x, frame.step_y, frame.step_z};
  const float voxel_m = std::sqrt(dot(frame.step_x, frame.step_x));
  const Vec zero = hn::Zero(d);
  const Vec half_m = set(half_vox * voxel_m);
  const Vec inv_voxel = set(1.0F / voxel_m);
  const float half_z = half_vox * (std::abs(steps[0].z) + std::abs(steps[1].z) + std::abs(steps[2].z));
  const auto u_end = static_cast<float>(camera.width - 1);
  const auto v_end = static_cast<float>(camera.height - 1);
  const Vec last_u = set(u_end);
  const Vec last_v = set(v_end);
  // The four sides of the frustum as planes a x + b y + c z = 0 through the camera, positive inside. They also hold
  // near the camera's plane, where projection is impossible.
  const std::array<tsdf::Float3, 4> sides{{{camera.fx, 0.0F, camera.cx + kSlackPx},
                                           {-camera.fx, 0.0F, u_end + kSlackPx - camera.cx},
                                           {0.0F, camera.fy, camera.cy + kSlackPx},
                                           {0.0F, -camera.fy, v_end + kSlackPx - camera.cy}}};
  std::array<float, 4> side_spread;  // spread of half an octant, plus the slack
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const float spread_vox =
        std::abs(dot(sides[i], steps[0])) + std::abs(dot(sides[i], steps[1])) + std::abs(dot(sides[i], steps[2]));
    side_spread[i] = half_vox * spread_vox + kSlackM * std::max(camera.fx, camera.fy);
  }
  unsigned hidden{0};
  unsigned near{0};
  unsigned inside{0};
  for (std::size_t first = 0; first < kOctants; first += hn::Lanes(d)) {
    Vec x = set(frame.origin.x);
    Vec y = set(frame.origin.y);
    Vec z = set(frame.origin.z);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Vec vox = hn::Add(set(half_vox), hn::Mul(set(octant_edge), hn::Load(d, kUpper[axis].data() + first)));
      x = hn::Add(x, hn::Mul(set(steps[axis].x), vox));
      y = hn::Add(y, hn::Mul(set(steps[axis].y), vox));
      z = hn::Add(z, hn::Mul(set(steps[axis].z), vox));
    }
    // A corner (dx, dy, dz) from the centre lies f (dx − dz x/z) / (z + dz) from its pixel.
    const Vec inv_z = hn::Div(set(1.0F), z);
    const Vec nearest_z = hn::Sub(z, set(half_z));
    const Vec scale = hn::Div(set(half_vox), nearest_z);
    const Vec slope_x = hn::Mul(x, inv_z);
    const Vec slope_y = hn::Mul(y, inv_z);
    Vec spread_x = zero;
    Vec spread_y = zero;
    Vec nearest_squared = zero;
    Vec farthest_squared = zero;
    for (const tsdf::Float3& step : steps) {
      const Vec step_z = set(step.z);
      spread_x = hn::Add(spread_x, hn::Abs(hn::Sub(set(step.x), hn::Mul(step_z, slope_x))));
      spread_y = hn::Add(spread_y, hn::Abs(hn::Sub(set(step.y), hn::Mul(step_z, slope_y))));
      const Vec along = hn::Add(hn::Add(hn::Mul(x, set(step.x)), hn::Mul(y, set(step.y))), hn::Mul(z, step_z));
      const Vec offset = hn::Abs(hn::Mul(along, inv_voxel));
      const Vec least = hn::Max(hn::Sub(offset, half_m), zero);
      const Vec greatest = hn::Add(offset, half_m);
      nearest_squared = hn::Add(nearest_squared, hn::Mul(least, least));
      farthest_squared = hn::Add(farthest_squared, hn::Mul(greatest, greatest));
    }
    hn::StoreU(hn::Sub(hn::Sqrt(nearest_squared), set(kSlackM)), d, out.nearest_m.data() + first);
    hn::StoreU(hn::Add(hn::Sqrt(farthest_squared), set(kSlackM)), d, out.farthest_m.data() + first);

    const Vec u = hn::Add(hn::Mul(set(camera.fx), slope_x), set(camera.cx));
    const Vec v = hn::Add(hn::Mul(set(camera.fy), slope_y), set(camera.cy));
    const Vec u_radius = hn::Add(hn::Mul(set(camera.fx), hn::Mul(spread_x, scale)), set(kSlackPx));
    const Vec v_radius = hn::Add(hn::Mul(set(camera.fy), hn::Mul(spread_y, scale)), set(kSlackPx));
    const Vec u_min = hn::Sub(u, u_radius);
    const Vec v_min = hn::Sub(v, v_radius);
    const Vec u_max = hn::Add(u, u_radius);
    const Vec v_max = hn::Add(v, v_radius);
    const auto pixel = [&](Vec p) HWY_ATTR { return hn::ConvertTo(di, p); };
    const auto is_near = hn::Lt(nearest_z, set(kNearestProjected));
    auto outside = hn::Lt(hn::Add(z, set(half_z)), zero);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Vec across =
          hn::Add(hn::Add(hn::Mul(x, set(sides[i].x)), hn::Mul(y, set(sides[i].y))), hn::Mul(z, set(sides[i].z)));
      outside = hn::Or(outside, hn::Lt(across, set(-side_spread[i])));
    }
    const auto clamped = [&](Vec p, Vec last) HWY_ATTR {
      return hn::IfThenZeroElse(hn::Or(is_near, outside), hn::Min(hn::Max(p, zero), last));
    };
    hn::StoreU(pixel(clamped(u_min, last_u)), di, out.u0.data() + first);
    hn::StoreU(pixel(clamped(v_min, last_v)), di, out.v0.data() + first);
    hn::StoreU(pixel(hn::Ceil(clamped(u_max, last_u))), di, out.u1.data() + first);
    hn::StoreU(pixel(hn::Ceil(clamped(v_max, last_v))), di, out.v1.data() + first);

    const auto whole = hn::And(hn::And(hn::Ge(u_min, zero), hn::Le(u_max, last_u)),
                               hn::And(hn::Ge(v_min, zero), hn::Le(v_max, last_v)));
    hidden |= bits_of(d, outside) << first;
    near |= bits_of(d, is_near) << first;
    inside |= bits_of(d, hn::AndNot(is_near, whole)) << first;
  }
  out.hidden = static_cast<OctantMask>(hidden);
  out.near = static_cast<OctantMask>(near);
  out.inside = static_cast<OctantMask>(inside);
}

}  // namespace
}  // namespace saccade::fusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade::fusion {
namespace {

HWY_EXPORT(view_octants_kernel);

}  // namespace

void view_octants(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, int edge, OctantViews& out) {
  HWY_DYNAMIC_DISPATCH(view_octants_kernel)(camera, frame, edge, out);
}

}  // namespace saccade::fusion
#endif  // HWY_ONCE
