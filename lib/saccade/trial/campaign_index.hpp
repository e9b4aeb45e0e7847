// SPDX-License-Identifier: Apache-2.0
#pragma once
// CampaignIndex: which runs campaign files hold, in memory.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>

#include "saccade/trial/campaign.hpp"

namespace saccade {

/// The keys of runs, with a number for each: of a campaign, the views that it took. Small, since runs share most of
/// what makes up a key: about 80 bytes a run. Reading is safe from several threads.
class CampaignIndex {
 public:
  /// Adds a run; of two with one key the first stays.
  void add(const CampaignKey& key, std::size_t number);
  /// Adds all runs of a file. Errors: those of Campaign::for_each_stored.
  [[nodiscard]] Status add(const Campaign& campaign);

  /// Returns the run's number; nullopt for a run that is not there.
  [[nodiscard]] std::optional<std::size_t> find(const CampaignKey& key) const;
  [[nodiscard]] std::size_t size() const { return runs_.size(); }

 private:
  /// Scene, its hash, strategy, noise and settings as numbers of names_.
  struct Key {
    std::array<std::uint32_t, 5> names{};
    std::uint64_t seed{0};

    [[nodiscard]] bool operator==(const Key&) const = default;
  };
  struct Hash {
    [[nodiscard]] std::size_t operator()(const Key& key) const;
  };
  [[nodiscard]] std::uint32_t number_of(const std::string& name);

  std::unordered_map<std::string, std::uint32_t> names_;
  std::unordered_map<Key, std::size_t, Hash> runs_;
};

}  // namespace saccade
