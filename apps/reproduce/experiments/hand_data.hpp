// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_hand_data: the thesis' data set of recorded hands (§2.4.2), as Tables 2.2 to 2.6 take it.

#include <filesystem>
#include <string>
#include <vector>

#include "reproduce/hand_data_address.hpp"
#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/core/result.hpp"

namespace saccade::reproduce {

enum class HandTasks { pick_and_place, placements_and_removals };

struct RecordedHand {
  LabelledTrajectory labelled;
  HandTasks tasks{HandTasks::pick_and_place};
  std::string file;      ///< below the data set's folder
  std::string user;      ///< "user1": the name up to its first underscore
  bool is_sound{false};  ///< no label is farther than 0.2 m from every sample
};

/// Whether trajectories are there, without a look into them. not_found with what to do; what the files' reader says.
[[nodiscard]] Status check_hand_data(const std::filesystem::path& folder);

/// FOLDER/pick_and_place, then FOLDER/placements_removals, by name: the order of `saccade attend FOLDER`, so that noise
/// is the same. Errors as above, and of a file that cannot be read.
[[nodiscard]] Result<std::vector<RecordedHand>> read_hand_data(const std::filesystem::path& folder);

}  // namespace saccade::reproduce
