// SPDX-License-Identifier: Apache-2.0
#include "compare_mismatch.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace saccade::cli {
namespace {

using nlohmann::json;

/// How many parts of the keys are equal, the more important ones first.
int likeness(const CampaignKey& a, const CampaignKey& b) {
  return (a.strategy == b.strategy ? 8 : 0) + (a.scene == b.scene ? 4 : 0) + (a.noise == b.noise ? 2 : 0) +
         (a.scene_hash == b.scene_hash ? 1 : 0);
}

/// "voxel_size_m is 0.01, not 0.0058": up to three settings that differ.
std::string settings_difference(const std::string& of_run, const std::string& here) {
  constexpr std::size_t kMost{3};
  const json a = json::parse(of_run, nullptr, false);
  const json b = json::parse(here, nullptr, false);
  if (!a.is_object() || !b.is_object()) return "its settings are not JSON";
  std::set<std::string> names;
  for (const json* settings : {&a, &b}) {
    for (const auto& [name, value] : settings->items()) names.insert(name);
  }
  const auto text = [](const json& settings, const std::string& name) {
    return settings.contains(name) ? settings.at(name).dump() : std::string{"not set"};
  };
  std::string difference;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (text(a, name) == text(b, name)) continue;
    if (++count > kMost) continue;
    difference += (difference.empty() ? "" : ", ") + name + " is " + text(a, name) + ", not " + text(b, name);
  }
  if (count > kMost) difference += ", and " + std::to_string(count - kMost) + " more";
  return difference;
}

}  // namespace

PlannedKeys::PlannedKeys(const Comparison& comparison, const std::vector<PlannedRun>& plan) {
  std::set<std::tuple<std::size_t, std::string, std::string, int>> seen;
  Comparison::SettingsTexts texts;
  for (const PlannedRun& run : plan) {
    if (!run.max_views) continue;
    CampaignKey key = comparison.key_of(run, texts);
    planned_.add(key, 0);
    if (seen.insert({run.scene, run.strategy.name, run.noise, *run.max_views}).second) {
      examples_.push_back(std::move(key));
    }
  }
}

Status PlannedKeys::accept(const StoredRun& run) const {
  if (!planned_.find(run.key)) {
    return Error{Errc::invalid_argument,
                 "holds a run that is not of this comparison (" + run.key.scene + ", " + run.key.strategy + ", " +
                     run.key.noise + ", seed " + std::to_string(run.key.seed) + "): " + difference_of(run.key) +
                     "; nothing was merged",
                 {}};
  }
  if (run.program_version != SACCADE_VERSION) {
    return Error{Errc::unsupported,
                 "was made by Saccade " + run.program_version + ", and this is " + SACCADE_VERSION +
                     "; merge it with that one, or do its runs again; nothing was merged",
                 {}};
  }
  return {};
}

std::string PlannedKeys::difference_of(const CampaignKey& key) const {
  const auto nearest = std::max_element(
      examples_.begin(), examples_.end(),
      [&key](const CampaignKey& a, const CampaignKey& b) { return likeness(a, key) < likeness(b, key); });
  if (nearest == examples_.end()) return "it plans nothing";
  const bool scene_known = std::any_of(examples_.begin(), examples_.end(),
                                       [&key](const CampaignKey& example) { return example.scene == key.scene; });
  if (!scene_known) return "the scene is not among its scenes";
  if (nearest->strategy != key.strategy) return "the strategy is not among its strategies";
  if (nearest->scene_hash != key.scene_hash) {
    return "the scene's content is another one (" + key.scene_hash + ", not " + nearest->scene_hash + ")";
  }
  if (nearest->noise != key.noise) return "the noise is not among its noises";
  if (nearest->settings != key.settings) return settings_difference(key.settings, nearest->settings);
  return "the seed is not among its seeds";
}

}  // namespace saccade::cli
