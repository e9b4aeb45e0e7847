// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/raycast.hpp"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/map/view_points.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;
using V = hn::Vec<Tag>;

void split_normals(const float* xyz, std::size_t count, float* nx, float* ny, float* nz) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i{0};
  for (; i + lanes <= count; i += lanes) {
    V x;
    V y;
    V z;
    hn::LoadInterleaved3(d, xyz + 3 * i, x, y, z);
    hn::StoreU(x, d, nx + i);
    hn::StoreU(y, d, ny + i);
    hn::StoreU(z, d, nz + i);
  }
  for (; i < count; ++i) {
    nx[i] = xyz[3 * i];
    ny[i] = xyz[3 * i + 1];
    nz[i] = xyz[3 * i + 2];
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(split_normals);

constexpr std::size_t kRowsPerChunk{16};

}  // namespace

PointImage to_points(const SurfaceView& view, const Executor& executor) {
  SACCADE_EXPECTS(view.normals.width() == view.depth.width() && view.normals.height() == view.depth.height());
  const int width = view.depth.width();
  const int height = view.depth.height();
  PointImage image{Image<float>{width, height}, Image<float>{width, height}, Image<float>{width, height},
                   Image<float>{width, height}};
  executor.parallel_for(static_cast<std::size_t>(view.depth.height()), kRowsPerChunk,
                        [&](std::size_t begin, std::size_t end) {
                          const int v = static_cast<int>(begin);
                          const std::size_t count = (end - begin) * static_cast<std::size_t>(width);
                          std::copy_n(view.depth.row(v), count, image.z.row(v));
                          HWY_DYNAMIC_DISPATCH(split_normals)
                          (view.normals.row(v)->data(), count, image.nx.row(v), image.ny.row(v), image.nz.row(v));
                        });
  return image;
}

}  // namespace saccade
#endif  // HWY_ONCE
