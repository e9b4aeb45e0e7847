// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/icp_kernels.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/tracking/internal/icp_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"
#include "saccade/tracking/internal/pair_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

/// Measured points of kPairLanes neighbouring columns.
struct Block {
  const float* z;
  const float* nx;
  const float* ny;
  const float* nz;
};

HWY_INLINE V weight_of(V depth, V residual) {
  const V beyond = hn::Max(hn::Sub(depth, set(DepthSigma::kFrom_m)), hn::Zero(PairTag{}));
  const V sigma =
      hn::Add(set(DepthSigma::kNearest_m), hn::Mul(set(DepthSigma::kGrowth_per_m), hn::Mul(beyond, beyond)));
  const V linear_from = hn::Max(sigma, hn::Mul(hn::Abs(residual), set(1.0F / kHuberSigmas)));
  return hn::Div(set(1e-6F), hn::Mul(sigma, linear_from));
}

/// Adds the pairs of one vector of pixels, from `lane` on in the block, with rays (ray_x, ray_y, 1). Returns their
/// number.
HWY_INLINE std::size_t add_vector(const PairingTask& task, const Block& block, int lane, V ray_x, V ray_y,
                                  PairSums& sums) {
  const PairTag d;
  const PairIndexTag di;
  const V z = hn::LoadU(d, block.z + lane);
  const PairPoint p = moved(task.R, task.t, ray_x, ray_y, z);
  const auto& [px, py, pz] = p;

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
  const std::array<float, 9>& R = task.R;
  const V nx_camera = dot(set(R[0]), set(R[3]), set(R[6]), nx, ny, nz);
  const V ny_camera = dot(set(R[1]), set(R[4]), set(R[7]), nx, ny, nz);
  const V nz_camera = dot(set(R[2]), set(R[5]), set(R[8]), nx, ny, nz);
  const V cosine = dot(nx_camera, ny_camera, nz_camera, hn::LoadU(d, block.nx + lane), hn::LoadU(d, block.ny + lane),
                       hn::LoadU(d, block.nz + lane));
  pair = hn::And(pair, hn::Gt(cosine, set(task.min_normal_cosine)));
  if (hn::AllFalse(d, pair)) return 0;

  const V r = dot(nx, ny, nz, dx, dy, dz);
  const V w = hn::IfThenElseZero(pair, weight_of(z, r));
  add_pairs(sums.products, lane, w, p, nx, ny, nz, r);
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
  const PairTag d;
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
