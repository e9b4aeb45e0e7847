// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/mode_search.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/mode_search.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::CappedTag<std::int64_t, 8>;
using UnsignedWide = hn::RebindToUnsigned<Wide>;
using W = hn::Vec<Wide>;

HWY_INLINE W squared(W difference) {
  const hn::RepartitionToNarrow<Wide> halves;
  return hn::MulEven(hn::BitCast(halves, difference), hn::BitCast(halves, difference));
}

/// Computes the squared distances of the next colours from `packed`, one per lane.
HWY_INLINE W squared_distances(const std::uint64_t* packed, W r, W g, W b) {
  const Wide d;
  const auto colors = hn::LoadU(UnsignedWide{}, packed);
  const auto channel = hn::Set(UnsignedWide{}, (std::uint64_t{1} << ColorUnits::kBits) - 1);
  const W red = hn::BitCast(d, hn::And(colors, channel));
  const W green = hn::BitCast(d, hn::And(hn::ShiftRight<ColorUnits::kBits>(colors), channel));
  const W blue = hn::BitCast(d, hn::ShiftRight<2 * ColorUnits::kBits>(colors));
  return hn::Add(hn::Add(squared(hn::Sub(red, r)), squared(hn::Sub(green, g))), squared(hn::Sub(blue, b)));
}

constexpr int kIndexBits{5};

HWY_INLINE void fetch(const ColorQuery& query, std::size_t room) {
  constexpr std::size_t kPerLine{64 / sizeof(std::uint64_t)};
  for (std::size_t i = 0; i < room; i += kPerLine) hwy::Prefetch(query.packed + i);
}

void nearest_kernel(std::span<ColorQuery> queries, std::size_t room) {
  const Wide d;
  const W lane = hn::Iota(d, 0);
  const std::size_t last = std::max(room, hn::Lanes(d)) - hn::Lanes(d);  // the last vector ends with `room`
  const ColorQuery* ahead = queries.data() + std::min(kQueriesAhead, queries.size());
  const ColorQuery* const end_of_queries = queries.data() + queries.size();
  for (ColorQuery& query : queries) {
    if (ahead != end_of_queries) fetch(*ahead++, room);
    const W r = hn::Set(d, query.color.r);
    const W g = hn::Set(d, query.color.g);
    const W b = hn::Set(d, query.color.b);
    const W end = hn::Set(d, static_cast<std::int64_t>(query.count));
    W least = hn::Set(d, std::numeric_limits<std::int64_t>::max());
    for (std::size_t i = 0; i < room; i += hn::Lanes(d)) {  // fixed number of rounds: no unpredictable branch
      const std::size_t first = std::min(i, last);
      const W index = hn::Add(lane, hn::Set(d, static_cast<std::int64_t>(first)));
      const W key = hn::Or(hn::ShiftLeft<kIndexBits>(squared_distances(query.packed + first, r, g, b)), index);
      least = hn::IfThenElse(hn::And(hn::Lt(index, end), hn::Lt(key, least)), key, least);
    }
    const std::int64_t key = hn::GetLane(hn::MinOfLanes(d, least));
    query.nearest = {static_cast<std::size_t>(key) & ((std::size_t{1} << kIndexBits) - 1), key >> kIndexBits};
  }
}

void nearby_kernel(std::span<NearbyQuery> queries) {
  const Wide d;
  for (NearbyQuery& query : queries) {
    const W r = hn::Set(d, query.color.r);
    const W g = hn::Set(d, query.color.g);
    const W b = hn::Set(d, query.color.b);
    const W limit = hn::Set(d, query.squared_units + 1);
    std::uint64_t bits{0};
    const std::size_t last = std::max(query.count, hn::Lanes(d)) - hn::Lanes(d);
    for (std::size_t i = 0; i < query.count; i += hn::Lanes(d)) {
      const std::size_t first = std::min(i, last);
      const auto inside = hn::Lt(squared_distances(query.packed + first, r, g, b), limit);
      std::uint64_t here{0};
      hn::StoreMaskBits(d, inside, reinterpret_cast<std::uint8_t*>(&here));
      bits |= here << first;
    }
    query.nearby = static_cast<std::uint32_t>(bits & ((std::uint64_t{1} << query.count) - 1));
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(nearest_kernel);
HWY_EXPORT(nearby_kernel);

}  // namespace

void find_nearest(std::span<ColorQuery> queries, std::size_t room) {
  HWY_DYNAMIC_DISPATCH(nearest_kernel)(queries, room);
}

void find_nearby(std::span<NearbyQuery> queries) { HWY_DYNAMIC_DISPATCH(nearby_kernel)(queries); }

}  // namespace saccade
#endif  // HWY_ONCE
