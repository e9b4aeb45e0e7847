// SPDX-License-Identifier: Apache-2.0
#include "server/show/map_layers.hpp"

#include <algorithm>

#include "saccade/attention/segmented_points.hpp"
#include "saccade/io/maps/ternary_export.hpp"
#include "saccade/report/sheet.hpp"
#include "server/show/figures.hpp"

namespace saccade::server {
namespace {

constexpr std::size_t kMostVoxels{1'500'000};
constexpr double kFrontierOpacity{0.3};
constexpr Rgb8 kUnknown{82, 88, 104};
constexpr Rgb8 kNoSegment{150, 154, 160};
constexpr Rgb8 kChosenContour{0, 150, 136};
constexpr Rgb8 kOtherContour{168, 172, 180};

void put(Layer& layer, const LayerPlace& place) {
  layer.id += place.suffix;
  layer.step = place.step;
  layer.visible = false;
}

/// Returns one segment per vertex; vertices outside the workspace get none, without a search.
std::vector<std::uint32_t> segments_of_vertices(const TsdfSnapshot& map, const TriangleMesh& mesh,
                                                const SegmentedPoints& surface, const Executor& executor) {
  std::vector<std::size_t> inside;
  std::vector<Eigen::Vector3d> places_m;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d vertex = mesh.vertices[i].cast<double>();
    if (map.config.workspace && !contains(*map.config.workspace, vertex)) continue;
    inside.push_back(i);
    places_m.push_back(vertex);
  }
  const std::vector<std::uint32_t> nearest = nearest_segments(surface, places_m, executor);
  std::vector<std::uint32_t> segments(mesh.vertices.size(), kUnlabelled);
  for (std::size_t i = 0; i < inside.size(); ++i) segments[inside[i]] = nearest[i];
  return segments;
}

std::vector<LegendEntry> saliency_legend(double high) {
  std::vector<LegendEntry> legend;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    legend.push_back({decimals(share * high, 2), amount_colors()(share)});
  }
  legend.push_back({"in no segment", kNoSegment});
  return legend;
}

}  // namespace

std::optional<Layer> frontier_layer(const TsdfSnapshot& map, const LayerPlace& place) {
  const std::vector<Eigen::Vector3f> centers = frontier_voxels(map, kMostVoxels);
  if (centers.empty()) return std::nullopt;
  Layer layer = voxels_layer("frontier", kFrontierName, centers, map.config.voxel_size_m);
  layer.color = kUnknown;
  layer.legend = {{"unknown, next to empty", kUnknown}};
  put(layer, place);
  return layer;
}

Layer saliency_layer(const TsdfSnapshot& map, const TriangleMesh& mesh, const SegmentedPoints& surface,
                     std::span<const double> saliency, const LayerPlace& place, const Executor& executor) {
  const double most = saliency.empty() ? 0.0 : *std::max_element(saliency.begin(), saliency.end());
  const double high = round_bar(most > 0.0 ? most : 1.0, "").high;
  TriangleMesh colored{mesh.vertices, {}, {}, mesh.triangles};
  for (const std::uint32_t segment : segments_of_vertices(map, mesh, surface, executor)) {
    const bool known = segment < saliency.size();
    colored.colors.push_back(known ? amount_colors()(saliency[segment] / high) : kNoSegment);
  }
  Layer layer = triangles_layer("saliency", kSaliencyName, colored);
  layer.legend = saliency_legend(high);
  put(layer, place);
  return layer;
}

std::optional<Layer> contours_layer(const ContourSet& contours, std::optional<std::uint32_t> segment,
                                    const LayerPlace& place) {
  constexpr double kNormal_m{0.03};
  if (contours.points.empty()) return std::nullopt;
  std::vector<Eigen::Vector3f> ends;
  std::vector<Rgb8> colors;
  for (std::size_t i = 0; i < contours.points.size(); ++i) {
    const ContourPoint& contour = contours.points[i];
    ends.emplace_back(contour.position_m.cast<float>());
    ends.emplace_back((contour.position_m + kNormal_m * contour.normal).cast<float>());
    const bool chosen = segment && contours.segment_of_point[i] == *segment;
    colors.insert(colors.end(), 2, chosen ? kChosenContour : kOtherContour);
  }
  Layer layer = lines_layer("contours", kContoursName, ends, colors);
  if (segment) layer.legend = {{"of the segment that the view is of", kChosenContour}, {"of others", kOtherContour}};
  put(layer, place);
  return layer;
}

Result<std::vector<Layer>> layers_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh, const Executor& executor) {
  std::vector<Layer> layers{triangles_layer("surface", kSurfaceName, mesh)};
  const LayerPlace always{"", std::nullopt};
  if (std::optional<Layer> frontier = frontier_layer(map, always)) {
    frontier->visible = map.config.workspace.has_value();  // without a workspace it surrounds everything seen
    frontier->opacity = kFrontierOpacity;
    layers.push_back(std::move(*frontier));
  }
  SACCADE_TRY(const SeenAttention seen, AttentionLook{}.look(map, executor));
  std::vector<double> saliency;
  for (const Saliency& of_segment : seen.surface->saliency) saliency.push_back(of_segment.value);
  if (!saliency.empty()) layers.push_back(saliency_layer(map, mesh, seen.surface->points, saliency, always, executor));
  if (std::optional<Layer> contours = contours_layer(seen.contours, std::nullopt, always)) {
    layers.push_back(std::move(*contours));
  }
  if (map.config.workspace) layers.push_back(box_layer("workspace", "Workspace", *map.config.workspace));
  return layers;
}

Result<SeenAttention> AttentionLook::look(const TsdfSnapshot& map, const Executor& executor) {
  SACCADE_TRY(std::shared_ptr<const SalientSurface> surface, objects_.look({map, executor}));
  contours_.update(map, executor);
  ContourSet contours = contours_of(contours_.points(), *surface, executor);
  return SeenAttention{std::move(surface), std::move(contours)};
}

Facts facts_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh) {
  std::size_t occupied{0};
  std::size_t known{0};
  for (const Index3& key : map.grid.sorted_sectors()) {
    for (const BrickRef& brick : map.grid.find(key)->bricks) {
      occupied += static_cast<std::size_t>(brick.occupied_mask().count());
      known += static_cast<std::size_t>(kBrickVoxels - brick.unknown_mask().count());
    }
  }
  return {{"voxel size", millimetres(map.config.voxel_size_m)},
          {"occupied", grouped(occupied) + " voxels"},
          {"empty", grouped(known - occupied) + " voxels"},
          {"surface", grouped(mesh.triangles.size()) + " triangles"}};
}

Box bounds_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh) {
  return map.config.workspace ? *map.config.workspace : bounds_of_points(mesh.vertices);
}

}  // namespace saccade::server
