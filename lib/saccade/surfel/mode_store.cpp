// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/mode_store.hpp"

namespace saccade {

std::size_t ModeStore::memory_bytes() const { return counts_.capacity() + chunks_.size() * kPerChunk * stride(); }

void ModeStore::resize(std::size_t surfels) {
  if (surfels > counts_.capacity()) counts_.reserve(surfels + surfels / 8);
  counts_.resize(surfels);
  while (chunks_.size() * kPerChunk < surfels) {
    chunks_.push_back(std::make_unique_for_overwrite<std::byte[]>(kPerChunk * stride()));
  }
}

SurfelMode ModeStore::mode(SurfelId id, std::size_t i) const {
  const std::byte* const colors = room(id);
  const std::byte* const weights = colors + max_modes_ * sizeof(std::uint64_t);
  const auto* position = reinterpret_cast<const float*>(weights + max_modes_ * sizeof(float)) + 3 * i;
  return {unit_color(ColorUnits::unpacked(reinterpret_cast<const std::uint64_t*>(colors)[i])),
          {position[0], position[1], position[2]},
          reinterpret_cast<const float*>(weights)[i]};
}

// Not in the header: g++ takes an inlined function that only prefetches for one without effect, and leaves it out.
void ModeStore::fetch_colors(SurfelId id) const {
  constexpr std::size_t kLine{64};
  const std::byte* const first = room(id);
  __builtin_prefetch(&counts_[id], 1);
  for (std::size_t i = 0; i < max_modes_ * sizeof(std::uint64_t); i += kLine) __builtin_prefetch(first + i, 1);
}

void ModeStore::fetch_place(SurfelId id, std::size_t i) const {
  const std::byte* const weights = room(id) + max_modes_ * sizeof(std::uint64_t);
  const std::byte* const position = weights + (max_modes_ + 3 * i) * sizeof(float);
  __builtin_prefetch(weights + i * sizeof(float), 1);
  __builtin_prefetch(position, 1);
  __builtin_prefetch(position + 2 * sizeof(float), 1);
}

}  // namespace saccade
