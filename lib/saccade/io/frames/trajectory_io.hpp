// SPDX-License-Identifier: Apache-2.0
#pragma once
// Trajectories and pose lists: TUM lines, 4×4 matrices, Open3D logs, JSON; trajectories of hands and their labels;
// reading and writing. docs/reference/formats.md.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// Pose of a list. An invalid value (NaN, no rotation) is kept as an error, so that a reader of frames can skip only
/// that frame.
struct PoseEntry {
  Result<Pose> T_world_camera;
  std::optional<double> time_s;
  std::size_t line{0};               ///< where it starts, from 1; 0 for JSON
  std::optional<std::int64_t> id{};  ///< number of the image or of the graph's node, where the list has it
};

struct StampedPose {
  double time_s{0.0};
  Pose T_world_camera{Pose::Identity()};
};

/// Parses a list of poses. The first line that is not a comment ('#') decides the format:
///   8 numbers  TUM: time tx ty tz qx qy qz qw, the quaternion of length 1 within 1e-3;
///   9 numbers  the same and an id, as RTAB-Map exports it;
///   3 numbers  Open3D log: three integers, then a 4×4 matrix on four lines;
///   4 or 16    4×4 matrices row by row, one or many;
///   12         3×4 matrices row by row, one a line, as KITTI has them;
///   VERTEX_SE3:QUAT id x y z qx qy qz qw      a graph of g2o; edges and the like are passed over;
///   VERTEX3 id x y z roll pitch yaw (radians) a graph of TORO;
///   '[' or '{' JSON: one 4×4 nested array, an array of them, an array of {"T_world_camera": ...}, or an object with
///              such an array under "poses", "views" or "result.views" (what `nbv --json` writes).
/// Answers corrupt_data with the line for a wrong number of values or a word that is not a number. An empty text has no
/// poses.
[[nodiscard]] Result<std::vector<PoseEntry>> parse_pose_list(std::string_view text);
[[nodiscard]] Result<std::vector<PoseEntry>> read_pose_list(const std::filesystem::path& path);

/// Reads poses that must all be good; the error names the first bad one. not_found for an empty list.
[[nodiscard]] Result<std::vector<Pose>> read_poses(const std::filesystem::path& path);
/// Reads TUM lines only.
[[nodiscard]] Result<std::vector<StampedPose>> read_tum_trajectory(const std::filesystem::path& path);

/// Writes TUM lines atomically with 17 digits, so that reading gives equal poses to 1e-15.
[[nodiscard]] Status write_tum_trajectory(const std::filesystem::path& path, std::span<const StampedPose> poses);
/// Writes four lines per pose.
[[nodiscard]] Status write_matrices(const std::filesystem::path& path, std::span<const Pose> poses);
/// Writes an Open3D log: "i i i+1" before each matrix.
[[nodiscard]] Status write_open3d_log(const std::filesystem::path& path, std::span<const Pose> poses);

enum class HandFormat {
  matrices,  ///< 4×4 matrices row by row, 100 Hz from time 0; the extension .traj
  csv,       ///< time,x,y,z[,qx,qy,qz,qw], with a header that may reorder them or without; .csv
  tum,       ///< time tx ty tz qx qy qz qw; .tum and .txt
};
inline constexpr auto kHandFormatNames =
    make_names<HandFormat>({{HandFormat::matrices, "matrices"}, {HandFormat::csv, "csv"}, {HandFormat::tum, "tum"}});

/// Seconds between the matrices of HandFormat::matrices, which carry no time.
constexpr double kHandMatrixInterval_s{0.01};

/// Usable samples of a file, and the faults of the others.
struct HandRecording {
  HandTrajectory trajectory;
  SampleReport report;
};

/// Parses samples in metres and seconds. Samples without a finite position or an increasing time are dropped and
/// counted; an invalid orientation (no rotation, no unit quaternion) is dropped from its sample.
/// @return corrupt_data with the line for text of another format. An empty text has no samples. O(text).
[[nodiscard]] Result<HandRecording> parse_hand_trajectory(std::string_view text, HandFormat format);
/// Reads a file in the given format, or in that of its extension. Answers invalid_argument for other extensions.
[[nodiscard]] Result<HandRecording> read_hand_trajectory(const std::filesystem::path& path,
                                                         std::optional<HandFormat> format = std::nullopt);

/// Parses one "x y z" per line, metres: places where the hand acted. Answers corrupt_data with the line.
[[nodiscard]] Result<std::vector<Eigen::Vector3d>> parse_hand_labels(std::string_view text);
/// Reads the labels of FILE from FILE.res, as in the thesis' data set. Answers not_found without it.
[[nodiscard]] Result<std::vector<Eigen::Vector3d>> read_hand_labels(const std::filesystem::path& trajectory);

/// Reads both, named after the file.
[[nodiscard]] Result<LabelledTrajectory> read_labelled_trajectory(const std::filesystem::path& path,
                                                                  std::optional<HandFormat> format = std::nullopt);

/// Returns all .traj files below a folder, by name. Answers not_found when there is none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_hand_trajectories(const std::filesystem::path& folder);

/// Writes CSV with a header, without orientations; reading it gives equal bits. Atomic. Answers io_failure.
[[nodiscard]] Status write_hand_csv(const std::filesystem::path& path, const HandTrajectory& trajectory);

}  // namespace saccade
