// SPDX-License-Identifier: Apache-2.0
// Figs. 3.8 and 3.9: what roundness and isolation bring to saliency, and the distance B_th of isolation; here on a
// simulated table after the initial scan.
#include <algorithm>
#include <array>
#include <optional>

#include "saccade/attention/saliency.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/mesh_picture.hpp"
#include "saccade/report/segment_picture.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "summary.hpp"
#include "tables/thesis_table.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr const char* kTableScene{"tabletop-2"};  // in place of the thesis' experiment 2
constexpr double kScrap_m{0.1};
constexpr double kBetweenVertices_m{0.006};  // about a voxel
constexpr double kTruthSpacing_m{0.01};

/// What a segment is of.
enum class SegmentOf : std::uint8_t { object, support, scrap };

/// The table as the initial scan left it, in segments.
struct SegmentedScan {
  TriangleMesh mesh;
  Viewpoint view;
  std::vector<std::uint32_t> labels;
  SegmentedPoints points;
  std::vector<SegmentMeasures> measures;  ///< with the default B_th
  std::vector<SegmentOf> kinds;

  [[nodiscard]] DrawnSegments drawn() const {
    return {mesh.vertices, mesh.normals, labels, mesh.triangles, kBetweenVertices_m};
  }
  [[nodiscard]] std::size_t count(SegmentOf kind) const {
    return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), kind));
  }
};

Result<TsdfSnapshot> scan_table(const RayScene& scene, const ReproduceOptions& options, const Executor& executor,
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
                                const Truth& truth) {
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

Result<SegmentedScan> segmented_scan(const ReproduceOptions& options, const Executor& executor,
                                     const Progress& progress) {
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
  SACCADE_TRY(const Truth truth, Truth::build(rays, kTruthSpacing_m, executor));
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

/// What a saliency makes of the segments.
struct Judgement {
  std::string name;
  std::vector<double> values;

  [[nodiscard]] double mean_of(const SegmentedScan& scan, SegmentOf kind) const {
    double sum{0.0};
    for (std::size_t s = 0; s < values.size(); ++s) sum += scan.kinds[s] == kind ? values[s] : 0.0;
    return sum / static_cast<double>(std::max<std::size_t>(1, scan.count(kind)));
  }
  /// Segments of objects that come before the first other one.
  [[nodiscard]] std::size_t objects_first(const SegmentedScan& scan) const {
    double most_other{0.0};
    for (std::size_t s = 0; s < values.size(); ++s) {
      if (scan.kinds[s] != SegmentOf::object) most_other = std::max(most_other, values[s]);
    }
    return count_objects(scan, [&](double value) { return value > most_other; });
  }
  [[nodiscard]] std::size_t objects_at_zero(const SegmentedScan& scan) const {
    return count_objects(scan, [](double value) { return value == 0.0; });
  }

 private:
  template <class Condition>
  [[nodiscard]] std::size_t count_objects(const SegmentedScan& scan, const Condition& condition) const {
    std::size_t count{0};
    for (std::size_t s = 0; s < values.size(); ++s) {
      count += scan.kinds[s] == SegmentOf::object && condition(values[s]) ? 1 : 0;
    }
    return count;
  }
};

Judgement judge(const std::string& name, const SaliencyHeuristic& heuristic, const MeasuredSegments& segments) {
  Judgement judgement{name, {}};
  for (const Saliency& saliency : heuristic(segments)) judgement.values.push_back(saliency.value);
  return judgement;
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

}  // namespace

Result<ReproducedTable> reproduce_figure_3_8(const ReproduceOptions& options, const Executor& executor,
                                             const Progress& progress) {
  SACCADE_TRY(const SegmentedScan scan, segmented_scan(options, executor, progress));
  const MeasuredSegments segments{scan.points, scan.measures, {}};
  const std::vector<Judgement> judgements{judge("roundness alone", roundness_alone(), segments),
                                          judge("isolation alone", isolation_alone(), segments),
                                          judge("roundness and isolation", objectness(), segments)};
  ReproducedTable table = table_of(scan, judgements, "saliency");
  table.caption = "Fig. 3.8: saliency by roundness alone, by isolation alone, and by both (eq. 3.12)";
  table.notes.emplace_back(
      "\"Objects before any other\": how many segments of objects a planner that goes by saliency comes to before the "
      "first segment of something else.");
  std::vector<Panel> panels{segments_panel(scan.drawn(), scan.measures, scan.view, executor)};
  panels[0].title += " of the map's surface";
  for (const Judgement& judgement : judgements) {
    panels.push_back(panel_of(scan, judgement, most_of(judgement), executor));
  }
  table.pictures.push_back(
      {kTablePictureFiles[0], compose({"Saliency of the segments (thesis Fig. 3.8)", panels, picture_note()})});
  return table;
}

Result<ReproducedTable> reproduce_figure_3_9(const ReproduceOptions& options, const Executor& executor,
                                             const Progress& progress) {
  constexpr std::array<double, 5> kDistances_m{0.005, 0.01, 0.02, 0.05, 0.1};  // the thesis'
  SACCADE_TRY(const SegmentedScan scan, segmented_scan(options, executor, progress));
  std::vector<Judgement> judgements;
  for (const double distance_m : kDistances_m) {
    const MeasureConfig config{distance_m};
    SACCADE_TRY(const std::vector<SegmentMeasures> measures, measure_segments(scan.points, config, executor));
    judgements.push_back(judge(fixed(distance_m, 3) + " m", objectness(), {scan.points, measures, config}));
  }
  ReproducedTable table = table_of(scan, judgements, "B_th");
  table.caption = "Fig. 3.9: saliency (eq. 3.12) for five distances B_th of isolation; the thesis takes 0.02 m";
  double most{0.0};  // one scale for all panels
  for (const Judgement& judgement : judgements) most = std::max(most, most_of(judgement));
  std::vector<Panel> panels;
  for (const Judgement& judgement : judgements) {
    panels.push_back(panel_of(scan, judgement, most, executor));
    panels.back().title = "B_th = " + judgement.name;
  }
  table.pictures.push_back(
      {kTablePictureFiles[1], compose({"Saliency for five distances B_th (thesis Fig. 3.9)", panels, picture_note()})});
  return table;
}

}  // namespace saccade::cli
