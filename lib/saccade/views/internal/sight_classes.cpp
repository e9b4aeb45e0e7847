// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/sight_classes.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

namespace saccade {
namespace {

using Row = std::vector<SightClass>;

/// Writes the classes of a row of voxels that lies within the region, or outside.
void classify(std::span<const VoxelState> states, SightClass unknown, Row& row) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    row[i] = states[i] == VoxelState::unknown    ? unknown
             : states[i] == VoxelState::occupied ? SightClass::surface
                                                 : SightClass::passes;
  }
}

/// Returns the lowest two bits of eight bytes next to each other.
std::uint64_t packed(const SightClass* classes) {
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t bits{0};
  std::memcpy(&bits, classes, sizeof bits);
  bits = (bits | bits >> 6U) & 0x000F000F000F000FU;
  bits = (bits | bits >> 12U) & 0x000000FF000000FFU;
  return (bits | bits >> 24U) & 0xFFFFU;
}

}  // namespace

SightClasses::SightClasses(const StateVolume& volume, const Region& region, UnknownOutside outside,
                           const Executor& executor)
    : box_{volume.box()}, voxel_size_m_{volume.voxel_size_m()} {
  const Index3 size = box_.size();
  const std::ptrdiff_t words_per_row = (std::ptrdiff_t{size.x} + kPerWord - 1) / kPerWord;
  strides_ = {1, words_per_row * kPerWord, words_per_row * kPerWord * size.y};
  if (volume.size() == 0) return;
  const std::size_t rows = static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  words_.resize(rows * static_cast<std::size_t>(words_per_row));
  const SightClass unknown_outside = outside == UnknownOutside::blocks ? SightClass::blocks : SightClass::passes;
  constexpr std::size_t kRowsPerTask{1024};
  executor.parallel_for(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    Row row(static_cast<std::size_t>(strides_[1]), SightClass::passes);
    for (std::size_t i = begin; i < end; ++i) {
      const std::span states{volume.data() + i * static_cast<std::size_t>(size.x), static_cast<std::size_t>(size.x)};
      const Index3 first = volume.voxel(i * static_cast<std::size_t>(size.x));
      const Box centers{voxel_center(first, voxel_size_m_),
                        voxel_center(first + Index3{size.x - 1, 0, 0}, voxel_size_m_)};
      const Overlap in_region = overlap(region, centers);
      classify(states, in_region == Overlap::none ? unknown_outside : SightClass::promise, row);
      for (std::int32_t x = 0; in_region == Overlap::partial && x < size.x; ++x) {
        SightClass& of_voxel = row[static_cast<std::size_t>(x)];
        if (of_voxel != SightClass::promise) continue;
        if (!contains(region, voxel_center(first + Index3{x, 0, 0}, voxel_size_m_))) of_voxel = unknown_outside;
      }
      std::uint64_t* words = words_.data() + i * static_cast<std::size_t>(words_per_row);
      for (std::size_t x = 0; x < row.size(); x += 8) {
        words[x / kPerWord] |= packed(row.data() + x) << (2 * (x % kPerWord));
      }
    }
  });
}

Index3 SightClasses::voxel(std::size_t place) const {
  const auto i = static_cast<std::ptrdiff_t>(place);
  return box_.lo + Index3{static_cast<std::int32_t>(i % strides_[1]),
                          static_cast<std::int32_t>(i % strides_[2] / strides_[1]),
                          static_cast<std::int32_t>(i / strides_[2])};
}

}  // namespace saccade
