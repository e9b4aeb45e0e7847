// SPDX-License-Identifier: Apache-2.0
#pragma once
// Hand trajectories and their labels: the format of the thesis' data set, CSV, TUM; formats in docs/formats.md.

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"
#include "saccade/sensor/trajectory_check.hpp"

namespace saccade {

enum class HandFormat {
  matrices,  ///< 4×4 matrices row by row, 100 Hz from time 0; the extension .traj
  csv,       ///< time,x,y,z[,qx,qy,qz,qw], with a header that may reorder them or without; .csv
  tum,       ///< time tx ty tz qx qy qz qw; .tum and .txt
};
inline constexpr auto kHandFormatNames =
    make_names<HandFormat>({{HandFormat::matrices, "matrices"}, {HandFormat::csv, "csv"}, {HandFormat::tum, "tum"}});

/// Seconds between the matrices of HandFormat::matrices, which carry no time.
constexpr double kHandMatrixInterval_s{0.01};

/// The usable samples of a file, and what was wrong with the others.
struct HandRecording {
  HandTrajectory trajectory;
  SampleReport report;
};

/// Metres and seconds. Samples without a finite position or an increasing time are left out and counted; an orientation
/// that is none (no rotation, no unit quaternion) is left out of its sample.
/// @return corrupt_data with the line for what is not of that format. An empty text has no samples. O(text).
[[nodiscard]] Result<HandRecording> parse_hand_trajectory(std::string_view text, HandFormat format);
/// The same of a file, in the format that its extension tells unless stated. invalid_argument for other extensions.
[[nodiscard]] Result<HandRecording> read_hand_trajectory(const std::filesystem::path& path,
                                                         std::optional<HandFormat> format = std::nullopt);

/// One "x y z" per line, metres: where the hand acted. corrupt_data with the line.
[[nodiscard]] Result<std::vector<Eigen::Vector3d>> parse_hand_labels(std::string_view text);
/// Of FILE in FILE.res, as in the thesis' data set. not_found without it.
[[nodiscard]] Result<std::vector<Eigen::Vector3d>> read_hand_labels(const std::filesystem::path& trajectory);

/// Both together, named after the file.
[[nodiscard]] Result<LabelledTrajectory> read_labelled_trajectory(const std::filesystem::path& path,
                                                                  std::optional<HandFormat> format = std::nullopt);

/// All .traj files below a folder, by name. not_found when there is none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_hand_trajectories(const std::filesystem::path& folder);

/// CSV with a header, without orientations; reading it gives the same bits. Atomic. io_failure.
[[nodiscard]] Status write_hand_csv(const std::filesystem::path& path, const HandTrajectory& trajectory);

}  // namespace saccade
