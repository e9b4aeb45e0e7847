// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/icp_kernels.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/tracking/internal/icp_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kPairLanes>;
using IntTag = hn::RebindToSigned<Tag>;
using V = hn::Vec<Tag>;
using M = hn::Mask<Tag>;

/// Measured points of kPairLanes neighbouring columns.
struct Block {
  const float* z;
  const float* nx;
  const float* ny;
  const float* nz;
};

HWY_INLINE V set(float value) { return hn::Set(Tag{}, value); }

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

HWY_INLINE V weight_of(V depth, V residual) {
  const V beyond = hn::Max(hn::Sub(depth, set(DepthSigma::kFrom_m)), hn::Zero(Tag{}));
  const V sigma =
      hn::Add(set(DepthSigma::kNearest_m), hn::Mul(set(DepthSigma::kGrowth_per_m), hn::Mul(beyond, beyond)));
  const V linear_from = hn::Max(sigma, hn::Mul(hn::Abs(residual), set(1.0F / kHuberSigmas)));
  return hn::Div(set(1e-6F), hn::Mul(sigma, linear_from));
}

HWY_INLINE void add_to(float* sum, V value) {
  const Tag d;
  hn::Store(hn::Add(hn::Load(d, sum), value), d, sum);
}

template <class... Vs>
HWY_INLINE void add_products(float* sums, V factor, Vs... others) {
  ((add_to(sums, hn::Mul(factor, others)), sums += kPairLanes), ...);
}

/// Adds the pairs of one vector of pixels, from `lane` on in the block, with rays (ray_x, ray_y, 1). Returns their
/// number.
HWY_INLINE std::size_t add_vector(const PairingTask& task, const Block& block, int lane, V ray_x, V ray_y,
                                  PairSums& sums) {
  const Tag d;
  const IntTag di;
  const V z = hn::LoadU(d, block.z + lane);
  const V x_camera = hn::Mul(ray_x, z);
  const V y_camera = hn::Mul(ray_y, z);
  const std::array<float, 9>& R = task.R;
  const V px = hn::Add(dot(set(R[0]), set(R[1]), set(R[2]), x_camera, y_camera, z), set(task.t[0]));
  const V py = hn::Add(dot(set(R[3]), set(R[4]), set(R[5]), x_camera, y_camera, z), set(task.t[1]));
  const V pz = hn::Add(dot(set(R[6]), set(R[7]), set(R[8]), x_camera, y_camera, z), set(task.t[2]));

  // The model's pixel.
  const V inverse_z = hn::Div(set(1.0F), pz);
  V u = hn::Add(hn::Mul(hn::Mul(px, inverse_z), set(task.fx)), set(task.cx + 0.5F));
  V v = hn::Add(hn::Mul(hn::Mul(py, inverse_z), set(task.fy)), set(task.cy + 0.5F));
  const V zero = hn::Zero(d);
  M pair = hn::And(hn::Gt(z, zero), hn::Gt(pz, set(kMinModelDepth_m)));
  pair = hn::And(pair, hn::And(hn::Ge(u, zero), hn::Lt(u, set(static_cast<float>(task.model.width)))));
  pair = hn::And(pair, hn::And(hn::Ge(v, zero), hn::Lt(v, set(static_cast<float>(task.model.height)))));
  if (hn::AllFalse(d, pair)) return 0;
  const auto column = hn::ConvertTo(di, hn::IfThenElseZero(pair, u));
  const auto row = hn::ConvertTo(di, hn::IfThenElseZero(pair, v));
  const auto index = hn::Add(hn::Mul(row, hn::Set(di, task.model.width)), column);

  // The model's point q and normal n there.
  const V qz = hn::GatherIndex(d, task.model.z, index);
  u = hn::Sub(hn::ConvertTo(d, column), set(task.cx));
  v = hn::Sub(hn::ConvertTo(d, row), set(task.cy));
  const V dx = hn::Sub(px, hn::Mul(hn::Mul(u, set(task.inverse_fx)), qz));
  const V dy = hn::Sub(py, hn::Mul(hn::Mul(v, set(task.inverse_fy)), qz));
  const V dz = hn::Sub(pz, qz);
  pair = hn::And(pair, hn::Gt(qz, zero));
  pair = hn::And(pair, hn::Le(dot(dx, dy, dz, dx, dy, dz), set(task.max_squared_distance_m2)));
  if (hn::AllFalse(d, pair)) return 0;
  const V nx = hn::GatherIndex(d, task.model.nx, index);
  const V ny = hn::GatherIndex(d, task.model.ny, index);
  const V nz = hn::GatherIndex(d, task.model.nz, index);

  // The angle between normals: n in the camera's frame against the measured one.
  const V nx_camera = dot(set(R[0]), set(R[3]), set(R[6]), nx, ny, nz);
  const V ny_camera = dot(set(R[1]), set(R[4]), set(R[7]), nx, ny, nz);
  const V nz_camera = dot(set(R[2]), set(R[5]), set(R[8]), nx, ny, nz);
  const V cosine = dot(nx_camera, ny_camera, nz_camera, hn::LoadU(d, block.nx + lane), hn::LoadU(d, block.ny + lane),
                       hn::LoadU(d, block.nz + lane));
  pair = hn::And(pair, hn::Gt(cosine, set(task.min_normal_cosine)));
  if (hn::AllFalse(d, pair)) return 0;

  const V r = dot(nx, ny, nz, dx, dy, dz);
  const V w = hn::IfThenElseZero(pair, weight_of(z, r));
  const V j0 = hn::Sub(hn::Mul(py, nz), hn::Mul(pz, ny));
  const V j1 = hn::Sub(hn::Mul(pz, nx), hn::Mul(px, nz));
  const V j2 = hn::Sub(hn::Mul(px, ny), hn::Mul(py, nx));
  const auto at = [&sums, lane](std::size_t product) HWY_ATTR { return sums.products[product].data() + lane; };
  add_products(at(0), hn::Mul(w, j0), j0, j1, j2, nx, ny, nz, r);
  add_products(at(7), hn::Mul(w, j1), j1, j2, nx, ny, nz, r);
  add_products(at(13), hn::Mul(w, j2), j2, nx, ny, nz, r);
  add_products(at(18), hn::Mul(w, nx), nx, ny, nz, r);
  add_products(at(22), hn::Mul(w, ny), ny, nz, r);
  add_products(at(25), hn::Mul(w, nz), nz, r);
  add_to(sums.squared_residuals.data() + lane, hn::IfThenElseZero(pair, hn::Mul(r, r)));
  return hn::CountTrue(d, pair);
}

