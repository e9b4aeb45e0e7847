// SPDX-License-Identifier: Apache-2.0
#pragma once
// The recorded hand trajectories of the thesis' data set with their labels, where they are there.

#include <filesystem>
#include <string>
#include <vector>

#include "saccade/io/frames/trajectory_io.hpp"

namespace saccade::test {

struct RecordedHands {
  std::vector<LabelledTrajectory> placements_and_removals;
  std::vector<LabelledTrajectory> pick_and_place;

  [[nodiscard]] bool empty() const { return placements_and_removals.empty() && pick_and_place.empty(); }
  [[nodiscard]] std::vector<LabelledTrajectory> all() const {
    std::vector<LabelledTrajectory> both = placements_and_removals;
    both.insert(both.end(), pick_and_place.begin(), pick_and_place.end());
    return both;
  }
};

/// Every n-th trajectory of a folder; none without it. Throws on a file that cannot be read.
inline std::vector<LabelledTrajectory> read_hands(const std::filesystem::path& folder, std::size_t every = 1) {
  std::vector<LabelledTrajectory> hands;
  if (!std::filesystem::exists(folder)) return hands;
  const auto paths = find_hand_trajectories(folder).value();
  for (std::size_t i = 0; i < paths.size(); i += every) hands.push_back(read_labelled_trajectory(paths[i]).value());
  return hands;
}

inline RecordedHands recorded_hands(const std::filesystem::path& shared_data, std::size_t every = 1) {
  const std::filesystem::path folder = shared_data / "hand_polhemus";
  return {read_hands(folder / "placements_removals", every), read_hands(folder / "pick_and_place", every)};
}

}  // namespace saccade::test
