// SPDX-License-Identifier: Apache-2.0
#include "explore_report.hpp"

#include <cstddef>
#include <iomanip>
#include <sstream>
#include <utility>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/attention/segmented_points.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/segment_picture.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

std::string picture_name(std::size_t number, const char* kind) {
  std::ostringstream name;
  name << "view-" << std::setw(2) << std::setfill('0') << number << '-' << kind << ".png";
  return name.str();
}

/// Per vertex; what lies outside the workspace is in no segment, and not searched for.
std::vector<std::uint32_t> segments_of(const TriangleMesh& mesh, const SegmentedPoints& surface, const Box& workspace,
                                       const Executor& executor) {
  std::vector<std::size_t> inside;
  std::vector<Eigen::Vector3d> places_m;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d vertex = mesh.vertices[i].cast<double>();
    if (!contains(workspace, vertex)) continue;
    inside.push_back(i);
    places_m.push_back(vertex);
  }
  const std::vector<std::uint32_t> segments = nearest_segments(surface, places_m, executor);
  std::vector<std::uint32_t> labels(mesh.vertices.size(), kUnlabelled);
  for (std::size_t i = 0; i < inside.size(); ++i) labels[inside[i]] = segments[i];
  return labels;
}

Status draw_saliency(const RunFolder& out, const ViewScenes& scenes, const Executor& executor) {
  const ViewChoice& choice = *scenes.view.choice;
  if (!choice.surface) return {};
  const TriangleMesh mesh = extract_mesh(scenes.before, executor);
  const std::vector<std::uint32_t> labels = segments_of(mesh, choice.surface->points, scenes.workspace, executor);
  std::vector<DrawnContour> contours;
  for (std::size_t i = 0; choice.contours && i < choice.contours->points.size(); ++i) {
    const ContourPoint& contour = choice.contours->points[i];
    contours.push_back({contour.position_m, contour.normal, choice.segment == choice.contours->segment_of_point[i]});
  }
  return write_png(out / picture_name(scenes.number, "saliency"),
                   saliency_picture({mesh, labels, choice.saliency, contours, scenes.workspace,
                                     scenes.view.T_world_camera, scenes.camera},
                                    executor));
}

}  // namespace

std::string end_text(const RunRecord& run, const std::string& gain_unit) {
  if (run.stopped_because != StopReason::regions_done || run.regions.empty()) return "";
  const RegionResult& last = run.regions.back();
  if (!(last.gain_left > 0.0)) return "no view promises anything";
  return "the best view left promises " + fixed(last.gain_left, 1) + ' ' + gain_unit + ", " +
         fixed(last.gain_needed, 1) + " would be worth the move";
}

Status draw_view(const RunFolder& out, const ViewScenes& scenes, const Executor& executor) {
  std::vector<ScoredPose> candidates;
  for (const RankedView& view : scenes.view.choice->candidates) candidates.push_back({view.T_world_camera, view.gain});
  SACCADE_CHECK(draw_saliency(out, scenes, executor));
  CandidatesPictureConfig config;
  config.sensor = scenes.camera;
  config.gain_unit = scenes.gain_unit;
  SACCADE_CHECK(
      write_png(out / picture_name(scenes.number, "choice"),
                candidates_picture({scenes.before, scenes.view.choice->region, candidates, scenes.view.T_world_camera,
                                    scenes.T_world_earlier, scenes.robot, scenes.surfels_before},
                                   executor, config)));
  if (!scenes.frames.empty()) {
    const Frame& middle = scenes.frames[scenes.frames.size() / 2];
    const DepthScale scale{scenes.camera.min_range_m, scenes.camera.max_range_m};
    SACCADE_CHECK(write_png(out / picture_name(scenes.number, "seen"), seen_picture(middle, scale)));
  }
  MapPictureConfig map;
  map.robot = scenes.robot;
  map.surfels = scenes.surfels_after;
  return write_png(out / picture_name(scenes.number, "map"),
                   map_picture(scenes.after, scenes.workspace, executor, map));
}

Status draw_scan(const RunFolder& out, const TsdfSnapshot& map, const Box& workspace, const Executor& executor,
                 const RobotDrawing* robot, const DrawnSurfels* surfels) {
  MapPictureConfig config;
  config.robot = robot;
  config.surfels = surfels;
  return write_png(out / picture_name(0, "map"), map_picture(map, workspace, executor, config));
}

bool is_view_file(const std::string& file_name) {
  return file_name.starts_with("view-") &&
         (file_name.ends_with(".png") || file_name.ends_with(".json") || file_name.ends_with(".sacmap"));
}

}  // namespace saccade::cli
