// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_association.hpp"

namespace saccade {

void SeenRounds::collect(const SurfelAssociation& seen, int begin, int end) {
  constexpr unsigned kOld{(1U << SurfelAssociation::kNewSurfel) - 1U};
  for (std::vector<SurfelPixel>& round : rounds_) round.clear();
  const auto pixel = [](SurfelId id, int u, int v) {
    return SurfelPixel{id, static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v)};
  };
  for (int v = begin; v < end; ++v) {
    const std::uint16_t* bits_of = seen.seen_by.row(v);
    const SurfelId* cells = seen.of_cell.row(v);
    const SurfelId* own = seen.of_pixel.row(v);
    for (int u = 0; u < seen.of_pixel.width(); ++u) {
      unsigned bits = bits_of[u];
      if ((bits & ~kOld) != 0) rounds_[0].push_back(pixel(own[u], u, v));
      bits &= kOld;
      for (std::size_t k = 0; bits != 0; bits &= bits - 1, ++k) {
        const int around = std::countr_zero(bits);
        rounds_[k].push_back(pixel(cells[u], u + around % 3 - 1, v + around / 3 - 1));
      }
    }
  }
}

}  // namespace saccade
