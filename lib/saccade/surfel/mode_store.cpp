// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/mode_store.hpp"

#include <algorithm>

namespace saccade {

void SurfelModes::remove(std::size_t i) {
  std::move(modes.begin() + static_cast<std::ptrdiff_t>(i) + 1, modes.begin() + static_cast<std::ptrdiff_t>(count),
            modes.begin() + static_cast<std::ptrdiff_t>(i));
  --count;
}

std::size_t SurfelModes::nearest(const Eigen::Vector3f& color) const {
  std::size_t best{0};
  float least = (modes[0].color - color).squaredNorm();
  for (std::size_t i = 1; i < count; ++i) {
    const float squared = (modes[i].color - color).squaredNorm();
    if (squared < least) {
      least = squared;
      best = i;
    }
  }
  return best;
}

std::size_t ModeStore::memory_bytes() const {
  return firsts_.capacity() * sizeof(SurfelMode) + heads_.capacity() * sizeof(Head) +
         blocks_.capacity() * sizeof(Block);
}

void ModeStore::resize(std::size_t surfels) {
  firsts_.resize(surfels);
  heads_.resize(surfels);
}

void ModeStore::load(SurfelId id, SurfelModes& modes) const {
  const Head& head = heads_[id];
  modes.count = head.count;
  if (head.count > 0) modes.modes[0] = firsts_[id];
  std::uint32_t block = head.block;
  for (std::size_t i = 1; i < head.count; i += kPerBlock, block = blocks_[block].next) {
    const std::size_t here = std::min<std::size_t>(kPerBlock, head.count - i);
    std::copy_n(blocks_[block].modes.begin(), here, modes.modes.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

bool ModeStore::store(SurfelId id, const SurfelModes& modes) {
  Head& head = heads_[id];
  if (blocks_for(modes.count) != head.blocks) return false;
  head.count = static_cast<std::uint16_t>(modes.count);
  if (modes.count > 0) firsts_[id] = modes.modes[0];
  std::uint32_t block = head.block;
  for (std::size_t i = 1; i < modes.count; i += kPerBlock, block = blocks_[block].next) {
    const std::size_t here = std::min<std::size_t>(kPerBlock, modes.count - i);
    std::copy_n(modes.modes.begin() + static_cast<std::ptrdiff_t>(i), here, blocks_[block].modes.begin());
  }
  return true;
}

void ModeStore::store_and_fit(SurfelId id, const SurfelModes& modes) {
  Head& head = heads_[id];
  const std::size_t wanted = blocks_for(modes.count);
  while (head.blocks > wanted) {
    const std::uint32_t block = head.block;
    head.block = blocks_[block].next;
    blocks_[block].next = free_;
    free_ = block;
    ++free_blocks_;
    --head.blocks;
  }
  while (head.blocks < wanted) {
    if (free_ == kNoBlock) {
      free_ = static_cast<std::uint32_t>(blocks_.size());
      blocks_.emplace_back();
      ++free_blocks_;
    }
    const std::uint32_t block = free_;
    free_ = blocks_[block].next;
    --free_blocks_;
    blocks_[block].next = head.block;
    head.block = block;
    ++head.blocks;
  }
  static_cast<void>(store(id, modes));
}

}  // namespace saccade
