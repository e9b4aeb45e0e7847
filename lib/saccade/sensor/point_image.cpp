// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/point_image.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/sensor/point_image.cpp"
#include "saccade/core/simd_kernels.hpp"

#ifndef SACCADE_POINT_IMAGE_ROWS
#define SACCADE_POINT_IMAGE_ROWS
namespace saccade {
namespace {

constexpr int kMaxLanes{16};
/// Normals span a few pixels: depth is quantised, and neighbouring pixels alone give steps for normals.
constexpr int kHalfBaseline{3};
constexpr int kRowMargin{32};         ///< pixels without return before and after a row, for vectors that begin in it
constexpr float kLargestStep{0.03F};  ///< relative to depth
static_assert(kRowMargin >= kMaxLanes + kHalfBaseline);

/// Three rows of depths, kHalfBaseline apart, and the output for the middle row's normals. The rows are readable
/// kRowMargin pixels before and after their ends, and are zero there and where there is no return.
struct NormalRow {
  const float* above;
  const float* here;
  const float* below;
  float* nx;
  float* ny;
  float* nz;
  int width;
  float cx, inverse_fx;                  ///< ray x of column u: (u - cx) · inverse_fx
  float ray_above, ray_here, ray_below;  ///< ray y of the three rows
};

}  // namespace
}  // namespace saccade
#endif

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<Tag>;

/// Sets depths outside the range to zero.
void keep_range(const float* depth, int width, float nearest, float farthest, float* out) {
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int u{0};
  for (; u + lanes <= width; u += lanes) {
    const V z = hn::LoadU(d, depth + u);
    const auto inside = hn::And(hn::Ge(z, hn::Set(d, nearest)), hn::Le(z, hn::Set(d, farthest)));
    hn::StoreU(hn::IfThenElseZero(inside, z), d, out + u);
  }
  for (; u < width; ++u) out[u] = depth[u] >= nearest && depth[u] <= farthest ? depth[u] : 0.0F;
}

HWY_INLINE void store(V value, float* to, int count) {
  const Tag d;
  if (count >= static_cast<int>(hn::Lanes(d))) {
    hn::StoreU(value, d, to);
    return;
  }
  std::array<float, kMaxLanes> rest;
  hn::StoreU(value, d, rest.data());
  std::copy_n(rest.begin(), count, to);
}

void normal_row(const NormalRow& row) {
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V zero = hn::Zero(d);
  const V cx = hn::Set(d, row.cx);
  const V inverse_fx = hn::Set(d, row.inverse_fx);
  const V ray_here = hn::Set(d, row.ray_here);
  const V baseline = hn::Set(d, static_cast<float>(kHalfBaseline));
  for (int u = 0; u < row.width; u += lanes) {
    const V z = hn::LoadU(d, row.here + u);
    const V limit = hn::Mul(hn::Set(d, kLargestStep), z);
    const V column = hn::Iota(d, static_cast<float>(u));
    const V ray_x = hn::Mul(hn::Sub(column, cx), inverse_fx);

    // Neighbours across a depth step, or without return, are replaced by the pixel itself.
    V za = hn::LoadU(d, row.above + u);
    V zb = hn::LoadU(d, row.below + u);
    auto a_near = hn::And(hn::Gt(za, zero), hn::Lt(hn::Abs(hn::Sub(za, z)), limit));
    auto b_near = hn::And(hn::Gt(zb, zero), hn::Lt(hn::Abs(hn::Sub(zb, z)), limit));
    za = hn::IfThenElse(a_near, za, z);
    zb = hn::IfThenElse(b_near, zb, z);
    V ray_a = hn::IfThenElse(a_near, hn::Set(d, row.ray_above), ray_here);
    V ray_b = hn::IfThenElse(b_near, hn::Set(d, row.ray_below), ray_here);
    const V down_z = hn::Sub(zb, za);
    const V down_x = hn::Mul(ray_x, down_z);
    const V down_y = hn::Sub(hn::Mul(ray_b, zb), hn::Mul(ray_a, za));

    za = hn::LoadU(d, row.here + u - kHalfBaseline);
    zb = hn::LoadU(d, row.here + u + kHalfBaseline);
    a_near = hn::And(hn::Gt(za, zero), hn::Lt(hn::Abs(hn::Sub(za, z)), limit));
    b_near = hn::And(hn::Gt(zb, zero), hn::Lt(hn::Abs(hn::Sub(zb, z)), limit));
    za = hn::IfThenElse(a_near, za, z);
    zb = hn::IfThenElse(b_near, zb, z);
    ray_a = hn::IfThenElse(a_near, hn::Mul(hn::Sub(hn::Sub(column, baseline), cx), inverse_fx), ray_x);
    ray_b = hn::IfThenElse(b_near, hn::Mul(hn::Sub(hn::Add(column, baseline), cx), inverse_fx), ray_x);
    const V right_z = hn::Sub(zb, za);
    const V right_x = hn::Sub(hn::Mul(ray_b, zb), hn::Mul(ray_a, za));
    const V right_y = hn::Mul(ray_here, right_z);

    // down × right points towards the camera.
    const V nx = hn::Sub(hn::Mul(down_y, right_z), hn::Mul(down_z, right_y));
    const V ny = hn::Sub(hn::Mul(down_z, right_x), hn::Mul(down_x, right_z));
    const V nz = hn::Sub(hn::Mul(down_x, right_y), hn::Mul(down_y, right_x));
    const V norm = hn::Sqrt(hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz)));
    const V scale = hn::IfThenElseZero(hn::Gt(norm, zero), hn::Div(hn::Set(d, 1.0F), norm));
    store(hn::Mul(nx, scale), row.nx + u, row.width - u);
    store(hn::Mul(ny, scale), row.ny + u, row.width - u);
    store(hn::Mul(nz, scale), row.nz + u, row.width - u);
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(keep_range);
HWY_EXPORT(normal_row);

