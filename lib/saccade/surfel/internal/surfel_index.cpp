// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/surfel_index.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/internal/surfel_index.cpp"
#include "saccade/core/simd_kernels.hpp"
#include "saccade/surfel/internal/surfel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

using IdTag = hn::RebindToUnsigned<Tag>;

struct Discs {
  Vector position;
  V radius;
  Vector normal;
};

/// Loads one disc per lane, one after the other; of the groups of four loaded, every second holds a normal.
HWY_INLINE Discs load_discs(const float* from) {
  const Tag d;
  V low[4];
  V high[4];
  hn::LoadInterleaved4(d, from, low[0], low[1], low[2], low[3]);
  hn::LoadInterleaved4(d, from + 4 * hn::Lanes(d), high[0], high[1], high[2], high[3]);
  const auto place = [&](int i) HWY_ATTR { return hn::ConcatEven(d, high[i], low[i]); };
  const auto normal = [&](int i) HWY_ATTR { return hn::ConcatOdd(d, high[i], low[i]); };
  return {{place(0), place(1), place(2)}, place(3), {normal(0), normal(1), normal(2)}};
}

std::size_t project_kernel(const FloatView& view, std::span<const SurfelDisc> discs, SurfelId first,
                           std::span<ProjectedSurfel, kMaxProjected> landings) {
  const Tag d;
  const IdTag di;
  const std::size_t lanes = hn::Lanes(d);
  const V zero = hn::Zero(d);
  std::array<SurfelDisc, kMostLanes> rest;
  std::array<std::uint32_t, kMostLanes> cells;
  std::array<float, kMostLanes> depths;
  std::size_t count{0};
  for (std::size_t i = 0; i < discs.size(); i += lanes) {
    const float* from = discs[i].position_m.data();
    if (discs.size() - i < lanes) {
      std::memset(static_cast<void*>(rest.data()), 0, sizeof rest);
      std::copy(discs.begin() + static_cast<std::ptrdiff_t>(i), discs.end(), rest.begin());
      from = rest[0].position_m.data();
    }
    const Discs here = load_discs(from);
    const Vector p = difference(here.position, set(view.center_world));
    const V z = row_dot(view.R_camera_world, 2, p);
    const V inverse_z = hn::Div(set(1.0F), z);
    const auto column = [&](Eigen::Index row, float focal, float center) HWY_ATTR {
      const V along = hn::Mul(hn::Mul(row_dot(view.R_camera_world, row, p), inverse_z), set(focal));
      return hn::Add(hn::Add(along, set(center)), set(0.5F));
    };
    const V u = column(0, view.fx, view.cx);
    const V v = column(1, view.fy, view.cy);
    const auto in_columns = hn::And(hn::Ge(u, zero), hn::Lt(u, set(static_cast<float>(view.width))));
    const auto in_rows = hn::And(hn::Ge(v, zero), hn::Lt(v, set(static_cast<float>(view.height))));
    const auto faces = hn::Not(hn::Ge(dot(here.normal, p), zero));
    const auto lands = hn::And(hn::And(hn::Gt(z, zero), hn::FirstN(d, discs.size() - i)),
                               hn::And(faces, hn::And(in_columns, in_rows)));
    if (hn::AllFalse(d, lands)) continue;
    const hn::RebindToSigned<Tag> ds;
    const auto whole = [&](V value)
                           HWY_ATTR { return hn::BitCast(di, hn::ConvertTo(ds, hn::IfThenElseZero(lands, value))); };
    const auto cell = hn::Add(hn::Mul(whole(v), hn::Set(di, static_cast<std::uint32_t>(view.width))), whole(u));
    hn::StoreU(cell, di, cells.data());
    hn::StoreU(z, d, depths.data());
    std::uint64_t bits{0};
    hn::StoreMaskBits(d, lands, reinterpret_cast<std::uint8_t*>(&bits));
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      landings[count++] = {cells[lane], first + static_cast<SurfelId>(i + lane), depths[lane]};
    }
  }
  return count;
}

constexpr std::size_t kBatch{64};

void fill_row_kernel(const FloatView& view, const SurfelMap& map, const SurfelId* ids, int v, SurfelCells& cells) {
  const Tag d;
  const IdTag di;
  const auto width = static_cast<std::size_t>(view.width);
  SurfelDisc discs[kBatch];
  SurfelId of_cell[kBatch];
  std::memset(static_cast<void*>(discs), 0, sizeof discs);
  for (std::size_t first = 0; first < width; first += kBatch) {
    const std::size_t count = std::min(kBatch, width - first);
    std::fill(std::copy_n(ids + first, count, of_cell), of_cell + kBatch, kNoSurfel);
    for (std::size_t k = 0; k < count; ++k) {
      if (first + k + kBatch < width && ids[first + k + kBatch] != kNoSurfel) {
        __builtin_prefetch(&map.discs[ids[first + k + kBatch]]);
      }
      if (of_cell[k] != kNoSurfel) std::memcpy(static_cast<void*>(&discs[k]), &map.discs[of_cell[k]], sizeof discs[k]);
    }
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
      const Discs here = load_discs(discs[k].position_m.data());
      const auto id = hn::LoadU(di, of_cell + k);
      const auto is_filled = hn::RebindMask(d, hn::Ne(id, hn::Set(di, kNoSurfel)));
      const std::ptrdiff_t u = static_cast<std::ptrdiff_t>(first + k);
      const auto put = [&](SurfelCells::Plane plane, V value) HWY_ATTR {
        hn::StoreU(hn::IfThenElse(is_filled, value, set(SurfelCells::kNowhere)), d, cells.row(plane, v) + u);
      };
      const Vector p = difference(here.position, set(view.center_world));
      put(SurfelCells::kX, row_dot(view.R_camera_world, 0, p));
      put(SurfelCells::kY, row_dot(view.R_camera_world, 1, p));
      put(SurfelCells::kZ, row_dot(view.R_camera_world, 2, p));
      put(SurfelCells::kSquaredRadius, hn::Mul(here.radius, here.radius));
      put(SurfelCells::kNx, row_dot(view.R_camera_world, 0, here.normal));
      put(SurfelCells::kNy, row_dot(view.R_camera_world, 1, here.normal));
      put(SurfelCells::kNz, row_dot(view.R_camera_world, 2, here.normal));
      hn::StoreU(id, di, cells.ids(v) + u);
    }
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(project_kernel);
HWY_EXPORT(fill_row_kernel);

}  // namespace

std::size_t project_discs(const FloatView& view, std::span<const SurfelDisc> discs, SurfelId first,
                          std::span<ProjectedSurfel, kMaxProjected> landings) {
  return HWY_DYNAMIC_DISPATCH(project_kernel)(view, discs, first, landings);
}

void fill_row(const FloatView& view, const SurfelMap& map, const SurfelId* ids, int v, SurfelCells& cells) {
  HWY_DYNAMIC_DISPATCH(fill_row_kernel)(view, map, ids, v, cells);
}

}  // namespace saccade
#endif  // HWY_ONCE
