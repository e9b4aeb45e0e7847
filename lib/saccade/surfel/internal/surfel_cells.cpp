// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/surfel_cells.hpp"

#include <algorithm>
#include <array>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/internal/surfel_cells.cpp"
#include "saccade/core/simd_kernels.hpp"

#ifndef SACCADE_SURFEL_CELLS_ROWS
#define SACCADE_SURFEL_CELLS_ROWS
namespace saccade {
namespace {

constexpr int kMostLanes{16};
constexpr int kReach_px{1};
static_assert(SurfelCells::kMargin >= kMostLanes + kReach_px);

/// Pixels of a row, one per lane of the widest vector.
struct PixelBlock {
  const float *z, *nx, *ny, *nz;
  SurfelId* of_pixel;
};

}  // namespace
}  // namespace saccade
#endif

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kMostLanes>;
using IdTag = hn::RebindToUnsigned<Tag>;
using V = hn::Vec<Tag>;
using Ids = hn::Vec<IdTag>;

/// Pixels from u on; `here` is the place in the block where their lanes begin.
struct Pixels {
  V z, nx, ny, nz, ray_x, ray_y;
};

HWY_INLINE V dot(const SurfelCells& cells, const Pixels& pixels, int u, int v) {
  const Tag d;
  const V x = hn::Mul(hn::LoadU(d, cells.row(SurfelCells::kNx, v) + u), pixels.nx);
  const V y = hn::Mul(hn::LoadU(d, cells.row(SurfelCells::kNy, v) + u), pixels.ny);
  return hn::Add(hn::Add(x, y), hn::Mul(hn::LoadU(d, cells.row(SurfelCells::kNz, v) + u), pixels.nz));
}

HWY_INLINE void associate_block(const SurfelCells& cells, const AssociationLimits& limits, int u, int v, int lane,
                                const PixelBlock& block, RowCounts& counts) {
  const Tag d;
  const IdTag di;
  Pixels pixels;
  pixels.z = hn::LoadU(d, block.z + lane);
  pixels.nx = hn::LoadU(d, block.nx + lane);
  pixels.ny = hn::LoadU(d, block.ny + lane);
  pixels.nz = hn::LoadU(d, block.nz + lane);
  pixels.ray_x = hn::Div(hn::Sub(hn::Iota(d, static_cast<float>(u)), hn::Set(d, limits.cx)), hn::Set(d, limits.fx));
  pixels.ray_y = hn::Set(d, (static_cast<float>(v) - limits.cy) / limits.fy);
  const V zero = hn::Zero(d);
  const V limit =
      hn::Add(hn::Set(d, limits.tolerance_m), hn::Mul(hn::Mul(hn::Set(d, limits.growth_per_m), pixels.z), pixels.z));
  const V least_dot = hn::Set(d, limits.normal_cosine);
  const auto has_normal =
      hn::Not(hn::And(hn::And(hn::Eq(pixels.nx, zero), hn::Eq(pixels.ny, zero)), hn::Eq(pixels.nz, zero)));
  const auto is_point = hn::And(hn::Gt(pixels.z, zero), has_normal);

  // The surfel of the pixel's own cell.
  const V own_z = hn::LoadU(d, cells.row(SurfelCells::kZ, v) + u);
  const auto own_near = hn::Le(hn::Abs(hn::Sub(own_z, pixels.z)), limit);
  const auto own_fits = hn::And(own_near, hn::Ge(dot(cells, pixels, u, v), least_dot));
  Ids best = hn::IfThenElse(hn::RebindMask(di, own_fits), hn::LoadU(di, cells.ids(v) + u), hn::Set(di, kNoSurfel));
  auto occupied = own_near;
  auto found = own_fits;

  if (!hn::AllTrue(d, hn::Or(own_fits, hn::Not(is_point)))) {
    // Otherwise the nearest of the surrounding surfels that cover the pixel's ray.
    V least = hn::Set(d, std::numeric_limits<float>::max());
    for (int row = v - kReach_px; row <= v + kReach_px; ++row) {
      for (int column = u - kReach_px; column <= u + kReach_px; ++column) {
        if (row == v && column == u) continue;
        const V z = hn::LoadU(d, cells.row(SurfelCells::kZ, row) + column);
        const V dx = hn::Sub(hn::LoadU(d, cells.row(SurfelCells::kX, row) + column), hn::Mul(pixels.ray_x, z));
        const V dy = hn::Sub(hn::LoadU(d, cells.row(SurfelCells::kY, row) + column), hn::Mul(pixels.ray_y, z));
        const V squared = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
        const auto covers =
            hn::And(hn::Le(hn::Abs(hn::Sub(z, pixels.z)), limit),
                    hn::Le(squared, hn::LoadU(d, cells.row(SurfelCells::kSquaredRadius, row) + column)));
        occupied = hn::Or(occupied, covers);
        const auto fits = hn::And(covers, hn::Ge(dot(cells, pixels, column, row), least_dot));
        const auto better = hn::And(hn::And(fits, hn::Lt(squared, least)), hn::Not(own_fits));
        least = hn::IfThenElse(better, squared, least);
        best = hn::IfThenElse(hn::RebindMask(di, better), hn::LoadU(di, cells.ids(row) + column), best);
        found = hn::Or(found, fits);
      }
    }
  }

  // Otherwise the pixel creates a surfel, unless the view is too flat.
  const V toward = hn::Add(hn::Add(hn::Mul(pixels.nx, pixels.ray_x), hn::Mul(pixels.ny, pixels.ray_y)), pixels.nz);
  const V length = hn::Sqrt(
      hn::Add(hn::Add(hn::Mul(pixels.ray_x, pixels.ray_x), hn::Mul(pixels.ray_y, pixels.ray_y)), hn::Set(d, 1.0F)));
  const auto faces = hn::Ge(hn::Neg(toward), hn::Mul(hn::Set(d, limits.view_cosine), length));
  const auto associated = hn::And(is_point, found);
  const auto contradicted = hn::And(is_point, hn::And(occupied, hn::Not(found)));
  const auto created = hn::And(hn::And(is_point, faces), hn::Not(hn::Or(occupied, found)));
  best = hn::IfThenElse(hn::RebindMask(di, created), hn::Set(di, kMakesSurfel), best);
  best = hn::IfThenElse(hn::RebindMask(di, is_point), best, hn::Set(di, kNoSurfel));
  hn::StoreU(best, di, block.of_pixel + lane);
  counts.points += hn::CountTrue(d, is_point);
  counts.associated += hn::CountTrue(d, associated);
  counts.contradicted += hn::CountTrue(d, contradicted);
  counts.created += hn::CountTrue(d, created);
}

