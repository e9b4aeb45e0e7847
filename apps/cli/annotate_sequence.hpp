// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sequences of clouds for saccade annotate: their order, their poses, the lines of a script for each, and the cloud
// before each, whose labels are carried on.

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "annotate.hpp"
#include "server/annotate/sequence_labels.hpp"

namespace saccade::cli {

/// Sorts numbered files, whose names differ in numbers alone, by these: scan_2 before scan_10. Others stay in the order
/// in which they are given, unless `all`, which sorts all names so.
[[nodiscard]] std::vector<std::filesystem::path> in_number_order(std::vector<std::filesystem::path> clouds, bool all);

/// Reads the pose of each cloud, T_world_cloud. As many poses as clouds belong to them in order; of a list that is
/// longer, each cloud whose name is a number takes the pose of that number, from 0, and `notes` says so.
/// @return errors of read_poses; invalid_argument where clouds and poses do not fit.
[[nodiscard]] Result<std::vector<Pose>> read_cloud_poses(const std::filesystem::path& poses,
                                                         std::span<const std::filesystem::path> clouds,
                                                         std::vector<std::string>& notes);

/// Divides a script among clouds: a line is for the cloud that it names, else for that of the line before, at first for
/// the first. Answers invalid_argument with the line for a name that no cloud has, and for one that goes back.
[[nodiscard]] Result<std::vector<std::vector<ScriptedAction>>> lines_of_clouds(std::vector<ScriptedAction> script,
                                                                               std::span<const CloudJob> jobs,
                                                                               const std::filesystem::path& file);

/// The clouds of a sequence that are done: labels of the last one, and what all of them know about labels.
class DoneClouds {
 public:
  explicit DoneClouds(std::span<const CloudJob> jobs);

  void add(const CloudJob& job, const LoadedCloud& cloud, const AnnotatedCloud& made);
  /// Returns what a cloud takes from the one before it; nullopt for the first. Refers to this object.
  [[nodiscard]] std::optional<CarrySource> source_for(const CloudJob& job, const LoadedCloud& cloud) const;
  [[nodiscard]] std::vector<NumberedLabel> labels() const { return labels_.list(); }

 private:
  server::SequenceLabels labels_;
  bool any_{false};
  Pose T_world_last_{Pose::Identity()};
  Eigen::Vector3d offset_m_{0, 0, 0};
  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint32_t> last_labels_;
};

}  // namespace saccade::cli
