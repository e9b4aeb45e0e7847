// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/environment_update.hpp"

#include "saccade/map/tsdf_map.hpp"

namespace saccade {

UnknownOfRegions count_unknown(const TsdfSnapshot& map, std::span<const RegionOfInterest> regions) {
  UnknownOfRegions counts;
  counts.reserve(regions.size());
  for (const RegionOfInterest& region : regions) counts.push_back(count_unknown(map, region.bounds));
  return counts;
}

Status RegionMeter::viewed(ViewRecord& /*view*/, const TsdfSnapshot& map, std::span<const Frame> /*frames*/) {
  unknown_.push_back(count_unknown(map, regions_));
  return {};
}

}  // namespace saccade
