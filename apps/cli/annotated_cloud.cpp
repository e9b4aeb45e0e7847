// SPDX-License-Identifier: Apache-2.0
#include "annotated_cloud.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "saccade/annotate/estimated_normals.hpp"
#include "saccade/io/file_io.hpp"
#include "saccade/io/image_io.hpp"
#include "saccade/report/segment_picture.hpp"

namespace saccade::cli {
namespace {

constexpr int kWidth_px{960};
constexpr int kHeight_px{720};

/// Whether the cloud is as one camera sees it: before the origin, around +z.
bool is_in_camera_frame(const std::vector<Eigen::Vector3f>& positions_m) {
  constexpr float kLeastCosine{0.5F};
  constexpr double kMost{0.99};
  std::size_t finite{0};
  std::size_t ahead{0};
  for (const Eigen::Vector3f& p : positions_m) {
    if (!p.allFinite()) continue;
    ++finite;
    ahead += p.z() > kLeastCosine * p.norm() ? 1 : 0;
  }
  return static_cast<double>(ahead) >= kMost * static_cast<double>(finite);
}

constexpr std::size_t kNeighbours{10};

/// Half of the points have a fourth neighbour that is as near.
double spacing_of(const NearestNeighbours& near) {
  constexpr std::size_t kFourth{3};
  std::vector<float> distances_m;
  for (std::size_t n = 0; n < near.order.size() && near.count > kFourth; ++n) {
    distances_m.push_back((near.positions_m[near.of(n)[kFourth]] - near.positions_m[n]).norm());
  }
  if (distances_m.empty()) return 0.0;
  const auto middle = distances_m.begin() + static_cast<std::ptrdiff_t>(distances_m.size() / 2);
  std::nth_element(distances_m.begin(), middle, distances_m.end());
  return *middle;
}

/// The cloud's own, or estimated ones.
std::vector<Eigen::Vector3f> normals_of(const PointCloud& cloud, const NearestNeighbours& near,
                                        const Executor& executor) {
  if (!cloud.normals.empty()) return cloud.normals;
  constexpr int kRounds{2};
  const std::vector<Eigen::Vector3f> of_nodes = estimate_normals(near, kRounds, executor);
  std::vector<Eigen::Vector3f> normals(cloud.positions_m.size(), Eigen::Vector3f::Zero());
  for (std::size_t n = 0; n < of_nodes.size(); ++n) normals[near.order[n]] = of_nodes[n];
  return normals;
}

std::string legend_text(const NamedLabel& label) {
  return std::to_string(label.number) + (label.name.empty() ? "" : " " + label.name);
}

ColorImage picture_of(const LoadedCloud& cloud, const LabelledPoints& labels, const Executor& executor) {
  constexpr std::size_t kNamed{24};
  const std::vector<Eigen::Vector3f>& positions_m = cloud.points.positions_m;
  std::map<std::uint32_t, std::uint32_t> places;  // of labels among the rows
  std::vector<Rgb8> colors;
  std::vector<LegendEntry> legend;
  for (const LabelRow& row : labels.rows) {
    places.emplace(row.label.number, static_cast<std::uint32_t>(colors.size()));
    colors.push_back(row.label.color);
    if (row.label.points > 0 && legend.size() < kNamed) legend.push_back({row.label.color, legend_text(row.label)});
  }
  std::vector<std::uint32_t> drawn(labels.labels.size(), kUnlabelled);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (labels.labels[i] != kNoLabel) drawn[i] = places.at(labels.labels[i]);
  }
  OverviewConfig overview;
  overview.width = kWidth_px;
  overview.height = kHeight_px;
  const Viewpoint view = is_in_camera_frame(positions_m) ? camera_view_of(positions_m, kWidth_px, kHeight_px)
                                                         : overview_of_points(positions_m, overview);
  const NearestNeighbours near = nearest_neighbours(positions_m, kNeighbours, executor);
  const std::vector<Eigen::Vector3f> normals = normals_of(cloud.points, near, executor);
  const DrawnSegments segments{positions_m, normals, drawn, {}, spacing_of(near)};
  Panel panel = marked_panel(segments, colors, labels.control_points, view,
                             std::to_string(labels.labelled()) + " points labelled, " +
                                 std::to_string(labels.control_points.size()) + " control points",
                             executor);
  panel.legend = std::move(legend);
  return compose({cloud.path.filename().string(), {std::move(panel)}, {}});
}

Status write_names(const std::filesystem::path& path, std::span<const NamedLabel> names) {
  return path.extension() == ".json" ? write_label_names_json(path, names) : write_label_names_text(path, names);
}

}  // namespace

Result<LoadedCloud> load_cloud(const std::filesystem::path& path) {
  LoadedCloud cloud{path, {}, {}};
  SACCADE_TRY(cloud.file, read_cloud(path));
  SACCADE_TRY(cloud.points, in_file(cloud_from_fields(cloud.file.fields()), path));
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

Status write_label_files(const LabelFiles& files, const LoadedCloud& cloud, const LabelledPoints& labels,
                         const Executor& executor) {
  std::vector<NamedLabel> names;
  for (const LabelRow& row : labels.rows) names.push_back(row.label);
  if (!files.out.empty()) SACCADE_CHECK(write_labels(files.out, cloud.file, labels.labels, names));
  if (!files.names.empty()) SACCADE_CHECK(write_names(files.names, names));
  if (!files.margins.empty()) {
    CloudFile with_margins = cloud.file;
    add_number_field(with_margins, "margin", labels.margins);
    SACCADE_CHECK(write_cloud(files.margins, with_margins));
  }
  if (files.picture.empty()) return {};
  return write_png(files.picture, picture_of(cloud, labels, executor));
}

}  // namespace saccade::cli
