// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/annotated_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "saccade/io/clouds/cloud_upright.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::server {
namespace {

/// Says which names clouds have where a file that is none has another.
Error with_cloud_suffixes(Error error, const std::filesystem::path& path) {
  if (error.code != Errc::corrupt_data || has_cloud_suffix(path)) return error;
  error.message += "; the names of clouds end in " + std::string{kCloudSuffixes};
  return error;
}

}  // namespace

Result<LoadedCloud> load_cloud(const std::filesystem::path& path) {
  LoadedCloud cloud{path, {}, {}, {}};
  auto read = read_cloud(path);
  if (!read) return with_cloud_suffixes(read.error(), path);
  CloudFile file = std::move(*read);
  SACCADE_TRY(cloud.points, in_file(cloud_from_fields(file.fields()), path));
  cloud.upright_hints = upright_hints_of(file);
  cloud.fields = CloudFields{path, std::move(file)};
  const bool any = std::any_of(cloud.points.positions_m.begin(), cloud.points.positions_m.end(),
                               [](const Eigen::Vector3f& p) { return p.allFinite(); });
  if (!any) return Error{Errc::corrupt_data, "has no point with a finite place; there is nothing to label", path};
  return cloud;
}

std::size_t LabelledPoints::labelled() const {
  std::size_t count{0};
  for (const LabelRow& row : rows) count += row.label.points;
  return count;
}

std::vector<NamedLabel> LabelledPoints::names() const {
  std::vector<NamedLabel> names;
  for (const LabelRow& row : rows) names.push_back(row.label);
  return names;
}

LabelledPoints labelled_points(const Annotation& annotation) {
  LabelledPoints points{{annotation.labels().begin(), annotation.labels().end()}, {}, {}, {}};
  std::map<std::uint32_t, LabelRow> rows;
  for (const auto& [number, info] : annotation.label_table().defined()) rows[number];
  for (const auto& [number, count] : annotation.counts()) rows[number].label.points = count;
  for (const ControlPoint& control : annotation.control_points()) {
    points.control_points.push_back(control.point);
    ++rows[control.label].control_points;
  }
  for (auto& [number, row] : rows) {
    const LabelInfo info = annotation.label_table().info(number);
    row.label = {number, info.name, info.class_name, info.instance, info.color, row.label.points};
    points.rows.push_back(row);
  }
  return points;
}

LabelledPoints labelled_points(std::vector<std::uint32_t> labels, std::vector<std::uint32_t> control_points) {
  const DistinctColors colors;
  std::map<std::uint32_t, LabelRow> rows;
  for (const std::uint32_t label : labels) {
    if (label != kNoLabel) ++rows[label].label.points;
  }
  for (const std::uint32_t point : control_points) ++rows[labels[point]].control_points;
  LabelledPoints points{std::move(labels), std::move(control_points), {}, {}};
  for (auto& [number, row] : rows) {
    row.label.number = number;
    row.label.color = colors(number);
    points.rows.push_back(row);
  }
  return points;
}

Eigen::Vector3d box_up(const LoadedCloud& cloud, bool has_tilt) {
  const Upright upright = find_upright(cloud.points.positions_m, cloud.upright_hints);
  if (has_tilt) return upright.up;
  Eigen::Index axis{0};
  upright.up.cwiseAbs().maxCoeff(&axis);
  return std::copysign(1.0, upright.up[axis]) * Eigen::Vector3d::Unit(axis);
}

Status write_names(const std::filesystem::path& path, std::span<const NamedLabel> names) {
  return path.extension() == ".json" ? write_label_names_json(path, names) : write_label_names_text(path, names);
}

}  // namespace saccade::server
