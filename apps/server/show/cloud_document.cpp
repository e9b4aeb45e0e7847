// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "saccade/annotate/label_table.hpp"
#include "saccade/io/clouds/cloud_upright.hpp"
#include "saccade/io/clouds/scalar_fields.hpp"
#include "server/show/figures.hpp"
#include "server/show/open_document.hpp"
#include "server/show/stand_upright.hpp"

namespace saccade::server {
namespace {

constexpr std::size_t kMostPoints{8'000'000};
constexpr std::size_t kMostLegend{24};
constexpr Rgb8 kNoLabel{120, 124, 132};

/// Returns a box around all points except half a percent at either end of each axis, enlarged by a tenth; around all
/// points where that is not much smaller.
Box bounds_without_outliers(std::span<const Eigen::Vector3f> points) {
  constexpr std::size_t kShare{200};
  constexpr double kMuch{0.75};
  const Box all = bounds_of_points(points);
  Box most = all;
  std::vector<float> values(points.size());
  for (const int axis : {0, 1, 2}) {
    std::transform(points.begin(), points.end(), values.begin(), [axis](const Eigen::Vector3f& p) { return p[axis]; });
    const std::size_t rank = values.size() / kShare;
    const auto value_at = [&](std::size_t i) {
      std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values.end());
      return static_cast<double>(values[i]);
    };
    const double low = value_at(rank);
    const double high = value_at(values.size() - 1 - rank);
    most.min[axis] = std::max(all.min[axis], low - 0.1 * (high - low));
    most.max[axis] = std::min(all.max[axis], high + 0.1 * (high - low));
  }
  return (most.max - most.min).norm() < kMuch * (all.max - all.min).norm() ? most : all;
}

/// Returns the finite points, every n-th of very many.
std::vector<std::size_t> shown_points(const PointCloud& cloud) {
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
    if (cloud.positions_m[i].allFinite()) finite.push_back(i);
  }
  const std::size_t every = (finite.size() + kMostPoints - 1) / kMostPoints;
  if (every <= 1) return finite;
  std::vector<std::size_t> sample;
  for (std::size_t i = 0; i < finite.size(); i += every) sample.push_back(finite[i]);
  return sample;
}

Rgb8 to_bytes(const Eigen::Vector3f& color) {
  const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255.0F * share)); };
  return {byte(std::min(std::max(color.x(), 0.0F), 1.0F)), byte(std::min(std::max(color.y(), 0.0F), 1.0F)),
          byte(std::min(std::max(color.z(), 0.0F), 1.0F))};
}

Layer label_layer(std::span<const std::uint32_t> labels, std::span<const std::size_t> shown,
                  std::span<const Eigen::Vector3f> points, Facts& facts) {
  const DistinctColors color_of;
  std::map<std::uint32_t, std::size_t> counts;
  std::vector<Rgb8> colors;
  for (const std::size_t i : shown) {
    const std::uint32_t label = labels[i];
    colors.push_back(label == kUnlabelled ? kNoLabel : color_of(label));
    if (label != kUnlabelled) ++counts[label];
  }
  Layer layer = points_layer("labels", "Labels", points, colors);
  for (const auto& [label, count] : counts) {
    if (layer.legend.size() == kMostLegend) break;
    layer.legend.push_back({std::to_string(label) + ": " + grouped(count) + " points", color_of(label)});
  }
  layer.legend.push_back({"without label", kNoLabel});
  facts.emplace_back("labels", grouped(counts.size()));
  return layer;
}

/// Fields that the shown points can be coloured by.
std::vector<LayerField> fields_of(const CloudFile& file, const PointCloud& cloud, std::span<const std::size_t> shown) {
  std::vector<LayerField> fields;
  if (!cloud.normals.empty()) {
    std::vector<float> normals;
    for (const std::size_t i : shown) {
      normals.insert(normals.end(), cloud.normals[i].data(), cloud.normals[i].data() + 3);
    }
    fields.push_back(layer_field("normal", 3, normals));
  }
  for (const std::string& name : scalar_field_names(file.fields())) {
    const std::vector<float> all = scalar_values(file.fields(), name);
    std::vector<float> values;
    for (const std::size_t i : shown) values.push_back(all[i]);
    fields.push_back(layer_field(name, 1, values));
  }
  return fields;
}

/// Discs as wide as the surfels of the file, else squares.
Layer cloud_layer(const CloudFile& file, const PointCloud& cloud, std::span<const std::size_t> shown,
                  std::span<const Eigen::Vector3f> points, std::span<const Rgb8> colors) {
  std::vector<float> diameters_m;
  if (!cloud.radii_m.empty()) {
    for (const std::size_t i : shown) {
      const float radius_m = cloud.radii_m[i];
      diameters_m.push_back(std::isfinite(radius_m) && radius_m > 0.0F ? 2.0F * radius_m : 0.0F);
    }
  }
  Layer layer = diameters_m.empty() ? points_layer("cloud", "Cloud", points, colors)
                                    : discs_layer("cloud", "Cloud", points, colors, diameters_m);
  layer.fields = fields_of(file, cloud, shown);
  return layer;
}

}  // namespace

Result<SceneDocument> cloud_document(const std::filesystem::path& path, const std::optional<Eigen::Vector3d>& up) {
  SACCADE_TRY(const CloudFile file, read_cloud(path));
  SACCADE_TRY(const PointCloud cloud, cloud_from_fields(file.fields()));
  const std::vector<std::size_t> shown = shown_points(cloud);
  if (shown.empty()) return Error{Errc::corrupt_data, "has no point that is finite", path.string()};
  std::vector<Eigen::Vector3f> points;
  std::vector<Rgb8> colors;
  for (const std::size_t i : shown) {
    points.push_back(cloud.positions_m[i]);
    if (!cloud.colors.empty()) colors.push_back(to_bytes(cloud.colors[i]));
  }
  SceneDocument document;
  document.title = path.filename().string();
  document.kind = DocumentKind::cloud;
  document.bounds = bounds_without_outliers(points);
  UprightHints hints = upright_hints_of(file);
  hints.up = up;
  SACCADE_CHECK(stand_upright(document, path, points, std::move(hints), true));
  document.facts.emplace_back("points", grouped(cloud.positions_m.size()));
  if (shown.size() < cloud.positions_m.size()) document.facts.emplace_back("shown", grouped(shown.size()));
  const Eigen::Vector3d& offset_m = cloud.offset_m;
  if (!offset_m.isZero(0.0)) {
    document.facts.emplace_back("offset", std::to_string(std::llround(offset_m.x())) + ", " +
                                              std::to_string(std::llround(offset_m.y())) + ", " +
                                              std::to_string(std::llround(offset_m.z())) + " m, taken off");
  }
  document.facts.emplace_back("colours", colors.empty() ? "none" : "per point");
  document.layers.push_back(cloud_layer(file, cloud, shown, points, colors));
  if (file.fields().find(kLabelField) != nullptr) {
    SACCADE_TRY(const std::vector<std::uint32_t> labels, labels_from_fields(file.fields()));
    document.layers.push_back(label_layer(labels, shown, points, document.facts));
    document.layers.front().visible = false;
  }
  return document;
}

}  // namespace saccade::server