void associate_row_kernel(const SurfelCells& cells, const PointImage& points, const AssociationLimits& limits, int v,
                          SurfelId* of_pixel, RowCounts& counts) {
  const int lanes = static_cast<int>(hn::Lanes(Tag{}));
  const PixelBlock row{points.z.row(v), points.nx.row(v), points.ny.row(v), points.nz.row(v), of_pixel};
  for (int u = 0; u < cells.width(); u += kMostLanes) {
    const int count = std::min(kMostLanes, cells.width() - u);
    if (count == kMostLanes) {
      const PixelBlock block{row.z + u, row.nx + u, row.ny + u, row.nz + u, of_pixel + u};
      for (int lane = 0; lane < count; lane += lanes) associate_block(cells, limits, u + lane, v, lane, block, counts);
      continue;
    }
    std::array<std::array<float, kMostLanes>, 4> rest{};
    std::array<SurfelId, kMostLanes> of_rest{};
    const PixelBlock block{rest[0].data(), rest[1].data(), rest[2].data(), rest[3].data(), of_rest.data()};
    std::copy_n(row.z + u, count, rest[0].begin());
    std::copy_n(row.nx + u, count, rest[1].begin());
    std::copy_n(row.ny + u, count, rest[2].begin());
    std::copy_n(row.nz + u, count, rest[3].begin());
    for (int lane = 0; lane < count; lane += lanes) associate_block(cells, limits, u + lane, v, lane, block, counts);
    std::copy_n(of_rest.begin(), count, of_pixel + u);
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(associate_row_kernel);

}  // namespace

SurfelCells::SurfelCells(int width, int begin, int end)
    : width_{width},
      first_{begin - 1},
      stride_{static_cast<std::size_t>(width) + 2 * kMargin},
      plane_size_{stride_ * static_cast<std::size_t>(end - begin + 2)},
      values_(kPlanes * plane_size_),
      ids_(plane_size_) {
  const auto empty_sides = [&](auto* row, auto value) {
    std::fill_n(row - kMargin, kMargin, value);
    std::fill_n(row + width, kMargin, value);
  };
  for (int v = first_; v <= end; ++v) {
    for (std::size_t plane = 0; plane < kPlanes; ++plane) empty_sides(row(static_cast<Plane>(plane), v), kNowhere);
    empty_sides(ids(v), kNoSurfel);
  }
}

void SurfelCells::set_empty(int v) {
  for (std::size_t plane = 0; plane < kPlanes; ++plane) {
    std::fill_n(row(static_cast<Plane>(plane), v), width_, kNowhere);
  }
  std::fill_n(ids(v), width_, kNoSurfel);
}

void associate_row(const SurfelCells& cells, const PointImage& points, const AssociationLimits& limits, int v,
                   SurfelId* of_pixel, RowCounts& counts) {
  HWY_DYNAMIC_DISPATCH(associate_row_kernel)(cells, points, limits, v, of_pixel, counts);
}

}  // namespace saccade
#endif  // HWY_ONCE
