// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/state_volume.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace saccade {
namespace {

/// Returns for each byte eight bytes, which are 1 where the bit is set.
constexpr std::array<std::uint64_t, 256> bytes_of_bits() {
  std::array<std::uint64_t, 256> bytes{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    for (std::size_t bit = 0; bit < 8; ++bit)
      bytes[byte] |= static_cast<std::uint64_t>((byte >> bit) & 1U) << (8 * bit);
  }
  return bytes;
}
constexpr std::array<std::uint64_t, 256> kBytesOfBits{bytes_of_bits()};
static_assert(static_cast<int>(VoxelState::empty) == 1 && static_cast<int>(VoxelState::occupied) == 2);
static_assert(std::endian::native == std::endian::little);

/// Calls write(first voxel, states, count) for the rows of a brick that lie in the box.
template <class Write>
void for_rows(const BrickRef& brick, const Index3& corner, const IndexBox& box, const Write& write) {
  const Mask512 unknown = brick.unknown_mask();
  const Mask512 occupied = brick.occupied_mask();
  const IndexBox part = IndexBox::cube(corner, kBrickEdge).intersection(box);
  const std::int32_t skipped = part.lo.x - corner.x;
  for (std::int32_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int32_t y = part.lo.y; y < part.hi.y; ++y) {
      const auto slice = static_cast<std::size_t>(z - corner.z);
      const auto shift = static_cast<unsigned>(8 * (y - corner.y));
      const auto is_unknown = static_cast<std::size_t>((unknown.words[slice] >> shift) & 0xFFU);
      const auto is_occupied = static_cast<std::size_t>((occupied.words[slice] >> shift) & 0xFFU);
      const std::uint64_t states = kBytesOfBits[~is_unknown & 0xFFU] + kBytesOfBits[is_occupied];
      std::array<VoxelState, 8> row;
      std::memcpy(row.data(), &states, sizeof states);
      write(Index3{part.lo.x, y, z}, row.data() + skipped, part.size().x);
    }
  }
}

}  // namespace

Result<StateVolume> StateVolume::unknown(const TsdfSnapshot& map, const IndexBox& box) {
  StateVolume volume;
  volume.voxel_size_m_ = map.config.voxel_size_m;
  if (box.empty()) return volume;
  if (box.count() > kMostVoxels) {
    return Error{Errc::invalid_argument, "the workspace holds too many voxels to look through; make it smaller",
                 "expected surface"};
  }
  volume.box_ = box;
  volume.row_ = box.size().x;
  volume.layer_ = volume.row_ * box.size().y;
  volume.states_.assign(static_cast<std::size_t>(volume.layer_) * static_cast<std::size_t>(box.size().z),
                        VoxelState::unknown);
  return volume;
}

Result<StateVolume> StateVolume::read(const TsdfSnapshot& map, const IndexBox& box, ViewDevice& device) {
  SACCADE_TRY(StateVolume volume, unknown(map, box));
  if (volume.size() > 0) {
    SACCADE_TRY(volume.ticket_, device.read_states(volume.box_, volume.states_));
  }
  return volume;
}

Result<StateVolume> StateVolume::read(const TsdfSnapshot& map, const IndexBox& box, const Executor& executor) {
  SACCADE_TRY(StateVolume volume, unknown(map, box));
  if (volume.size() == 0) return volume;
  const SectorTable sectors{map.grid};
  const IndexBox bricks = parents(box);
  executor.parallel_for(static_cast<std::size_t>(bricks.size().z), 1, [&](std::size_t begin, std::size_t) {
    bricks.layer(begin).for_each([&](const Index3& key) {
      const Sector* sector = sectors.find(parent(key));
      if (sector == nullptr) return;
      const BrickRef& brick = sector->bricks[static_cast<std::size_t>(child_index(key))];
      if (brick.is_unknown()) return;
      const Index3 corner = key * kBrickEdge;
      if (brick.kind() == BrickKind::constant_free) {
        const IndexBox part = IndexBox::cube(corner, kBrickEdge).intersection(box);
        for (std::int32_t z = part.lo.z; z < part.hi.z; ++z) {
          for (std::int32_t y = part.lo.y; y < part.hi.y; ++y) {
            std::fill_n(volume.states_.begin() + static_cast<std::ptrdiff_t>(volume.index({part.lo.x, y, z})),
                        part.size().x, VoxelState::empty);
          }
        }
        return;
      }
      for_rows(brick, corner, box, [&](const Index3& first, const VoxelState* states, std::int32_t count) {
        std::copy_n(states, count, volume.states_.begin() + static_cast<std::ptrdiff_t>(volume.index(first)));
      });
    });
  });
  return volume;
}

StateBox StateVolume::state_box() const {
  static_assert(static_cast<std::uint8_t>(VoxelState::unknown) == StateBox::kUnknown &&
                static_cast<std::uint8_t>(VoxelState::empty) == StateBox::kEmpty &&
                static_cast<std::uint8_t>(VoxelState::occupied) == StateBox::kOccupied);
  return {box_.lo, box_.size(), voxel_size_m_, reinterpret_cast<const std::uint8_t*>(states_.data())};
}

bool StateVolume::is_visible(std::size_t voxel, const Eigen::Vector3d& camera_m, double through_m) const {
  return is_in_sight(state_box(), static_cast<std::int64_t>(voxel), {camera_m.x(), camera_m.y(), camera_m.z()},
                     through_m);
}

}  // namespace saccade
