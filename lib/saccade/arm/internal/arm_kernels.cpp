// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/arm_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/arm/internal/arm_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::arm::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kBlock>;
using FloatVec = hn::Vec<Floats>;

void chain_kernel(std::span<const JointTerms> joints, const float* cosines, const float* sines, Frame* frames) {
  const hn::FixedTag<float, 4> d;
  using Vec = hn::Vec<hn::FixedTag<float, 4>>;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto& [fixed, by_cosine, by_sine] = joints[i];
    const Frame& before = frames[i];
    Frame& behind = frames[i + 1];
    const Vec x = hn::LoadU(d, before.data());
    const Vec y = hn::LoadU(d, before.data() + 4);
    const Vec z = hn::LoadU(d, before.data() + 8);
    const Vec origin = hn::LoadU(d, before.data() + 12);
    for (std::size_t column = 0; column < 16; column += 4) {
      const Vec turned = hn::Add(hn::Mul(hn::Set(d, cosines[i]), hn::LoadU(d, by_cosine.data() + column)),
                                 hn::Mul(hn::Set(d, sines[i]), hn::LoadU(d, by_sine.data() + column)));
      const Vec local = hn::Add(hn::LoadU(d, fixed.data() + column), turned);
      const Vec xy = hn::Add(hn::Mul(x, hn::Broadcast<0>(local)), hn::Mul(y, hn::Broadcast<1>(local)));
      const Vec zt = hn::Add(hn::Mul(z, hn::Broadcast<2>(local)), hn::Mul(origin, hn::Broadcast<3>(local)));
      hn::StoreU(hn::Add(xy, zt), d, behind.data() + column);
    }
  }
}

HWY_INLINE FloatVec times(FloatVec v, float factor) { return hn::Mul(v, hn::Set(Floats{}, factor)); }

void place_blocks_kernel(std::span<const Frame> frames, std::span<const std::uint8_t> links, const BallArrays& balls,
                         float* x_m, float* y_m, float* z_m) {
  const Floats d;
  for (std::size_t block = 0; block < links.size(); ++block) {
    const Frame& T = frames[links[block]];
    for (std::size_t i = block * kBlock; i < (block + 1) * kBlock; i += hn::Lanes(d)) {
      const FloatVec x = hn::LoadU(d, balls.x_m + i);
      const FloatVec y = hn::LoadU(d, balls.y_m + i);
      const FloatVec z = hn::LoadU(d, balls.z_m + i);
      const auto row = [&](std::size_t k) HWY_ATTR {
        return hn::Add(hn::Add(times(x, T[k]), times(y, T[4 + k])), hn::Add(times(z, T[8 + k]), hn::Set(d, T[12 + k])));
      };
      hn::StoreU(row(0), d, x_m + i);
      hn::StoreU(row(1), d, y_m + i);
      hn::StoreU(row(2), d, z_m + i);
    }
  }
}

/// Returns the distance of coordinates from an interval.
HWY_INLINE FloatVec beyond(FloatVec at, float center, float half) {
  const Floats d;
  return hn::Max(hn::Sub(hn::Abs(hn::Sub(at, hn::Set(d, center))), hn::Set(d, half)), hn::Zero(d));
}

HWY_INLINE bool all_apart(const BoxesAndBlocks& pair, float margin_m, const Frame& T, const FrameBox* boxes,
                          const BallArrays& balls) {
  const Floats d;
  for (std::size_t i = pair.first_block * kBlock; i < pair.end_block * kBlock; i += hn::Lanes(d)) {
    const FloatVec x = hn::Sub(hn::LoadU(d, balls.x_m + i), hn::Set(d, T[12]));
    const FloatVec y = hn::Sub(hn::LoadU(d, balls.y_m + i), hn::Set(d, T[13]));
    const FloatVec z = hn::Sub(hn::LoadU(d, balls.z_m + i), hn::Set(d, T[14]));
    const auto column = [&](std::size_t k) HWY_ATTR {
      return hn::Add(hn::Add(times(x, T[4 * k]), times(y, T[4 * k + 1])), times(z, T[4 * k + 2]));
    };
    const FloatVec along_x = column(0);
    const FloatVec along_y = column(1);
    const FloatVec along_z = column(2);
    const FloatVec reach = hn::Add(hn::LoadU(d, balls.radius_m + i), hn::Set(d, margin_m));
    const FloatVec squared_reach = hn::Mul(reach, reach);
    for (std::size_t b = pair.first_box; b < pair.end_box; ++b) {
      const FrameBox& box = boxes[b];
      const FloatVec dx = beyond(along_x, box.center_m[0], box.half_m[0]);
      const FloatVec dy = beyond(along_y, box.center_m[1], box.half_m[1]);
      const FloatVec dz = beyond(along_z, box.center_m[2], box.half_m[2]);
      const FloatVec squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      if (!hn::AllTrue(d, hn::Gt(squared, squared_reach))) return false;
    }
  }
  return true;
}

std::size_t first_near_kernel(std::span<const BoxesAndBlocks> pairs, std::size_t first, const float* margins_m,
                              std::span<const Frame> frames, const FrameBox* boxes, const BallArrays& balls) {
  for (std::size_t i = first; i < pairs.size(); ++i) {
    if (!all_apart(pairs[i], margins_m[i], frames[pairs[i].link], boxes, balls)) return i;
  }
  return pairs.size();
}

}  // namespace
}  // namespace saccade::arm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade::arm {
namespace {

HWY_EXPORT(chain_kernel);
HWY_EXPORT(place_blocks_kernel);
HWY_EXPORT(first_near_kernel);

}  // namespace

void chain(std::span<const JointTerms> joints, const float* cosines, const float* sines, Frame* frames) {
  HWY_DYNAMIC_DISPATCH(chain_kernel)(joints, cosines, sines, frames);
}

void place_blocks(std::span<const Frame> frames, std::span<const std::uint8_t> links, const BallArrays& balls,
                  float* x_m, float* y_m, float* z_m) {
  HWY_DYNAMIC_DISPATCH(place_blocks_kernel)(frames, links, balls, x_m, y_m, z_m);
}

std::size_t first_near(std::span<const BoxesAndBlocks> pairs, std::size_t first, const float* margins_m,
                       std::span<const Frame> frames, const FrameBox* boxes, const BallArrays& balls) {
  return HWY_DYNAMIC_DISPATCH(first_near_kernel)(pairs, first, margins_m, frames, boxes, balls);
}

}  // namespace saccade::arm
#endif  // HWY_ONCE
