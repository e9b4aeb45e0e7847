// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "saccade/annotate/label_table.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "server/show/figures.hpp"
#include "server/show/open_document.hpp"

namespace saccade::server {
namespace {

constexpr std::size_t kMostPoints{8'000'000};
constexpr std::size_t kMostLegend{24};
constexpr Rgb8 kNoLabel{120, 124, 132};

/// Points that are finite, of very many every n-th.
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

}  // namespace

Result<SceneDocument> cloud_document(const std::filesystem::path& path) {
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
  document.bounds = bounds_of_points(points);
  const auto* pcd = std::get_if<PcdFile>(&file.file);
  if (pcd != nullptr && pcd->height > 1) document.up = -Eigen::Vector3d::UnitY();  // the picture of a camera, y down
  document.facts.emplace_back("points", grouped(cloud.positions_m.size()));
  if (shown.size() < cloud.positions_m.size()) document.facts.emplace_back("shown", grouped(shown.size()));
  document.facts.emplace_back("colours", colors.empty() ? "none" : "per point");
  document.layers.push_back(points_layer("cloud", "Cloud", points, colors));
  if (file.fields().find(kLabelField) != nullptr) {
    SACCADE_TRY(const std::vector<std::uint32_t> labels, labels_from_fields(file.fields()));
    document.layers.push_back(label_layer(labels, shown, points, document.facts));
    document.layers.front().visible = false;
  }
  return document;
}

}  // namespace saccade::server
