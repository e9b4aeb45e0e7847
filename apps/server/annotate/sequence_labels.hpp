// SPDX-License-Identifier: Apache-2.0
#pragma once
// SequenceLabels: what the numbers of labels mean in all clouds of a sequence. place_in: a cloud moved into another's
// frame.

#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "saccade/annotate/annotation.hpp"
#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/io/sessions/annotation_session.hpp"

namespace saccade::server {

class SequenceLabels {
 public:
  /// Collects the definitions in the sessions that are there. Where they differ, the session that was written last
  /// counts: in one run of the program, every session that is changed has all definitions known by then. Files that are
  /// no sessions are passed over; opening them says what is wrong.
  [[nodiscard]] static SequenceLabels of_sessions(std::span<const std::filesystem::path> sessions);

  void take(std::span<const NumberedLabel> labels);
  /// Takes the definitions of these labels as they are in the annotation; those that are not defined there any more are
  /// forgotten.
  void update(const Annotation& annotation, std::span<const std::uint32_t> labels);
  void update(const Annotation& annotation);

  /// Returns the definitions in the order of their numbers.
  [[nodiscard]] std::vector<NumberedLabel> list() const;

 private:
  std::map<std::uint32_t, LabelInfo> defined_;
};

/// Returns the transform from the positions of one cloud (PointCloud::positions_m) to those of another.
/// @param T_world_from, T_world_to  from the coordinates of each cloud's file into a common frame.
[[nodiscard]] Pose place_in(const Pose& T_world_to, const Eigen::Vector3d& to_offset_m, const Pose& T_world_from,
                            const Eigen::Vector3d& from_offset_m);

}  // namespace saccade::server
