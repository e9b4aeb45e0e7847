// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/views/internal/face_boxes.cpp"
#include "saccade/core/simd_kernels.hpp"

#include <cstring>

#include "saccade/views/internal/face_boxes.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::view_kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, EntryFaces::kLanes>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using M = hn::Mask<F>;

constexpr float kClosest_vox{0.25F};  // nearer points are not projected

/// Fills a rectangle of pixels, both ends included.
HWY_INLINE void fill(BitRaster raster, std::int32_t left, std::int32_t right, std::int32_t top, std::int32_t bottom) {
  constexpr std::int32_t kAtOnce{56};  // bits that fit into a word from any bit of its first byte
  for (std::int32_t first = left; first <= right; first += kAtOnce) {
    const std::int32_t count = right - first + 1 < kAtOnce ? right - first + 1 : kAtOnce;
    const std::uint64_t bits = ((std::uint64_t{1} << count) - 1) << (first & 7);
    std::uint8_t* at =
        raster.bytes + static_cast<std::size_t>(top) * raster.stride + static_cast<std::size_t>(first >> 3);
    for (std::int32_t row = top; row <= bottom; ++row, at += raster.stride) {
      std::uint64_t word;
      std::memcpy(&word, at, sizeof word);
      word |= bits;
      std::memcpy(at, &word, sizeof word);
    }
  }
}

struct Point {
  VF column;  ///< multiplied by depth
  VF row;
  VF depth;
  [[nodiscard]] HWY_INLINE Point operator+(const Point& o) const {
    return {hn::Add(column, o.column), hn::Add(row, o.row), hn::Add(depth, o.depth)};
  }
};

/// Bounds in the image.
struct Bounds {
  VF left;
  VF right;
  VF top;
  VF bottom;
  HWY_INLINE void add(const Point& p, VF inverse_depth) {
    const VF column = hn::Mul(p.column, inverse_depth);
    const VF row = hn::Mul(p.row, inverse_depth);
    left = hn::Min(left, column);
    right = hn::Max(right, column);
    top = hn::Min(top, row);
    bottom = hn::Max(bottom, row);
  }
};

class FaceDrawer {
 public:
  HWY_INLINE FaceDrawer(const FaceProjection& camera, const EntryFaces& faces, const FaceGroup& group,
                        const BitRaster& raster)
      : camera_{camera}, faces_{faces}, group_{group}, raster_{raster} {}

  HWY_INLINE void draw() const {
    for (std::size_t first = group_.begin; first < group_.end; first += hn::Lanes(f_)) draw(first);
  }

 private:
  /// Returns a step of the squares' edge along an axis.
  [[nodiscard]] HWY_INLINE Point edge(std::size_t axis, VF edge_vox) const {
    return {hn::Mul(edge_vox, hn::Set(f_, camera_.to_image[0][axis])),
            hn::Mul(edge_vox, hn::Set(f_, camera_.to_image[1][axis])),
            hn::Mul(edge_vox, hn::Set(f_, camera_.to_image[2][axis]))};
  }

  HWY_INLINE void draw(std::size_t first) const {
    const std::array<std::int32_t, 3> origin{camera_.origin.x, camera_.origin.y, camera_.origin.z};
    const auto across = static_cast<std::size_t>(group_.axis);
    const VI plane = hn::LoadU(i_, faces_.corners(across).data() + first);
    const VI at = hn::Set(i_, origin[across]);
    const auto ahead = group_.forward ? hn::Gt(plane, at) : hn::Lt(plane, hn::Add(at, hn::Set(i_, 1)));
    if (hn::AllFalse(i_, ahead)) return;

    Point corner{hn::Zero(f_), hn::Zero(f_), hn::Zero(f_)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VI voxel = hn::LoadU(i_, faces_.corners(axis).data() + first);
      const VF x =
          hn::Sub(hn::ConvertTo(f_, hn::Sub(voxel, hn::Set(i_, origin[axis]))), hn::Set(f_, camera_.fraction[axis]));
      corner = corner + edge(axis, x);
    }
    const VF edge_vox = hn::LoadU(f_, faces_.edges_vox().data() + first);
    const Point u = edge(across == 0 ? 1 : 0, edge_vox);
    const Point v = edge(across == 2 ? 1 : 2, edge_vox);
    const Point beside = corner + u;
    const std::array<Point, 4> corners{corner, beside, corner + v, beside + v};

    const VF nearest =
        hn::Min(hn::Min(corners[0].depth, corners[1].depth), hn::Min(corners[2].depth, corners[3].depth));
    const VF farthest =
        hn::Max(hn::Max(corners[0].depth, corners[1].depth), hn::Max(corners[2].depth, corners[3].depth));
    M counts = hn::And(hn::RebindMask(f_, ahead), hn::Ge(farthest, hn::Set(f_, camera_.nearest_vox)));
    counts = hn::And(counts, hn::Le(nearest, hn::Set(f_, camera_.farthest_vox)));
    if (hn::AllFalse(f_, counts)) return;
    const M close = hn::Lt(nearest, hn::Set(f_, kClosest_vox));
    if (!hn::AllFalse(f_, hn::And(counts, close))) {
      fill(raster_, 0, camera_.columns - 1, 0, camera_.rows - 1);
      return;
    }
    store(bounds(corners), hn::Div(hn::Set(f_, camera_.margin_px_by_vox), nearest), counts);
  }

