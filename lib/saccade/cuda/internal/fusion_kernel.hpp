// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kernels of depth fusion: ranges of pixels, bricks in view, update of bricks. Thesis eq. (2.1)–(2.3).

#include <cmath>
#include <cstdint>

#include "saccade/cuda/internal/device_map.hpp"
#include "saccade/cuda/internal/kernel.hpp"
#include "saccade/map/internal/tsdf_math.hpp"

namespace saccade::internal::cuda {

/// Arguments that the kernels of one frame share.
struct FusionArguments {
  MapView map;
  tsdf::FusionCamera camera;
  float min_range_m;
  float max_range_m;
  double voxel_size_m;
  double T_camera_world[3][4];
  tsdf::Float3 steps[3];  ///< from voxel to voxel, in camera coordinates
  std::uint16_t max_weight;
  std::uint16_t free_weight;
  float clearing_share;
  TableBox candidates;        ///< bricks that may be in view
  std::uint32_t slots;        ///< room of the pools
  std::uint32_t first_slot;   ///< slots that were taken before this frame
  const float* depths_m;      ///< depth of each pixel, row by row
  float* ranges_m;            ///< likewise
  std::uint32_t* tile_reach;  ///< bits of the largest reach in each tile of pixels
  std::uint32_t* tile_clear;  ///< bits of the largest range up to which all of a tile's beams are clear
  std::uint32_t* reach;       ///< bits of the largest reach of a pixel, which is not negative
  std::uint32_t* valid;       ///< number of pixels with a return
  std::uint32_t* in_view;     ///< candidates in view
  std::uint32_t* in_view_count;
  std::uint32_t* without_slot;  ///< number of those that have no slot yet
  std::uint32_t* new_slots;     ///< slots that this frame takes
  std::uint32_t* updated;       ///< bricks with an observed voxel
};

[[nodiscard]] SACCADE_HD inline float as_float(std::uint32_t bits) {
  float value;
  __builtin_memcpy(&value, &bits, sizeof(value));
  return value;
}
[[nodiscard]] SACCADE_HD inline std::uint32_t as_bits(float value) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &value, sizeof(bits));
  return bits;
}
SACCADE_HD inline void atomic_max(std::uint32_t& value, std::uint32_t candidate) {
  std::uint32_t known = __atomic_load_n(&value, __ATOMIC_RELAXED);
  while (candidate > known &&
         !__atomic_compare_exchange_n(&value, &known, candidate, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
}

/// Centre of a voxel in camera coordinates, as FrameFuser computes it.
[[nodiscard]] SACCADE_HD inline tsdf::Float3 center_in_camera(const FusionArguments& a, const Index3& voxel) {
  const double p[3]{(voxel.x + 0.5) * a.voxel_size_m, (voxel.y + 0.5) * a.voxel_size_m,
                    (voxel.z + 0.5) * a.voxel_size_m};
  float c[3];
  for (int row = 0; row < 3; ++row) {
    const double* T = a.T_camera_world[row];
    c[row] = static_cast<float>(((T[0] * p[0] + T[1] * p[1]) + T[2] * p[2]) + T[3]);
  }
  return {c[0], c[1], c[2]};
}

SACCADE_HD inline void atomic_min(std::uint32_t& value, std::uint32_t candidate) {
  std::uint32_t known = __atomic_load_n(&value, __ATOMIC_RELAXED);
  while (candidate < known &&
         !__atomic_compare_exchange_n(&value, &known, candidate, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
}

constexpr std::uint32_t kPixelTile{16};   ///< pixels along an edge of a tile of the range image
constexpr std::uint8_t kClearByte{0x7F};  ///< four of them are a range beyond every other
[[nodiscard]] SACCADE_HD constexpr std::uint32_t pixel_tiles(int pixels) {
  return (static_cast<std::uint32_t>(pixels) + kPixelTile - 1) / kPixelTile;
}

/// Turns depths into ranges, a pixel per thread and a tile per block (fusion::ranges_of_row). Nothing but the counters
/// has to be cleared before.
struct FindRanges {
  using Arguments = FusionArguments;
  struct Shared {
    std::uint32_t reach;
    std::uint32_t clear;
    std::uint32_t valid;
  };
  static constexpr const char* kName{"saccade_find_ranges"};
  static constexpr unsigned kThreads{kPixelTile * kPixelTile};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{3};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& shared, const Thread& thread) {
    const std::uint32_t tiles_across = pixel_tiles(a.camera.width);
    if constexpr (kPhase == 0) {
      if (thread.index == 0) shared = {0, kClearByte * 0x01010101U, 0};
    } else if constexpr (kPhase == 1) {
      const auto u = static_cast<int>(thread.block % tiles_across * kPixelTile + thread.index % kPixelTile);
      const auto v = static_cast<int>(thread.block / tiles_across * kPixelTile + thread.index / kPixelTile);
      if (u >= a.camera.width || v >= a.camera.height) return;
      const int pixel = v * a.camera.width + u;
      const float depth = a.depths_m[pixel];
      const bool returned = depth >= a.min_range_m && depth <= a.max_range_m;
      const float up_to = depth < -a.max_range_m ? -a.max_range_m : depth;
      const float trusted = returned ? depth : depth < 0.0F ? up_to : 0.0F;
      const float range = tsdf::range_of_depth(a.camera, u, v, trusted);
      a.ranges_m[pixel] = range;
      if (returned) atomic_add(shared.valid, 1U);
      const float reach = range > 0.0F ? range + a.camera.truncation_m : -range;
      if (reach > 0.0F) atomic_max(shared.reach, as_bits(reach));
      const float in_front = range - a.camera.truncation_m;
      if (range > 0.0F) atomic_min(shared.clear, as_bits(in_front > 0.0F ? in_front : 0.0F));
      if (range < 0.0F) atomic_min(shared.clear, as_bits(-range));
    } else if (thread.index == 0) {
      a.tile_reach[thread.block] = shared.reach;
      a.tile_clear[thread.block] = shared.clear;
      atomic_max(*a.reach, shared.reach);
      if (shared.valid != 0) atomic_add(*a.valid, shared.valid);
    }
  }
};

/// Bounds of the beams that may hold a ball.
struct BeamsOfBall {
  float reach_m;
  float clear_m;
};

/// Lists the bricks that may be in view, a candidate per thread: by the ball around their voxels' centres.
struct FindBricksInView {
  using Arguments = FusionArguments;
  struct Shared {};
  static constexpr const char* kName{"saccade_find_bricks_in_view"};
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{1};

  /// Tells whether a ball lies outside the plane through the camera's centre with this inward normal.
  [[nodiscard]] static SACCADE_HD bool outside(float nx, float nz, float x, float z, float radius_m) {
    return nx * x + nz * z < -radius_m * std::sqrt(nx * nx + nz * nz);
  }

  /// Returns the pixels (or tiles) of an axis that a ball at (x, z) may cover, clamped to the image.
  struct Extent {
    int first;
    int last;
  };
  [[nodiscard]] static SACCADE_HD Extent extent(float focal, float center, int pixels, float x, float z,
                                                float radius_m) {
    const float near = z - radius_m;
    const float far = z + radius_m;
    const float low = x - radius_m;
    const float high = x + radius_m;
    const float first = focal * (low / (low < 0.0F ? near : far)) + center - 1.5F;
    const float last = focal * (high / (high > 0.0F ? near : far)) + center + 1.5F;
    const auto most = static_cast<float>(pixels - 1);
    return {static_cast<int>(first < 0.0F   ? 0.0F
                             : first > most ? most
                                            : first) /
                static_cast<int>(kPixelTile),
            static_cast<int>(last < 0.0F   ? 0.0F
                             : last > most ? most
                                           : last) /
                static_cast<int>(kPixelTile)};
  }

  /// Returns the bounds of all beams in the tiles that a ball may cover; nothing better than those of the image where
  /// it is near the camera or covers many tiles.
  [[nodiscard]] static SACCADE_HD BeamsOfBall beams_of(const Arguments& a, float x, float y, float z, float radius_m,
                                                       float reach_m) {
    constexpr int kMostTiles{64};
    if (z < 2.0F * radius_m) return {reach_m, 0.0F};
    const Extent columns = extent(a.camera.fx, a.camera.cx, a.camera.width, x, z, radius_m);
    const Extent rows = extent(a.camera.fy, a.camera.cy, a.camera.height, y, z, radius_m);
    if ((columns.last - columns.first + 1) * (rows.last - rows.first + 1) > kMostTiles) return {reach_m, 0.0F};
    std::uint32_t reach{0};
    std::uint32_t clear{kClearByte * 0x01010101U};
    const auto across = static_cast<int>(pixel_tiles(a.camera.width));
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int column = columns.first; column <= columns.last; ++column) {
        const std::uint32_t tile_reach = a.tile_reach[row * across + column];
        const std::uint32_t tile_clear = a.tile_clear[row * across + column];
        reach = tile_reach > reach ? tile_reach : reach;
        clear = tile_clear < clear ? tile_clear : clear;
      }
    }
    return {as_float(reach), as_float(clear)};
  }

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& /*shared*/, const Thread& thread) {
    const std::uint64_t at = std::uint64_t{thread.block} * kThreads + thread.index;
    if (at >= a.candidates.count()) return;
    const float reach_m = as_float(*a.reach);
    if (!(reach_m > 0.0F)) return;
    const Index3 brick = a.candidates.index(at);
    const tsdf::Float3 first = center_in_camera(a, brick * kBrickEdge);
    constexpr float kHalf{3.5F};     // from the first voxel's centre to the middle
    constexpr float kSlack{1.001F};  // far above the rounding
    constexpr float kSlack_m{1e-4F};
    const auto along = [&](float from, float x, float y, float z) { return from + kHalf * (x + y + z); };
    const float x = along(first.x, a.steps[0].x, a.steps[1].x, a.steps[2].x);
    const float y = along(first.y, a.steps[0].y, a.steps[1].y, a.steps[2].y);
    const float z = along(first.z, a.steps[0].z, a.steps[1].z, a.steps[2].z);
    const float radius_m = kHalf * 1.7320508F * static_cast<float>(a.voxel_size_m) * kSlack + kSlack_m;
    if (z + radius_m < tsdf::kNearestZ) return;
    if (std::sqrt(x * x + y * y + z * z) - radius_m > reach_m) return;
    const tsdf::FusionCamera& c = a.camera;
    const float left = (-0.51F - c.cx) / c.fx;
    const float right = (static_cast<float>(c.width) - 0.49F - c.cx) / c.fx;
    const float top = (-0.51F - c.cy) / c.fy;
    const float bottom = (static_cast<float>(c.height) - 0.49F - c.cy) / c.fy;
    if (outside(1.0F, -left, x, z, radius_m) || outside(-1.0F, right, x, z, radius_m) ||
        outside(1.0F, -top, y, z, radius_m) || outside(-1.0F, bottom, y, z, radius_m)) {
      return;
    }
    const float range = std::sqrt(x * x + y * y + z * z);
    const BeamsOfBall beams = beams_of(a, x, y, z, radius_m, reach_m);
    if (range - radius_m > beams.reach_m) return;
    const BrickEntry entry = a.map.entry(brick);
    const bool saturated = !entry.stored() && entry.weight() == a.free_weight;
    if (saturated && range + radius_m < beams.clear_m) return;  // seen free again, or not at all
    if (!entry.stored()) atomic_add(*a.without_slot, 1U);
    a.in_view[atomic_add(*a.in_view_count, 1U)] = static_cast<std::uint32_t>(at);
  }
};

