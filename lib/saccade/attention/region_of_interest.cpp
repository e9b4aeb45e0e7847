// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/region_of_interest.hpp"

namespace saccade {

Result<std::vector<RegionOfInterest>> regions_of_interest(std::span<const HandAction> actions, double radius_m) {
  std::vector<RegionOfInterest> regions;
  regions.reserve(actions.size());
  for (const HandAction& action : actions) {
    const Sphere sphere{action.position_m, radius_m};
    if (const Status valid = validate(sphere); !valid) return valid.error();
    regions.push_back({sphere, action.saliency, AttentionOrigin::hand_action, action.why});
  }
  return regions;
}

}  // namespace saccade
