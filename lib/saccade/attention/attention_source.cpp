// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/attention_source.hpp"

namespace saccade {
namespace {

void number(std::vector<RegionOfInterest>& regions) {
  for (std::size_t i = 0; i < regions.size(); ++i) {
    regions[i].index = i;
    regions[i].rival = false;
  }
}

}  // namespace

Result<std::vector<RegionOfInterest>> WholeWorkspace::regions(const PlanningContext& context) {
  const std::optional<Box>& workspace = context.map.config.workspace;
  if (!workspace) return Error{Errc::invalid_argument, "the map has no workspace to explore", "attention"};
  return std::vector{RegionOfInterest{*workspace, 1.0, AttentionOrigin::workspace, "the whole workspace"}};
}

RegionsInTurn::RegionsInTurn(std::span<const RegionOfInterest> regions) : regions_{regions.begin(), regions.end()} {
  number(regions_);
}

RegionsInTurn::RegionsInTurn(std::span<const Region> bounds) {
  for (const Region& region : bounds) regions_.push_back({region, 1.0, AttentionOrigin::workspace, "named"});
  number(regions_);
}

Result<std::vector<RegionOfInterest>> RegionsInTurn::regions(const PlanningContext& /*context*/) { return regions_; }

}  // namespace saccade
