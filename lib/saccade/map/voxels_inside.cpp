// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/voxels_inside.hpp"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/map/voxels_inside.cpp"
#include "saccade/core/simd_kernels.hpp"

#ifndef SACCADE_MAP_BALL_OF_BRICK
#define SACCADE_MAP_BALL_OF_BRICK
namespace saccade {

/// A sphere relative to a brick's voxels: squared distances of their centres from its own, axis by axis, and the bounds
/// between which the sum is too close to the squared radius to decide.
struct BallOfBrick {
  alignas(64) std::array<double, kBrickEdge> x_squared;
  std::array<double, kBrickEdge> y_squared;
  std::array<double, kBrickEdge> z_squared;
  double least_squared;
  double most_squared;
};

/// Masks of voxels surely inside, and of voxels not surely outside.
struct BallMasks {
  Mask512 inside;
  Mask512 touched;
};

}  // namespace saccade
#endif

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void mask_ball_simd(const BallOfBrick& ball, BallMasks& out) {
  const hn::CappedTag<double, kBrickEdge> d;
  const auto bits_below = [&](std::size_t first, double bound) HWY_ATTR {
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, hn::Lt(hn::Load(d, ball.x_squared.data() + first), hn::Set(d, bound)), bits.data());
    return std::uint64_t{bits[0]} << first;
  };
  for (std::size_t z = 0; z < kBrickEdge; ++z) {
    std::uint64_t inside{0};
    std::uint64_t touched{0};
    for (std::size_t y = 0; y < kBrickEdge; ++y) {
      const double yz_squared = ball.y_squared[y] + ball.z_squared[z];
      for (std::size_t first = 0; first < kBrickEdge; first += hn::Lanes(d)) {
        inside |= bits_below(first, ball.least_squared - yz_squared) << (y * kBrickEdge);
        touched |= bits_below(first, ball.most_squared - yz_squared) << (y * kBrickEdge);
      }
    }
    out.inside.words[z] = inside;
    out.touched.words[z] = touched;
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(mask_ball_simd);

/// Marks the voxels of a cube in a brick whose centre lies in the shape: all or none at once, or by its octants.
template <class Shape>
void mark_inside(const Shape& shape, const Index3& brick_lo, const Index3& cube, int edge, double voxel_size_m,
                 Mask512& inside) {
  constexpr int kSmallestCube{2};
  const Index3 first = brick_lo + cube;
  const Index3 last = first + Index3{edge - 1, edge - 1, edge - 1};
  const Overlap known = overlap(shape, {voxel_center(first, voxel_size_m), voxel_center(last, voxel_size_m)});
  if (known == Overlap::none) return;
  if (known == Overlap::whole && edge == kBrickEdge) {
    inside = Mask512::all_set();
    return;
  }
  if (known == Overlap::partial && edge > kSmallestCube) {
    const int half = edge / 2;
    for (int i = 0; i < 8; ++i) {
      const Index3 octant = cube + Index3{i & 1, (i >> 1) & 1, (i >> 2) & 1} * half;
      mark_inside(shape, brick_lo, octant, half, voxel_size_m, inside);
    }
    return;
  }
  for (int z = 0; z < edge; ++z) {
    for (int y = 0; y < edge; ++y) {
      for (int x = 0; x < edge; ++x) {
        const Index3 voxel = cube + Index3{x, y, z};
        if (known == Overlap::whole || contains(shape, voxel_center(brick_lo + voxel, voxel_size_m))) {
          inside.set(child_index(voxel));
        }
      }
    }
  }
}

template <class Shape>
Mask512 mask_of(const Shape& shape, const Index3& lo, double voxel_size_m) {
  Mask512 inside;
  mark_inside(shape, lo, {0, 0, 0}, kBrickEdge, voxel_size_m, inside);
  return inside;
}

Mask512 mask_of(const Sphere& sphere, const Index3& lo, double voxel_size_m) {
  constexpr double kSlackM{1e-9};  // above the rounding of contains() and of the sums here, below any voxel
  BallOfBrick ball;
  for (int i = 0; i < kBrickEdge; ++i) {
    const Eigen::Vector3d offset = voxel_center(lo + Index3{i, i, i}, voxel_size_m) - sphere.center;
    const auto at = static_cast<std::size_t>(i);
    ball.x_squared[at] = offset.x() * offset.x();
    ball.y_squared[at] = offset.y() * offset.y();
    ball.z_squared[at] = offset.z() * offset.z();
  }
  const auto squared = [](double x) { return x * x; };
  ball.least_squared = squared(std::max(sphere.radius_m - kSlackM, 0.0));
  ball.most_squared = squared(sphere.radius_m + kSlackM);
  const auto least = [](const auto& values) { return *std::min_element(values.begin(), values.end()); };
  const auto most = [](const auto& values) { return *std::max_element(values.begin(), values.end()); };
  if (least(ball.x_squared) + least(ball.y_squared) + least(ball.z_squared) > ball.most_squared) return {};
  if (most(ball.x_squared) + most(ball.y_squared) + most(ball.z_squared) < ball.least_squared) {
    return Mask512::all_set();
  }
  BallMasks masks;
  HWY_DYNAMIC_DISPATCH(mask_ball_simd)(ball, masks);
  (masks.touched & ~masks.inside).for_each([&](std::size_t i) {
    const Index3 voxel = lo + child_offset(static_cast<int>(i));
    masks.inside.assign(static_cast<int>(i), contains(sphere, voxel_center(voxel, voxel_size_m)));
  });
  return masks.inside;
}

}  // namespace

Mask512 voxels_inside(const Region& region, const Index3& lo, double voxel_size_m) {
  return std::visit([&](const auto& shape) { return mask_of(shape, lo, voxel_size_m); }, region);
}

Mask512 voxels_inside(const IndexBox& box, const Index3& lo) {
  const auto [first, end] = IndexBox{box.lo - lo, box.hi - lo}.intersection(IndexBox::cube({}, kBrickEdge));
  Mask512 mask;
  if (IndexBox{first, end}.empty()) return mask;
  const std::uint64_t row = (0xFFU >> (kBrickEdge - end.x)) & (0xFFU << first.x);
  for (int z = first.z; z < end.z; ++z) {
    for (int y = first.y; y < end.y; ++y) mask.words[static_cast<std::size_t>(z)] |= row << (kBrickEdge * y);
  }
  return mask;
}

}  // namespace saccade
#endif  // HWY_ONCE