/// Observes the voxels of a brick in view, four per thread, and updates them (eq. 2.2 and 2.3). A brick that is unknown
/// or constant free stays so where every voxel is seen free; else it gets a slot.
struct FuseBricks {
  using Arguments = FusionArguments;
  static constexpr unsigned kThreads{128};
  static constexpr unsigned kEach{kBrickVoxels / kThreads};
  struct Shared {
    std::int16_t samples[kBrickVoxels];
    std::uint32_t unknown[2 * kBrickWords];  ///< halves of words, low one first: 32 bits are the GPU's own atomics
    std::uint32_t occupied[2 * kBrickWords];
    std::int32_t brick[3];
    std::uint64_t place;     ///< index into the table
    std::uint32_t seen;      ///< number of voxels
    std::uint32_t seen_one;  ///< number of voxels with a sample of 1
    BrickEntry before;
    BrickEntry after;
    bool update;
  };
  static constexpr const char* kName{"saccade_fuse_bricks"};
  static constexpr unsigned kBlocksPerUnit{1};
  static constexpr int kPhases{5};

  template <int kPhase>
  static SACCADE_HD void run(const Arguments& a, Shared& shared, const Thread& thread) {
    if (thread.block >= *a.in_view_count) return;
    if constexpr (kPhase == 0) {
      if (thread.index < 2 * kBrickWords) shared.unknown[thread.index] = shared.occupied[thread.index] = 0;
      if (thread.index == 0) {
        shared.seen = shared.seen_one = 0;
        const Index3 brick = a.candidates.index(a.in_view[thread.block]);
        shared.brick[0] = brick.x;
        shared.brick[1] = brick.y;
        shared.brick[2] = brick.z;
        shared.place = a.map.bricks.at(brick);
        shared.before = a.map.entries[shared.place];
        shared.update = false;
      }
    } else if constexpr (kPhase == 1) {
      sample(a, shared, thread);
    } else if constexpr (kPhase == 2) {
      if (thread.index == 0) decide(a, shared);
    } else if constexpr (kPhase == 3) {
      if (shared.update) update(a, shared, thread);
    } else if (shared.update) {
      write_masks(a, shared, thread);
    } else if (thread.index == 0 && shared.after.bits != shared.before.bits) {
      a.map.entries[shared.place] = shared.after;
      a.map.touched[shared.place] = 1;
    }
  }

