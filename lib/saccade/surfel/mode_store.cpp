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
  const ModePlace& place = reinterpret_cast<const ModePlace*>(colors + max_modes_ * sizeof(std::uint64_t))[i];
  return {unit_color(ColorUnits::unpacked(reinterpret_cast<const std::uint64_t*>(colors)[i])),
          {place.x_m, place.y_m, place.z_m},
          place.weight};
}

}  // namespace saccade
