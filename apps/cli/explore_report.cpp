// SPDX-License-Identifier: Apache-2.0
#include "explore_report.hpp"

#include <cstddef>
#include <iomanip>
#include <sstream>
#include <utility>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/attention/segmented_points.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/run_report.hpp"
#include "saccade/report/segment_picture.hpp"
#include "saccade/robot/refusal.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMaxPictureBytes{std::uintmax_t{64} << 20U};

std::string picture_name(std::size_t number, const char* kind) {
  std::ostringstream name;
  name << "view-" << std::setw(2) << std::setfill('0') << number << '-' << kind << ".png";
  return name.str();
}

/// Those of the pictures that are there.
std::vector<ReportPicture> pictures_of(const RunFolder& out, std::size_t number,
                                       std::initializer_list<ReportPicture> wanted) {
  std::vector<ReportPicture> pictures;
  for (const ReportPicture& picture : wanted) {
    auto bytes = read_text_file(out / picture_name(number, picture.kind.c_str()), kMaxPictureBytes);
    if (!bytes) continue;
    const auto* first = reinterpret_cast<const std::byte*>(bytes->data());
    pictures.push_back({{first, first + bytes->size()}, picture.caption, picture.alt, picture.kind});
  }
  return pictures;
}

/// "segment 12 of 40, rank 1 by saliency 0.52 (…), 24 of 600 contour points".
std::string attention_text(const ViewAttention& attention) {
  return "segment " + std::to_string(attention.segment + 1) + " of " + std::to_string(attention.segments) +
         ", number " + std::to_string(attention.rank + 1) + " by saliency: " + attention.why + "; " +
         std::to_string(attention.contours_of_segment) + " of " + std::to_string(attention.contours) +
         " contour points";
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

ShownView shown_view(const RunFolder& out, const ViewRecord& view, std::size_t number) {
  ShownView shown{number, view};
  if (std::isfinite(view.gain_observed)) {
    shown.facts.emplace_back("promise kept", fixed(100.0 * view.gain_observed / view.gain_predicted, 0) + " %");
  }
  if (view.attention) shown.facts.emplace_back("attention", attention_text(*view.attention));
  if (view.motion_s > 0.0) {
    shown.facts.emplace_back("robot", fixed(view.motion_s, 1) + " s, camera's way " + fixed(view.path_m, 2) + " m");
  }
  if (view.retreat_s > 0.0) shown.facts.emplace_back("backed out of a contact for", fixed(view.retreat_s, 1) + " s");
  if (const std::string refused = in_words(view.refused); !refused.empty()) {
    shown.facts.emplace_back("refused", refused);
  }
  shown.pictures = pictures_of(
      out, number,
      {{{},
        "What drew the attention: the surface by its saliency, with the contours of the chosen segment",
        "The surface from outside, brighter where it is more salient",
        "saliency"},
       {{}, "The chosen view among its candidates", "The candidates around the region and the chosen view", "choice"},
       {{}, "What the camera saw: colour and depth", "Colour picture beside the depth picture", "seen"},
       {{}, "The map after the view, unknown in black", "The map from outside, unknown in black", "map"}});
  return shown;
}

std::string camera_text(const json& camera) {
  std::ostringstream text;
  text << camera.at("width") << " × " << camera.at("height") << ", f = " << camera.at("fx").get<double>() << " px, "
       << camera.at("min_range_m").get<double>() << "–" << camera.at("max_range_m").get<double>() << " m";
  return text.str();
}

Status draw_view(const RunFolder& out, const ViewScenes& scenes, const Executor& executor) {
  std::vector<ScoredPose> candidates;
  for (const RankedView& view : scenes.view.choice->candidates) candidates.push_back({view.T_world_camera, view.gain});
  SACCADE_CHECK(draw_saliency(out, scenes, executor));
  CandidatesPictureConfig config;
  config.sensor = scenes.camera;
  config.gain_unit = scenes.gain_unit;
  SACCADE_CHECK(write_png(out / picture_name(scenes.number, "choice"),
                          candidates_picture({scenes.before, scenes.view.choice->region, candidates,
                                              scenes.view.T_world_camera, scenes.T_world_earlier, scenes.robot},
                                             executor, config)));
  if (!scenes.frames.empty()) {
    const Frame& middle = scenes.frames[scenes.frames.size() / 2];
    const DepthScale scale{scenes.camera.min_range_m, scenes.camera.max_range_m};
    SACCADE_CHECK(write_png(out / picture_name(scenes.number, "seen"), seen_picture(middle, scale)));
  }
  MapPictureConfig map;
  map.robot = scenes.robot;
  return write_png(out / picture_name(scenes.number, "map"),
                   map_picture(scenes.after, scenes.workspace, executor, map));
}

Status draw_scan(const RunFolder& out, const TsdfSnapshot& map, const Box& workspace, const Executor& executor,
                 const RobotDrawing* robot) {
  MapPictureConfig config;
  config.robot = robot;
  return write_png(out / picture_name(0, "map"), map_picture(map, workspace, executor, config));
}

bool is_view_file(const std::string& file_name) {
  return file_name.starts_with("view-") &&
         (file_name.ends_with(".png") || file_name.ends_with(".json") || file_name.ends_with(".sacmap"));
}

Status write_report(const RunFolder& out, const RunRecord& run, const Measures& final, const json& document,
                    const ExploreOptions& options) {
  const json& result = document.at("result");
  RunReport report;
  report.scene = result.at("scene").get<std::string>();
  report.title = (options.dry_run ? "Dry run, in which nothing moves, of " : "Exploration of ") + report.scene;
  report.strategy = result.at("strategy").get<std::string>();
  report.robot = result.at("robot").get<std::string>();
  report.draws_robot = options.has_arm();
  report.noise = noise_name(options.run);
  if (!options.camera_command.empty()) report.noise.clear();
  report.seed = document.at("seed").get<std::uint64_t>();
  report.threads = document.at("threads").get<std::size_t>();
  report.version = document.at("version").get<std::string>();
  std::ostringstream voxel;
  voxel << 1e3 * options.run.voxel_size_m << " mm";
  report.facts = {{"voxel size", voxel.str()},
                  {"camera", camera_text(result.at("camera"))},
                  {"back end", document.at("backend").get<std::string>()}};
  report.min_gain = options.run.planner.min_gain;
  report.gain_unit = options.run.strategy.gain_unit;
  report.stop_reason = to_string(run.stopped_because);
  if (const std::string why = end_text(run, report.gain_unit); !why.empty())
    report.facts.emplace_back("at the end", why);
  report.initial.measures = run.scan.measures;
  if (const std::string refused = in_words(run.scan.refused); !refused.empty()) {
    report.initial.facts.emplace_back("poses passed over", refused);
  }
  report.initial.pictures =
      pictures_of(out, 0, {{{}, "The map after the scan, unknown in black", "The map from outside", "map"}});
  for (const ViewRecord& view : run.views) report.views.push_back(shown_view(out, view, report.views.size() + 1));
  report.final = final;
  report.links = {{"mesh.ply", "the surface, with colours"},
                  {"map.sacmap", "the map of occupied, empty and unknown, for saccade nbv"},
                  {"run.json", "all figures, for programs"}};
  return write_file_atomically(out / "report.html", run_report_html(report));
}

}  // namespace saccade::cli
