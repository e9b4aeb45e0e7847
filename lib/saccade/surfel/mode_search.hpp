// SPDX-License-Identifier: Apache-2.0
#pragma once
// ColorUnits: a colour in whole numbers; find_nearest and find_nearby: searches in the colours of a surfel's modes.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade {

/// A colour, a channel in 8192nds of an 8-bit level: fine enough for means of 10⁵ frames, and distances are exact.
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

/// Weighted mean, in whole units: `share` of the way from a to b.
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

/// Among which colours a colour's nearest is wanted, and the answer.
struct ColorQuery {
  const std::uint64_t* packed;
  std::size_t count;  ///< 0 to 32
  ColorUnits color;
  NearestColor nearest;  ///< argmin_i ‖c_i − c‖, the first of those that are equally near; unset for no colours
};

/// Answers queries. Of each query's packed colours `room`, and at least eight, must be readable; those from its count
/// on are ignored. One after the other is much quicker than one alone: searches overlap. simd_target() changes nothing.
/// Memory is asked for the colours of later queries meanwhile, kQueriesAhead before they are read: much farther ahead
/// they would be gone from the nearest cache by then. Those of the first so many the caller may ask for.
void find_nearest(std::span<ColorQuery> queries, std::size_t room);
constexpr std::size_t kQueriesAhead{32};

/// Which colours are how near to a colour, and the answer.
struct NearbyQuery {
  const std::uint64_t* packed;
  std::size_t count;  ///< 1 to 32
  ColorUnits color;
  std::int64_t squared_units;
  std::uint32_t nearby;  ///< bit i: ‖c_i − c‖² ≤ squared_units
};

/// Answers queries; at least eight colours must be readable. As find_nearest, but asks for no memory.
void find_nearby(std::span<NearbyQuery> queries);

}  // namespace saccade
