// SPDX-License-Identifier: Apache-2.0
#pragma once
// ColorUnits: a colour in integers. find_nearest and find_nearby: searches among the colours of a surfel's modes.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade {

/// Colour with channels in 8192nds of an 8-bit level: fine enough for means of 10⁵ frames, with exact distances.
struct ColorUnits {
  static constexpr int kPerLevel{8192};
  static constexpr int kBits{21};

  std::int32_t r, g, b;

  [[nodiscard]] std::uint64_t packed() const {
    return static_cast<std::uint64_t>(r) | (static_cast<std::uint64_t>(g) << kBits) |
           (static_cast<std::uint64_t>(b) << 2 * kBits);
  }
  [[nodiscard]] static ColorUnits unpacked(std::uint64_t packed) {
    constexpr std::uint64_t kChannel{(std::uint64_t{1} << kBits) - 1};
    return {static_cast<std::int32_t>(packed & kChannel), static_cast<std::int32_t>((packed >> kBits) & kChannel),
            static_cast<std::int32_t>(packed >> 2 * kBits)};
  }
};

/// Returns the weighted mean in integer units, at `share` of the way from a to b.
inline ColorUnits mean_color(const ColorUnits& a, const ColorUnits& b, float share) {
  const auto between = [share](std::int32_t from, std::int32_t to) {
    return from + static_cast<std::int32_t>(std::nearbyintf(static_cast<float>(to - from) * share));
  };
  return {between(a.r, b.r), between(a.g, b.g), between(a.b, b.b)};
}

inline std::int64_t squared_distance(const ColorUnits& a, const ColorUnits& b) {
  const auto squared = [](std::int64_t x) { return x * x; };
  return squared(a.r - b.r) + squared(a.g - b.g) + squared(a.b - b.b);
}

struct NearestColor {
  std::size_t index;
  std::int64_t squared_units;
};

/// Colours to search, the colour whose nearest is wanted, and the answer.
struct ColorQuery {
  const std::uint64_t* packed;
  std::size_t count;  ///< 0 to 32
  ColorUnits color;
  NearestColor nearest;  ///< argmin_i ‖c_i − c‖, the first at a tie; unset without colours
};

/// Answers queries. Of each query's packed colours, `room` and at least eight must be readable; those beyond its count
/// are ignored. Many queries in a row are much faster than single ones, because searches overlap. simd_target() changes
/// nothing. Prefetches the colours of later queries, kQueriesAhead before they are read: much earlier they would be
/// evicted from the nearest cache again. The caller may prefetch the colours of the first kQueriesAhead queries.
void find_nearest(std::span<ColorQuery> queries, std::size_t room);
constexpr std::size_t kQueriesAhead{32};

/// Colours to search, a colour and a distance, and the answer.
struct NearbyQuery {
  const std::uint64_t* packed;
  std::size_t count;  ///< 1 to 32
  ColorUnits color;
  std::int64_t squared_units;
  std::uint32_t nearby;  ///< bit i: ‖c_i − c‖² ≤ squared_units
};

/// Answers queries as find_nearest does, without prefetching; at least eight colours must be readable.
void find_nearby(std::span<NearbyQuery> queries);

}  // namespace saccade
