// SPDX-License-Identifier: Apache-2.0
#include "annotated_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "saccade/cloud/label_boxes.hpp"
#include "saccade/cloud/nearest_neighbours.hpp"
#include "saccade/io/clouds/label_boxes_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/segment_picture.hpp"

namespace saccade::cli {
namespace {

constexpr int kWidth_px{960};
constexpr int kHeight_px{720};

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
  std::map<std::uint32_t, std::uint32_t> places;  // rows of labels
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
  const Viewpoint view =
      upright_view_of(positions_m, find_upright(positions_m, cloud.upright_hints), kWidth_px, kHeight_px);
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

}  // namespace

Status write_label_files(const LabelFiles& files, const LoadedCloud& cloud, const LabelledPoints& labels,
                         const Executor& executor) {
  const std::vector<NamedLabel> names = labels.names();
  std::shared_ptr<const CloudFile> fields;
  if (!files.out.empty() || !files.margins.empty()) {
    SACCADE_TRY(fields, cloud.fields.file());
  }
  if (!files.out.empty()) SACCADE_CHECK(write_labels(files.out, *fields, labels.labels, names));
  if (!files.names.empty()) SACCADE_CHECK(server::write_names(files.names, names));
  if (!files.margins.empty()) {
    CloudFile with_margins = *fields;
    add_number_field(with_margins, "margin", labels.margins);
    SACCADE_CHECK(write_cloud(files.margins, with_margins));
  }
  if (!files.boxes.empty()) {
    const Eigen::Vector3d up = server::box_up(cloud, files.boxes.extension() == ".json");
    const std::vector<LabelBox> boxes = label_boxes(cloud.points.positions_m, labels.labels, up);
    SACCADE_CHECK(write_label_boxes(files.boxes, boxes, names, cloud.points.offset_m));
  }
  if (files.picture.empty()) return {};
  return write_png(files.picture, picture_of(cloud, labels, executor));
}

}  // namespace saccade::cli
