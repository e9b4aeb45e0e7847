// SPDX-License-Identifier: Apache-2.0
#pragma once
// A cloud that is annotated, its labels, and the files that they are written to.

#include <filesystem>
#include <span>
#include <vector>

#include "saccade/annotate/annotation.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/io/cloud_io.hpp"
#include "saccade/io/label_output.hpp"

namespace saccade::cli {

struct LoadedCloud {
  std::filesystem::path path;
  CloudFile file;
  PointCloud points;
};

/// Errors of read_cloud and cloud_from_fields; corrupt_data for a cloud without points.
[[nodiscard]] Result<LoadedCloud> load_cloud(const std::filesystem::path& path);

/// A label and how many points and control points have it.
struct LabelRow {
  NamedLabel label;
  std::size_t control_points{0};
};

struct LabelledPoints {
  std::vector<std::uint32_t> labels;          ///< per point; 0: none
  std::vector<std::uint32_t> control_points;  ///< points
  std::vector<LabelRow> rows;                 ///< labels that are defined, or that points have, in ascending order
  std::vector<float> margins;                 ///< per point (label_margins); none: not asked for

  [[nodiscard]] std::size_t labelled() const;
};

[[nodiscard]] LabelledPoints labelled_points(const Annotation& annotation);
/// Of labels of which nothing but their numbers is known.
[[nodiscard]] LabelledPoints labelled_points(std::vector<std::uint32_t> labels,
                                             std::vector<std::uint32_t> control_points);

/// Where labels go; empty: nowhere.
struct LabelFiles {
  std::filesystem::path out;
  std::filesystem::path names;    ///< .txt or .json
  std::filesystem::path picture;  ///< .png
  std::filesystem::path margins;  ///< .pcd or .ply
};

[[nodiscard]] Status write_label_files(const LabelFiles& files, const LoadedCloud& cloud, const LabelledPoints& labels,
                                       const Executor& executor);

}  // namespace saccade::cli
