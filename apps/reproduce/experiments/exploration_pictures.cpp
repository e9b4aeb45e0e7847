// SPDX-License-Identifier: Apache-2.0
#include "experiments/exploration_pictures.hpp"

#include "saccade/attention/salient_objects.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/segment_picture.hpp"
#include "saccade/views/contours.hpp"

namespace saccade::reproduce {
namespace {

const OverviewConfig kExplorationOverview{.width = 480, .height = 360};

/// The segment of each vertex inside the workspace.
std::vector<std::uint32_t> labels_of(const TriangleMesh& mesh, const SegmentedPoints& surface, const Box& workspace,
                                     const Executor& executor) {
  std::vector<std::size_t> inside;
  std::vector<Eigen::Vector3d> places_m;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d vertex = mesh.vertices[i].cast<double>();
    if (!contains(workspace, vertex)) continue;
    inside.push_back(i);
    places_m.push_back(vertex);
  }
  const std::vector<std::uint32_t> nearest = nearest_segments(surface, places_m, executor);
  std::vector<std::uint32_t> labels(mesh.vertices.size(), kUnlabelled);
  for (std::size_t i = 0; i < inside.size(); ++i) labels[inside[i]] = nearest[i];
  return labels;
}

}  // namespace

Status ExplorationPainter::scanned(ScanRecord& /*scan*/, const TsdfSnapshot& map) {
  draw_map(map);
  return {};
}

Status ExplorationPainter::viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> /*frames*/) {
  draw_saliency(view);
  draw_candidates(view);
  draw_map(map);
  T_world_earlier_.push_back(view.T_world_camera);
  return {};
}

void ExplorationPainter::draw_map(const TsdfSnapshot& map) {
  before_ = map;
  MapPictureConfig config;
  config.overview = kExplorationOverview;
  pictures_.maps.push_back(map_picture(map, workspace_, executor_, config));
}

void ExplorationPainter::draw_saliency(const ViewRecord& view) {
  const ViewChoice& choice = *view.choice;
  if (!choice.surface) return;
  const TriangleMesh mesh = extract_mesh(before_, executor_);
  const std::vector<std::uint32_t> labels = labels_of(mesh, choice.surface->points, workspace_, executor_);
  std::vector<DrawnContour> contours;
  for (std::size_t i = 0; choice.contours && i < choice.contours->points.size(); ++i) {
    const ContourPoint& contour = choice.contours->points[i];
    contours.push_back({contour.position_m, contour.normal, choice.segment == choice.contours->segment_of_point[i]});
  }
  pictures_.saliencies.push_back(
      saliency_picture({mesh, labels, choice.saliency, contours, workspace_, view.T_world_camera, sensor_}, executor_,
                       kExplorationOverview));
}

void ExplorationPainter::draw_candidates(const ViewRecord& view) {
  std::vector<ScoredPose> candidates;
  for (const RankedView& candidate : view.choice->candidates) {
    candidates.push_back({candidate.T_world_camera, candidate.gain});
  }
  CandidatesPictureConfig config;
  config.sensor = sensor_;
  config.overview = kExplorationOverview;
  pictures_.candidates.push_back(candidates_picture(
      {before_, view.choice->region, candidates, view.T_world_camera, T_world_earlier_, nullptr}, executor_, config));
}

}  // namespace saccade::reproduce