/// The last columns of a row, padded with pixels without return.
struct Tail {
  std::array<std::array<float, kPairLanes>, 4> planes{};

  Block fill(const Block& from, int count) {
    std::copy_n(from.z, count, planes[0].begin());
    std::copy_n(from.nx, count, planes[1].begin());
    std::copy_n(from.ny, count, planes[2].begin());
    std::copy_n(from.nz, count, planes[3].begin());
    return {planes[0].data(), planes[1].data(), planes[2].data(), planes[3].data()};
  }
};

void linearize(const PairingTask& task, int begin, int end, PairSums& sums) {
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const LevelPoints& points = task.measured;
  const V inverse_fx = set(task.inverse_fx);
  const V stride = set(static_cast<float>(points.stride));
  std::size_t pairs{0};
  for (int row = begin; row < end; ++row) {
    const V ray_y = set((static_cast<float>(row * points.stride) - task.cy) * task.inverse_fy);
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(row) * points.width;
    for (int column = 0; column < points.width; column += kPairLanes) {
      const std::ptrdiff_t at = first + column;
      Block block{points.z + at, points.nx + at, points.ny + at, points.nz + at};
      Tail tail;
      if (column + kPairLanes > points.width) block = tail.fill(block, points.width - column);
      for (int lane = 0; lane < kPairLanes; lane += lanes) {
        const V u = hn::Mul(hn::Iota(d, static_cast<float>(column + lane)), stride);
        const V ray_x = hn::Mul(hn::Sub(u, set(task.cx)), inverse_fx);
        pairs += add_vector(task, block, lane, ray_x, ray_y, sums);
      }
    }
  }
  sums.pairs += pairs;
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(linearize);

}  // namespace

void linearize_rows(const PairingTask& task, int begin, int end, PairSums& sums) {
  HWY_DYNAMIC_DISPATCH(linearize)(task, begin, end, sums);
}

}  // namespace saccade
#endif  // HWY_ONCE
