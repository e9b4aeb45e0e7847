// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/map_paging.hpp"

#include <cmath>

#include "saccade/map/internal/map_pager.hpp"

namespace saccade {

Status PagingConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "paging of the map"}; };
  if (store == nullptr) return fail("a paged map needs a store");
  if (!memory_bytes && !moving_volume_m) return fail("a paged map needs a limit of its memory or a moving volume");
  if (moving_volume_m && !(*moving_volume_m > 0.0 && std::isfinite(*moving_volume_m))) {
    return fail("the moving volume must be larger than 0");
  }
  return {};
}

Result<TsdfGrid> with_in_memory(const TsdfGrid& grid, std::span<const Index3> sectors, const Executor& executor) {
  TsdfGrid part = grid;
  SACCADE_TRY(const std::vector<LoadedSector> loaded, read_away(grid, sectors, executor));
  for (const LoadedSector& sector : loaded) part.page_in(sector.key, sector.ref);
  return part;
}

}  // namespace saccade
