// SPDX-License-Identifier: Apache-2.0
#pragma once
// A cloud that is annotated, and what is known of its labels, as files and tables show it.

#include <filesystem>
#include <span>
#include <vector>

#include "saccade/annotate/annotation.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/label_io.hpp"

namespace saccade::server {

struct LoadedCloud {
  std::filesystem::path path;
  CloudFile file;
  PointCloud points;
};

/// Errors of read_cloud and cloud_from_fields; corrupt_data for a cloud without points.
[[nodiscard]] Result<LoadedCloud> load_cloud(const std::filesystem::path& path);

/// Whether the cloud is as one camera sees it: before the origin, around +z.
[[nodiscard]] bool is_in_camera_frame(std::span<const Eigen::Vector3f> positions_m);

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
  [[nodiscard]] std::vector<NamedLabel> names() const;
};

[[nodiscard]] LabelledPoints labelled_points(const Annotation& annotation);
/// Of labels of which nothing but their numbers is known.
[[nodiscard]] LabelledPoints labelled_points(std::vector<std::uint32_t> labels,
                                             std::vector<std::uint32_t> control_points);

/// Text, or JSON where the name ends in .json.
[[nodiscard]] Status write_names(const std::filesystem::path& path, std::span<const NamedLabel> names);

}  // namespace saccade::server