  static SACCADE_HD void sample(const Arguments& a, Shared& shared, const Thread& thread) {
    const Index3 brick{shared.brick[0], shared.brick[1], shared.brick[2]};
    const tsdf::BrickFrame frame{center_in_camera(a, brick * kBrickEdge), a.steps[0], a.steps[1], a.steps[2]};
    std::uint32_t seen{0};
    std::uint32_t seen_one{0};
    for (unsigned i = thread.index; i < kBrickVoxels; i += kThreads) {
      const Index3 at = child_offset(static_cast<int>(i));
      const tsdf::Float3 p = tsdf::voxel_in_camera(frame, at.x, at.y, at.z);
      const tsdf::Pixel pixel = tsdf::pixel_of(a.camera, p);
      const float range = pixel.inside ? a.ranges_m[pixel.v * a.camera.width + pixel.u] : 0.0F;
      const int sample = tsdf::sample_voxel(a.camera, p, range);
      shared.samples[i] = static_cast<std::int16_t>(sample);
      seen += sample != tsdf::kNotSeen ? 1U : 0U;
      seen_one += sample == tsdf::kSampleOne ? 1U : 0U;
    }
    if (seen != 0) atomic_add(shared.seen, seen);
    if (seen_one != 0) atomic_add(shared.seen_one, seen_one);
  }

