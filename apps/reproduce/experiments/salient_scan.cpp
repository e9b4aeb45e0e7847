// SPDX-License-Identifier: Apache-2.0
#include "experiments/salient_scan.hpp"

#include <algorithm>

#include "saccade/scene/scene_yaml.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

constexpr const char* kTableScene{"tabletop-2"};  // in place of the thesis' experiment 2
constexpr double kScrap_m{0.1};
constexpr double kTruthSpacing_m{0.01};

Result<TsdfSnapshot> scan_table(const RayScene& scene, const TableOptions& options, const Executor& executor,
                                const Progress& progress) {
  SimulatedRunConfig config;
  config.seed = options.seed;
  TsdfConfig map_config = config.map();
  map_config.workspace = scene.scene().workspace;
  SACCADE_TRY(TsdfMap map, TsdfMap::create(map_config));
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(scene, config));
  SACCADE_TRY(FreeRobot robot, flying_camera(scene));
  FunctionCamera sensor{config.camera,
                        [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose, executor); }};
  Explorer explorer{{map, sensor, robot, executor, nullptr, nullptr, {}, &progress}, config.exploration};
  SACCADE_TRY(const ScanRecord scanned, explorer.scan(scene.scene().scan));
  if (!scanned.complete) return Error{Errc::cancelled, "cancelled", "the scan"};
  return map.snapshot();
}

/// By most of its points: nearer to an object than to a support, or not; of a support and short: a scrap.
std::vector<SegmentOf> kinds_of(const SegmentedPoints& points, std::span<const SegmentMeasures> measures,
                                const GroundTruth& truth) {
  constexpr double kBeyond_m{0.1};
  constexpr std::size_t kSamples{200};
  std::vector<SegmentOf> kinds;
  for (std::size_t s = 0; s < measures.size(); ++s) {
    const std::span<const Eigen::Vector3f> of_segment = points.points_of(s);
    const std::size_t step = std::max<std::size_t>(1, of_segment.size() / kSamples);
    std::size_t looked_at{0}, of_object{0};
    for (std::size_t i = 0; i < of_segment.size(); i += step) {
      const Eigen::Vector3d p = of_segment[i].cast<double>();
      looked_at += 1;
      of_object += truth.to_objects_m(p, kBeyond_m) < truth.to_supports_m(p, kBeyond_m) ? 1 : 0;
    }
    const bool is_short = measures[s].sizes_m.maxCoeff() < kScrap_m;
    const bool is_object = 2 * of_object > looked_at;
    kinds.push_back(is_object ? SegmentOf::object : (is_short ? SegmentOf::scrap : SegmentOf::support));
  }
  return kinds;
}

Result<SegmentedScan> segmented_scan(const TableOptions& options, const Executor& executor, const Progress& progress) {
  progress.report("scanning the table", 0, 3);
  SACCADE_TRY(Scene scene, find_scene(kTableScene));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  SACCADE_TRY(const TsdfSnapshot map, scan_table(rays, options, executor, progress));
  progress.report("segmenting", 1, 3);
  TriangleMesh mesh = extract_mesh(map, executor);
  SACCADE_TRY(const SupervoxelResult supervoxels,
              find_supervoxels({mesh.vertices, mesh.normals, {}}, SupervoxelConfig{}, executor));
  SACCADE_TRY(LccpResult segments, segment_by_convexity(supervoxels));
  SACCADE_TRY(SegmentedPoints points, SegmentedPoints::create(mesh.vertices, segments.labels, segments.segments));
  SACCADE_TRY(std::vector<SegmentMeasures> measures, measure_segments(points, {}, executor));
  progress.report("comparing with the truth", 2, 3);
  SACCADE_TRY(const GroundTruth truth, GroundTruth::build(rays, kTruthSpacing_m, executor));
  std::vector<SegmentOf> kinds = kinds_of(points, measures, truth);
  if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "the segments"};
  constexpr int kPanelWidth_px{560};
  constexpr int kPanelHeight_px{330};
  OverviewConfig overview;
  overview.width = kPanelWidth_px;
  overview.height = kPanelHeight_px;
  overview.azimuth_rad = -2.6;
  const Viewpoint view = overview_of_points(mesh.vertices, overview);
  return SegmentedScan{std::move(mesh), view, std::move(segments.labels), std::move(points), std::move(measures),
                       std::move(kinds)};
}

