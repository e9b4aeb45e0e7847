// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/mode_store.hpp"

namespace saccade {

std::size_t ModeStore::memory_bytes() const { return counts_.capacity() + chunks_.size() * kPerChunk * stride_; }

void ModeStore::resize(std::size_t surfels) {
  if (surfels > counts_.capacity()) counts_.reserve(surfels + surfels / 8);
  counts_.resize(surfels);
  while (chunks_.size() * kPerChunk < surfels) {
    chunks_.push_back(std::make_unique_for_overwrite<std::byte[]>(kPerChunk * stride_));
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

}  // namespace saccade
