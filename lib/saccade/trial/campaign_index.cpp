// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/campaign_index.hpp"

namespace saccade {

std::size_t CampaignIndex::Hash::operator()(const Key& key) const {
  std::uint64_t hash = key.seed;
  for (const std::uint32_t name : key.names) hash = (hash ^ name) * 0x9e3779b97f4a7c15U;
  return static_cast<std::size_t>(hash ^ (hash >> 32U));
}

std::uint32_t CampaignIndex::number_of(const std::string& name) {
  return names_.try_emplace(name, static_cast<std::uint32_t>(names_.size())).first->second;
}

void CampaignIndex::add(const CampaignKey& key, std::size_t number) {
  const Key numbers{{number_of(key.scene), number_of(key.scene_hash), number_of(key.strategy), number_of(key.noise),
                     number_of(key.settings)},
                    key.seed};
  runs_.try_emplace(numbers, number);
}

Status CampaignIndex::add(const Campaign& campaign) {
  return campaign.for_each_stored([this](const StoredRun& run) -> Status {
    add(run.key, run.views);
    return {};
  });
}

std::optional<std::size_t> CampaignIndex::find(const CampaignKey& key) const {
  Key numbers{{}, key.seed};
  std::size_t i = 0;
  for (const std::string* name : {&key.scene, &key.scene_hash, &key.strategy, &key.noise, &key.settings}) {
    const auto number = names_.find(*name);
    if (number == names_.end()) return std::nullopt;
    numbers.names[i++] = number->second;
  }
  const auto run = runs_.find(numbers);
  return run == runs_.end() ? std::nullopt : std::optional{run->second};
}

}  // namespace saccade
