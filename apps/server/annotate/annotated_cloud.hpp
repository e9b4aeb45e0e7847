// SPDX-License-Identifier: Apache-2.0
#pragma once
// Annotated cloud and the definitions of its labels, as files and tables show them.

#include <filesystem>
#include <span>
#include <vector>

#include "saccade/annotate/annotation.hpp"
#include "saccade/cloud/upright.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "server/annotate/cloud_fields.hpp"

namespace saccade::server {

struct LoadedCloud {
  std::filesystem::path path;
  PointCloud points;
  CloudFields fields;
  UprightHints upright_hints;
};

/// Loads a cloud. Errors of read_cloud and cloud_from_fields; corrupt_data for a cloud without points.
[[nodiscard]] Result<LoadedCloud> load_cloud(const std::filesystem::path& path);

/// Label with its numbers of points and control points.
struct LabelRow {
  NamedLabel label;
  std::size_t control_points{0};
};

struct LabelledPoints {
  std::vector<std::uint32_t> labels;          ///< per point; 0: none
  std::vector<std::uint32_t> control_points;  ///< points
  std::vector<LabelRow> rows;                 ///< labels that are defined or in use, in ascending order
  std::vector<float> margins;                 ///< per point (label_margins); empty: not requested

  [[nodiscard]] std::size_t labelled() const;
  [[nodiscard]] std::vector<NamedLabel> names() const;
};

[[nodiscard]] LabelledPoints labelled_points(const Annotation& annotation);
/// Returns points with labels that have no definition besides their numbers.
[[nodiscard]] LabelledPoints labelled_points(std::vector<std::uint32_t> labels,
                                             std::vector<std::uint32_t> control_points);

/// Returns the vertical of label boxes: they stand upright; those of KITTI, which know no tilt, along the axis of the
/// cloud's frame nearest to up.
[[nodiscard]] Eigen::Vector3d box_up(const LoadedCloud& cloud, bool has_tilt);

/// Writes text, or JSON for names ending in .json.
[[nodiscard]] Status write_names(const std::filesystem::path& path, std::span<const NamedLabel> names);

}  // namespace saccade::server