constexpr std::size_t kRowsPerChunk{16};

PointImage planes(int width, int height) {
  return {Image<float>{width, height}, Image<float>{width, height}, Image<float>{width, height},
          Image<float>{width, height}};
}

/// Window of the depths within range in row v and the rows that its normals need, with margins of no return.
class RowWindow {
 public:
  RowWindow(const DepthImage& depth, const PinholeCamera& camera)
      : depth_{depth},
        nearest_{static_cast<float>(camera.min_range_m)},
        farthest_{static_cast<float>(camera.max_range_m)},
        stride_{static_cast<std::size_t>(depth.width()) + 2 * kRowMargin},
        rows_(kRows * stride_) {}

  /// Fills a row; rows outside the image have no returns.
  void fill(int v) {
    float* to = slot(v);
    if (v >= 0 && v < depth_.height()) {
      HWY_DYNAMIC_DISPATCH(keep_range)(depth_.row(v), depth_.width(), nearest_, farthest_, to);
    } else {
      std::fill_n(to, depth_.width(), 0.0F);
    }
  }
  [[nodiscard]] const float* row(int v) const { return rows_.data() + offset(v); }

 private:
  static constexpr std::size_t kRows{2 * kHalfBaseline + 1};

  [[nodiscard]] std::size_t offset(int v) const {
    return static_cast<std::size_t>(v + static_cast<int>(kRows)) % kRows * stride_ + kRowMargin;
  }
  [[nodiscard]] float* slot(int v) { return rows_.data() + offset(v); }

  const DepthImage& depth_;
  float nearest_;
  float farthest_;
  std::size_t stride_;
  std::vector<float> rows_;
};

void add_rows(const DepthImage& depth, const PinholeCamera& camera, int begin, int end, PointImage& image) {
  const auto inverse_fy = static_cast<float>(1.0 / camera.fy);
  const auto ray_y = [&](int v) { return (static_cast<float>(v) - static_cast<float>(camera.cy)) * inverse_fy; };
  RowWindow window{depth, camera};
  for (int v = begin - kHalfBaseline; v < begin + kHalfBaseline; ++v) window.fill(v);
  for (int v = begin; v < end; ++v) {
    window.fill(v + kHalfBaseline);
    std::copy_n(window.row(v), camera.width, image.z.row(v));
    NormalRow row;
    row.above = window.row(v - kHalfBaseline);
    row.here = window.row(v);
    row.below = window.row(v + kHalfBaseline);
    row.nx = image.nx.row(v);
    row.ny = image.ny.row(v);
    row.nz = image.nz.row(v);
    row.width = camera.width;
    row.cx = static_cast<float>(camera.cx);
    row.inverse_fx = static_cast<float>(1.0 / camera.fx);
    row.ray_above = ray_y(v - kHalfBaseline);
    row.ray_here = ray_y(v);
    row.ray_below = ray_y(v + kHalfBaseline);
    HWY_DYNAMIC_DISPATCH(normal_row)(row);
  }
}

}  // namespace

PointImage to_points(const DepthImage& depth, const PinholeCamera& camera, const Executor& executor) {
  SACCADE_EXPECTS(depth.width() == camera.width && depth.height() == camera.height);
  PointImage image = planes(camera.width, camera.height);
  executor.parallel_for(static_cast<std::size_t>(camera.height), kRowsPerChunk,
                        [&](std::size_t begin, std::size_t end) {
                          add_rows(depth, camera, static_cast<int>(begin), static_cast<int>(end), image);
                        });
  return image;
}

}  // namespace saccade
#endif  // HWY_ONCE