  [[nodiscard]] HWY_INLINE static Bounds bounds(const std::array<Point, 4>& corners) {
    const VF far = hn::Set(f_, 1e9F);
    Bounds bounds{far, hn::Neg(far), far, hn::Neg(far)};
    for (const Point& p : corners) bounds.add(p, hn::Div(hn::Set(f_, 1.0F), p.depth));
    return bounds;
  }

  HWY_INLINE void store(const Bounds& bounds, VF margin_by_depth, M counts) const {
    const VF margin = hn::Add(margin_by_depth, hn::Set(f_, camera_.margin_px));
    alignas(64) std::array<std::int32_t, EntryFaces::kLanes> left;
    alignas(64) std::array<std::int32_t, EntryFaces::kLanes> right;
    alignas(64) std::array<std::int32_t, EntryFaces::kLanes> top;
    alignas(64) std::array<std::int32_t, EntryFaces::kLanes> bottom;
    // Clamped first, so that every number fits into an integer.
    const auto first_pixel = [](VF x, float origin) HWY_ATTR {
      return hn::ConvertTo(
          i_, hn::Min(hn::Max(hn::Ceil(hn::Sub(x, hn::Set(f_, origin))), hn::Zero(f_)), hn::Set(f_, 1e6F)));
    };
    const auto last_pixel = [](VF x, float origin, int count) HWY_ATTR {
      return hn::ConvertTo(
          i_, hn::Max(hn::Min(hn::Floor(hn::Sub(x, hn::Set(f_, origin))), hn::Set(f_, static_cast<float>(count - 1))),
                      hn::Set(f_, -1.0F)));
    };
    const VI last = last_pixel(hn::Add(bounds.right, margin), camera_.first_column, camera_.columns);
    hn::Store(first_pixel(hn::Sub(bounds.left, margin), camera_.first_column), i_, left.data());
    hn::Store(hn::IfThenElse(hn::RebindMask(i_, counts), last, hn::Set(i_, -1)), i_, right.data());
    hn::Store(first_pixel(hn::Sub(bounds.top, margin), camera_.first_row), i_, top.data());
    hn::Store(last_pixel(hn::Add(bounds.bottom, margin), camera_.first_row, camera_.rows), i_, bottom.data());
    const BitRaster raster{raster_};  // local copy, so that it is not read again after each byte written
    for (std::size_t i = 0; i < hn::Lanes(f_); ++i) fill(raster, left[i], right[i], top[i], bottom[i]);
  }

  static constexpr F f_{};
  static constexpr I i_{};
  const FaceProjection& camera_;
  const EntryFaces& faces_;
  const FaceGroup& group_;
  BitRaster raster_;
};

void draw_face_boxes_simd(const FaceProjection& camera, const EntryFaces& faces, const FaceGroup& group,
                          const BitRaster& raster) {
  FaceDrawer{camera, faces, group, raster}.draw();
}

}  // namespace
}  // namespace saccade::view_kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace view_kernels {
namespace {

HWY_EXPORT(draw_face_boxes_simd);

}  // namespace
}  // namespace view_kernels

void draw_face_boxes(const FaceProjection& camera, const EntryFaces& faces, const FaceGroup& group,
                     const BitRaster& raster) {
  using namespace view_kernels;
  HWY_DYNAMIC_DISPATCH(draw_face_boxes_simd)(camera, faces, group, raster);
}

}  // namespace saccade
#endif  // HWY_ONCE
