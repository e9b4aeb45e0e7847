// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/internal/surface_block.hpp"

#include <algorithm>

namespace saccade {

namespace {

Index3 offset_of(std::size_t n) {
  const auto i = static_cast<std::int32_t>(n);
  return {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
}

std::array<Mask512, 27> make_borders() {
  std::array<Mask512, 27> borders;
  for (std::size_t n = 0; n < borders.size(); ++n) {
    const Index3 first = offset_of(n) * kBrickEdge;
    const auto inside = [](int c) { return c >= -1 && c <= kBrickEdge; };
    for (int i = 0; i < kBrickVoxels; ++i) {
      const Index3 at = first + child_offset(i);
      borders[n].assign(i, inside(at.x) && inside(at.y) && inside(at.z));
    }
  }
  return borders;
}

}  // namespace

const Mask512& border_towards(std::size_t n) {
  static const std::array<Mask512, 27> borders = make_borders();
  return borders[n];
}

std::uint32_t SurfaceBlocks::insert(SurfaceBlock&& block) {
  const Index3 key = block.key;
  auto slot = static_cast<std::uint32_t>(blocks_.size());
  if (free_slots_.empty()) {
    blocks_.push_back(std::move(block));
    around_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
    blocks_[slot] = std::move(block);
  }
  slot_of_.emplace(key, slot);
  for (std::size_t n = 0; n < 27; ++n) {
    const std::uint32_t other = find(key + offset_of(n));
    around_[slot][n] = other;
    if (other != kNone) around_[other][26 - n] = slot;
  }
  return slot;
}

void SurfaceBlocks::erase(std::uint32_t slot) {
  for (std::size_t n = 0; n < 27; ++n) {
    const std::uint32_t other = around_[slot][n];
    if (other != kNone) around_[other][26 - n] = kNone;
  }
  slot_of_.erase(blocks_[slot].key);
  blocks_[slot] = {};
  free_slots_.push_back(slot);
}

std::vector<std::uint32_t> SurfaceBlocks::with_rings(std::span<const std::uint32_t> slots, int rings) const {
  std::vector<bool> met(blocks_.size());
  std::vector<std::uint32_t> found;
  const auto meet = [&](std::uint32_t slot) {
    if (slot == kNone || met[slot]) return;
    met[slot] = true;
    found.push_back(slot);
  };
  for (const std::uint32_t slot : slots) meet(slot);
  std::size_t begin{0};
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t end = found.size();
    for (; begin < end; ++begin) {
      for (const std::uint32_t other : around_[found[begin]]) meet(other);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace saccade