json judgement_json(const SegmentedScan& scan, const Judgement& judgement) {
  return {{"name", judgement.name},
          {"objects_first", judgement.objects_first(scan)},
          {"objects_at_zero", judgement.objects_at_zero(scan)},
          {"mean_of_objects", judgement.mean_of(scan, SegmentOf::object)},
          {"mean_of_supports", judgement.mean_of(scan, SegmentOf::support)},
          {"mean_of_scraps", judgement.mean_of(scan, SegmentOf::scrap)},
          {"saliency", judgement.values}};
}

}  // namespace

Status carry_out_scan(const TableOptions& options, const Executor& executor, const Progress& progress,
                      std::optional<SegmentedScan>& scan) {
  if (scan) return {};
  SACCADE_TRY(scan, segmented_scan(options, executor, progress));
  return {};
}

Judgement judge(const std::string& name, const SaliencyHeuristic& heuristic, const MeasuredSegments& segments) {
  Judgement judgement{name, {}};
  for (const Saliency& saliency : heuristic(segments)) judgement.values.push_back(saliency.value);
  return judgement;
}

ReproducedTable table_of(const SegmentedScan& scan, const std::vector<Judgement>& judgements,
                         const std::string& first_column) {
  ReproducedTable table;
  table.columns = {first_column,      "objects before any other", "objects at zero",
                   "mean of objects", "mean of supports",         "mean of scraps"};
  json rows = json::array();
  for (const Judgement& judgement : judgements) {
    table.rows.push_back(
        {judgement.name, std::to_string(judgement.objects_first(scan)), std::to_string(judgement.objects_at_zero(scan)),
         fixed(judgement.mean_of(scan, SegmentOf::object), 3), fixed(judgement.mean_of(scan, SegmentOf::support), 3),
         fixed(judgement.mean_of(scan, SegmentOf::scrap), 3)});
    rows.push_back(judgement_json(scan, judgement));
  }
  table.notes.push_back(
      "Simulated: the scene " + std::string{kTableScene} + ", with the noise of a Kinect v1, after its initial scan; " +
      std::to_string(scan.measures.size()) + " segments: " + std::to_string(scan.count(SegmentOf::object)) +
      " of objects, " + std::to_string(scan.count(SegmentOf::support)) + " of supports (table, room) and " +
      std::to_string(scan.count(SegmentOf::scrap)) + " scraps, parts of supports less than " +
      fixed(100.0 * kScrap_m, 0) +
      " cm long. A segment is of an object if most of its points are nearer to one than to "
      "a support. The thesis shows pictures of real tables, without figures.");
  table.figures = {{"scene", kTableScene},
                   {"segments", scan.measures.size()},
                   {"objects", scan.count(SegmentOf::object)},
                   {"supports", scan.count(SegmentOf::support)},
                   {"scraps", scan.count(SegmentOf::scrap)},
                   {"rows", std::move(rows)}};
  return table;
}

double most_of(const Judgement& judgement) {
  return judgement.values.empty() ? 0.0 : *std::max_element(judgement.values.begin(), judgement.values.end());
}

Panel panel_of(const SegmentedScan& scan, const Judgement& judgement, double most, const Executor& executor) {
  return saliency_panel(scan.drawn(), judgement.values, most, scan.view, judgement.name, executor);
}

std::string picture_note() {
  return std::string{"brighter: more salient. The scene "} + kTableScene + " after its initial scan";
}

}  // namespace saccade::reproduce
