// SPDX-License-Identifier: Apache-2.0
#pragma once
// FlatStops, cast_with_others, finish_rays and cast_alone: casts many rays at a time.

#include <array>
#include <cstdint>
#include <vector>

#include "saccade/map/ray_math.hpp"
#include "saccade/map/voxel_index.hpp"

namespace saccade {

/// StopGrid as one flat table of two bits per voxel, for look-ups in vectors.
struct FlatStops {
  static constexpr std::uint32_t kStops{1};
  static constexpr std::uint32_t kScores{2};
  static constexpr int kVoxelsPerWord{16};

  IndexBox voxels;                  ///< holds the rays' origins and scoring_voxels; whole bricks
  std::vector<std::uint32_t> bits;  ///< x fastest; a voxel's two bits above those of the voxels before it
  IndexBox scoring_voxels;          ///< rays end where they leave this box

  /// Tells whether the table is missing because it is too large or was not built.
  [[nodiscard]] bool empty() const { return bits.empty(); }
};

/// Rays from one origin that have reached one slab of voxels.
struct RayPacket {
  static constexpr std::size_t kMost{64};
  LatticePoint origin;
  int major{0};  ///< axis of the slabs
  int slab{0};   ///< no voxel is met before this slab
  std::size_t count{0};
  alignas(64) std::array<std::array<float, kMost>, 3> d;  ///< voxels per metre of depth
};

/// Unfinished rays that wait until enough are there to fill a vector. All from one origin.
struct RayQueue {
  static constexpr std::size_t kRoom{48};  ///< fewer than two vectors of 16 wait, and they are stored whole
  std::size_t count{0};
  alignas(64) std::array<std::array<float, kRoom>, 3> inv;
  alignas(64) std::array<std::array<float, kRoom>, 3> plane;
  alignas(64) std::array<float, kRoom> entered_t;
  alignas(64) std::array<float, kRoom> exit_t;
  alignas(64) std::array<std::int32_t, kRoom> exit_axis;
  alignas(64) std::array<std::int32_t, kRoom> voxel;
  alignas(64) std::array<std::int32_t, kRoom> ray;  ///< index in their packet
};

struct PacketTally {
  std::uint64_t cast{0};    ///< rays that meet the box of scoring voxels
  std::uint64_t scored{0};  ///< scoring rays among the finished ones
};

/// Walks rays voxel by voxel to the first that stops them, to the bit as GainCaster's walk does. Counts the rays that
/// score at a depth of at least min_t and enter the voxel no later than max_t. The last few unfinished rays wait, and
/// continue with those of later packets.
[[nodiscard]] PacketTally cast_with_others(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t,
                                           RayQueue& waiting);
/// Finishes the waiting rays; returns how many of them score.
[[nodiscard]] std::uint64_t finish_rays(const LatticePoint& origin, const FlatStops& stops, float min_t,
                                        RayQueue& waiting);

struct ScoringRays {
  std::uint64_t which{0};  ///< bit i: ray i of the packet scores
  std::uint64_t cast{0};
};
/// Walks all of a packet's rays without any other.
[[nodiscard]] ScoringRays cast_alone(const RayPacket& packet, const FlatStops& stops, float min_t, float max_t);

}  // namespace saccade
