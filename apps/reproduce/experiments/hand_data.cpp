// SPDX-License-Identifier: Apache-2.0
#include "experiments/hand_data.hpp"

#include <array>
#include <utility>

#include "saccade/io/frames/trajectory_io.hpp"

namespace saccade::reproduce {
namespace {

namespace fs = std::filesystem;

struct TaskFolder {
  HandTasks tasks;
  const char* name;
};
constexpr std::array kTaskFolders{TaskFolder{HandTasks::pick_and_place, "pick_and_place"},
                                  TaskFolder{HandTasks::placements_and_removals, "placements_removals"}};

Result<std::vector<fs::path>> files_of(const fs::path& folder, const TaskFolder& tasks) {
  auto files = find_hand_trajectories(folder / tasks.name);
  if (files) return files;
  Error error = files.error();
  error.message +=
      std::string{
          "; --hands takes the folder of the data set, with pick_and_place and placements_removals "
          "in it, from "} +
      kHandDataAddress;
  return error;
}

}  // namespace

Status check_hand_data(const fs::path& folder) {
  for (const TaskFolder& tasks : kTaskFolders) SACCADE_CHECK(files_of(folder, tasks));
  return {};
}

Result<std::vector<RecordedHand>> read_hand_data(const fs::path& folder) {
  std::vector<RecordedHand> hands;
  for (const TaskFolder& tasks : kTaskFolders) {
    SACCADE_TRY(const std::vector<fs::path> files, files_of(folder, tasks));
    for (const fs::path& file : files) {
      SACCADE_TRY(LabelledTrajectory labelled, read_labelled_trajectory(file));
      RecordedHand hand;
      hand.tasks = tasks.tasks;
      hand.file = file.lexically_relative(folder).generic_string();
      hand.user = labelled.name.substr(0, labelled.name.find('_'));
      hand.is_sound = !is_mislabelled(labelled);
      hand.labelled = std::move(labelled);
      hands.push_back(std::move(hand));
    }
  }
  return hands;
}

}  // namespace saccade::reproduce
