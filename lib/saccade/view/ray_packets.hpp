// SPDX-License-Identifier: Apache-2.0
#pragma once
// FlatStops and cast_packets: many rays at a time through what stops them.

#include <array>
#include <cstdint>
#include <vector>

#include "saccade/map/ray_math.hpp"
#include "saccade/map/voxel_index.hpp"

namespace saccade {

/// A StopGrid as one flat table of two bits per voxel, for look-ups in vectors.
struct FlatStops {
  static constexpr std::uint32_t kStops{1};
  static constexpr std::uint32_t kScores{2};
  static constexpr int kVoxelsPerWord{16};

  IndexBox voxels;                  ///< holds the rays' origins and scoring_voxels; whole bricks
  std::vector<std::uint32_t> bits;  ///< x fastest; a voxel's two bits above those of the voxels before it
  IndexBox scoring_voxels;          ///< rays end where they leave it

  /// Too large to be tabulated, or not built.
  [[nodiscard]] bool empty() const { return bits.empty(); }
};

/// Rays from one origin that have come to the same slab of voxels.
struct RayPacket {
  static constexpr std::size_t kMost{64};
  LatticePoint origin;
  int major{0};  ///< axis of the slabs
  int slab{0};   ///< nothing is met before
  std::size_t count{0};
  alignas(64) std::array<std::array<float, kMost>, 3> d;  ///< voxels per metre of depth
};

struct PacketTally {
  std::uint64_t scored{0};  ///< bit i: ray i scores
  std::uint64_t cast{0};    ///< rays that meet the box of scoring voxels
};

/// Walks every ray voxel by voxel to the first that stops it, as GainCaster's walk does, to the bit; counts those that
/// score at a depth of at least min_t and enter the voxel no later than max_t.
[[nodiscard]] PacketTally cast_packets(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t);

}  // namespace saccade