  static SACCADE_HD void decide(const Arguments& a, Shared& shared) {
    shared.after = shared.before;
    if (shared.seen == 0) return;
    atomic_add(*a.updated, 1U);
    if (!shared.before.stored()) {
      const bool saturated = shared.before.weight() == a.free_weight && shared.seen_one == shared.seen;
      if (saturated) return;
      if (shared.seen_one == kBrickVoxels) {
        shared.after = BrickEntry::free(shared.before.weight() + 1);
        return;
      }
      const std::uint32_t slot = a.first_slot + atomic_add(*a.new_slots, 1U);
      if (slot >= a.slots) return;  // the caller makes room first; see GpuFusion::integrate
      shared.after = BrickEntry::at(slot, true, false);
    }
    shared.update = true;
  }

  static SACCADE_HD void update(const Arguments& a, Shared& shared, const Thread& thread) {
    const std::uint64_t first = std::uint64_t{shared.after.slot()} * kBrickVoxels;
    const auto weight = static_cast<std::uint16_t>(shared.before.weight());
    const bool is_new = !shared.before.stored();
    for (unsigned i = thread.index; i < kBrickVoxels; i += kThreads) {
      std::int16_t& stored_v = a.map.v[first + i];
      std::uint16_t& stored_w = a.map.w[first + i];
      std::int16_t v = is_new ? static_cast<std::int16_t>(weight == 0 ? 0 : tsdf::kSampleOne) : stored_v;
      std::uint16_t w = is_new ? weight : stored_w;
      const int sample = shared.samples[i];
      if (sample != tsdf::kNotSeen) {
        v = tsdf::average_v(v, w, tsdf::clearing_sample(v, w, sample, a.clearing_share));
        w = tsdf::next_w(v, w, a.max_weight, a.free_weight);
      }
      if (is_new || sample != tsdf::kNotSeen) {
        stored_v = v;
        stored_w = w;
      }
      if (w == 0) atomic_or(shared.unknown[i >> 5U], 1U << (i & 31U));
      if (w != 0 && v <= 0) atomic_or(shared.occupied[i >> 5U], 1U << (i & 31U));
    }
  }

  [[nodiscard]] static SACCADE_HD std::uint64_t word_of(const std::uint32_t (&halves)[2 * kBrickWords], unsigned word) {
    return std::uint64_t{halves[2 * word]} | std::uint64_t{halves[2 * word + 1]} << 32U;
  }

  static SACCADE_HD void write_masks(const Arguments& a, const Shared& shared, const Thread& thread) {
    const std::uint64_t slot = shared.after.slot();
    if (thread.index < kBrickWords) {
      a.map.unknown[slot * kBrickWords + thread.index] = word_of(shared.unknown, thread.index);
      a.map.occupied[slot * kBrickWords + thread.index] = word_of(shared.occupied, thread.index);
    }
    if (thread.index == 0) {
      std::uint32_t unknown{0};
      std::uint32_t occupied{0};
      for (int half = 0; half < 2 * kBrickWords; ++half) {
        unknown |= shared.unknown[half];
        occupied |= shared.occupied[half];
      }
      a.map.entries[shared.place] = BrickEntry::at(shared.after.slot(), (unknown | occupied) != 0, occupied != 0);
      a.map.touched[shared.place] = 1;
    }
  }
};

}  // namespace saccade::internal::cuda
