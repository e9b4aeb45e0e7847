// SPDX-License-Identifier: Apache-2.0
// Segments of clouds and maps, their saliency, and their agreement with a ground truth.
#include "arrays.hpp"
#include "map.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/cloud/surfel_estimates.hpp"
#include "saccade/segment/flood_fill.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/segment/live_segments.hpp"
#include "saccade/segment/overlap.hpp"
#include "saccade/segment/score_curve.hpp"
#include "saccade/segment/segmentation_truth.hpp"

namespace saccade::python {
namespace {

enum class SegmentWay { lccp, sv_lccp, flood_fill };
constexpr auto kSegmentWayNames = make_names<SegmentWay>(
    {{SegmentWay::lccp, "lccp"}, {SegmentWay::sv_lccp, "sv-lccp"}, {SegmentWay::flood_fill, "flood-fill"}});

/// Settings that a caller may change; others are the method's.
struct SegmentSettings {
  std::optional<double> voxel_size_m, seed_spacing_m, spatial_weight, normal_weight, color_weight, threshold;
  std::optional<int> rounds;
  bool single_camera{false};
  Eigen::Vector3d viewpoint_m{Eigen::Vector3d::Zero()};
  LccpConfig lccp;

  [[nodiscard]] SupervoxelConfig over(SupervoxelConfig config) const {
    config.voxels.voxel_size_m = voxel_size_m.value_or(config.voxels.voxel_size_m);
    config.voxels.single_camera = single_camera;
    config.voxels.viewpoint_m = viewpoint_m;
    config.seed_spacing_m = seed_spacing_m.value_or(config.seed_spacing_m);
    config.spatial_weight = spatial_weight.value_or(config.spatial_weight);
    config.normal_weight = normal_weight.value_or(config.normal_weight);
    config.color_weight = color_weight.value_or(config.color_weight);
    config.rounds = rounds.value_or(config.rounds);
    return config;
  }
};

Result<std::vector<std::uint32_t>> fill(PointCloud cloud, const SegmentSettings& settings, const Executor& executor) {
  FloodFillConfig config;
  config.normal_weight = settings.normal_weight.value_or(config.normal_weight);
  config.color_weight = settings.color_weight.value_or(config.color_weight);
  config.threshold = settings.threshold.value_or(config.threshold);
  if (cloud.radii_m.empty()) cloud.radii_m = surfel_radii(cloud.positions_m, executor);
  if (cloud.normals.empty()) cloud.normals = surfel_normals(cloud.positions_m, settings.viewpoint_m, executor);
  SACCADE_TRY(SurfelComponents found, flood_fill(cloud, config, executor));
  return std::move(found.labels);
}

Result<std::vector<std::uint32_t>> find_segments(const PointCloud& cloud, SegmentWay way,
                                                 const SegmentSettings& settings, const Executor& executor) {
  if (way == SegmentWay::flood_fill) return fill(cloud, settings, executor);
  if (way == SegmentWay::sv_lccp) {
    SvLccpConfig config;
    config.supervoxels = settings.over(config.supervoxels);
    config.lccp = settings.lccp;
    config.max_color_difference = settings.threshold.value_or(config.max_color_difference);
    SACCADE_TRY(SvLccpResult found, segment_by_sv_lccp(cloud, config, executor));
    return std::move(found.segments.labels);
  }
  SACCADE_TRY(const SupervoxelResult supervoxels, find_supervoxels(cloud, settings.over({}), executor));
  SACCADE_TRY(LccpResult found, segment_by_convexity(supervoxels, settings.lccp));
  return std::move(found.labels);
}

/// Rejects options that a method does not use, as the program does.
void check_settings(SegmentWay way, const SegmentSettings& settings) {
  const auto refuse = [&](bool given, const char* name) {
    if (given)
      throw py::value_error{std::string{name} + " has no meaning with method " + std::string{kSegmentWayNames.of(way)}};
  };
  if (way == SegmentWay::lccp) refuse(settings.threshold.has_value(), "threshold");
  if (way != SegmentWay::flood_fill) return;
  refuse(settings.voxel_size_m.has_value(), "voxel_size_m");
  refuse(settings.seed_spacing_m.has_value(), "seed_spacing_m");
  refuse(settings.spatial_weight.has_value(), "spatial_weight");
  refuse(settings.rounds.has_value(), "rounds");
  refuse(settings.single_camera, "single_camera");
}

py::array_t<std::uint32_t> segment(const py::object& points, const std::string& method, const py::object& normals,
                                   const py::object& colors, const py::object& radii,
                                   std::optional<double> voxel_size_m, std::optional<double> seed_spacing_m,
                                   std::optional<double> threshold, std::optional<double> spatial_weight,
                                   std::optional<double> normal_weight, std::optional<double> color_weight,
                                   std::optional<int> rounds, double concavity_deg, std::size_t min_supervoxels,
                                   bool single_camera, const py::object& viewpoint, std::size_t threads) {
  const SegmentWay way = value_of(kSegmentWayNames, method, "method");
  SegmentSettings settings{voxel_size_m, seed_spacing_m, spatial_weight, normal_weight,       color_weight,
                           threshold,    rounds,         single_camera,  to_point(viewpoint), {}};
  settings.lccp.concavity_tolerance_rad = to_rad(concavity_deg);
  settings.lccp.min_supervoxels = min_supervoxels;
  check_settings(way, settings);
  const PointCloud cloud = to_cloud(points, normals, colors, radii);
  settings.viewpoint_m -= cloud.offset_m;
  auto labels = [&] {
    const py::gil_scoped_release released;
    return find_segments(cloud, way, settings, Executor::with_threads(threads));
  }();
  return from_labels(take(std::move(labels)));
}

py::dict segment_surface(const SharedMap& map, double voxel_size_m) {
  MapSegmentsConfig config;
  config.voxel_size_m = voxel_size_m;
  const TsdfSnapshot snapshot = map.snapshot();
  auto found = [&] {
    const py::gil_scoped_release released;
    return segment_map(snapshot, map.executor(), config);
  }();
  MapSegments segments = take(std::move(found));
  py::dict result;
  result["points"] = from_vectors(segments.points.positions_m);
  result["normals"] = from_vectors(segments.points.normals);
  result["labels"] = from_labels(std::move(segments.segments.labels));
  return result;
}

/// Returns H×W×3, NaN where there is no return.
py::array_t<float> depth_points(const PinholeCamera& camera, const py::array& depth,
                                const std::optional<py::array>& T_world_camera) {
  const DepthImage image = to_depth(depth);
  take(camera.validate());
  if (image.width() != camera.width || image.height() != camera.height) {
    throw py::value_error{"the depth image and the camera differ in size"};
  }
  const Pose pose = T_world_camera ? to_pose(*T_world_camera) : Pose::Identity();
  std::vector<float> values;
  values.reserve(image.size() * 3);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const double z = image(u, v);
      const bool is_return = z > 0.0 && z >= camera.min_range_m && z <= camera.max_range_m;
      const Eigen::Vector3d p_world =
          pose * Eigen::Vector3d{(u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z};
      for (int k = 0; k < 3; ++k) {
        values.push_back(is_return ? static_cast<float>(p_world[k]) : std::numeric_limits<float>::quiet_NaN());
      }
    }
  }
  return adopt(std::move(values), {image.height(), image.width(), 3});
}

py::dict score_dict(const SegmentOverlap& all, const SegmentOverlap& objects, const ConsistencyError& consistency,
                    const std::optional<SegmentationScore>& boundaries) {
  py::dict result;
  result["objects"] = objects.objects;
  result["weighted_overlap"] = all.weighted_overlap;
  result["weighted_overlap_objects"] = objects.weighted_overlap;
  result["over_segmentation"] = all.over_segmentation;
  result["under_segmentation"] = all.under_segmentation;
  result["consistency_error"] = boundaries ? boundaries->bce : consistency.bidirectional;
  result["boundary_precision"] = boundaries ? boundaries->precision() : std::nullopt;
  result["boundary_recall"] = boundaries ? boundaries->recall() : std::nullopt;
  result["boundary_f"] = boundaries ? boundaries->f() : std::nullopt;
  return result;
}

py::dict score_labels(const py::object& labels, const py::object& truth, const py::object& points,
                      const py::object& radii, std::uint32_t objects_from, double tolerance_m, bool split,
                      std::size_t threads) {
  const std::vector<std::uint32_t> predicted = to_labels(labels, "labels");
  const std::vector<std::uint32_t> objects = to_labels(truth, "truth");
  const SegmentOverlap all = take(score_segments(predicted, objects));
  const SegmentOverlap some = take(score_segments(predicted, objects, objects_from));
  const ConsistencyError consistency = take(consistency_error(predicted, objects));
  if (points.is_none()) return score_dict(all, some, consistency, std::nullopt);
  PointCloud cloud = to_cloud(points, py::none(), py::none(), radii);
  const auto score = [&]() -> Result<SegmentationScore> {
    const py::gil_scoped_release released;
    const Executor executor = Executor::with_threads(threads);
    if (split && cloud.radii_m.empty()) cloud.radii_m = surfel_radii(cloud.positions_m, executor);
    SegmentationTruthConfig config;
    config.matching.tolerance_m = tolerance_m;
    config.split = split;
    SACCADE_TRY(const SegmentationTruth made, SegmentationTruth::create(cloud, objects, config, executor));
    return made.score(predicted, executor);
  };
  return score_dict(all, some, consistency, take(score()));
}

Result<ScoreCurve> find_curve(PointCloud cloud, const std::vector<std::uint32_t>& objects, SegmentWay way,
                              const std::vector<double>& thresholds, const SegmentationTruthConfig& config,
                              const Executor& executor, const Progress& progress) {
  if (cloud.radii_m.empty()) cloud.radii_m = surfel_radii(cloud.positions_m, executor);
  SACCADE_TRY(const SegmentationTruth truth, SegmentationTruth::create(cloud, objects, config, executor));
  if (way == SegmentWay::flood_fill) {
    if (cloud.normals.empty()) cloud.normals = surfel_normals(cloud.positions_m, Eigen::Vector3d::Zero(), executor);
    return flood_fill_curve(cloud, truth, thresholds, {}, executor, progress);
  }
  const SvLccpConfig sv_lccp;
  SACCADE_TRY(const SupervoxelResult supervoxels, find_supervoxels(cloud, sv_lccp.supervoxels, executor));
  return sv_lccp_curve(supervoxels, truth, thresholds, sv_lccp.lccp, executor, progress);
}

py::dict curve_point(const CurvePoint& point) {
  py::dict result;
  result["threshold"] = point.threshold;
  result["segments"] = point.segments;
  result["boundary_precision"] = point.score.precision();
  result["boundary_recall"] = point.score.recall();
  result["boundary_f"] = point.score.f();
  result["consistency_error"] = point.score.bce;
  return result;
}

py::object point_or_none(const std::optional<CurvePoint>& point) {
  return point ? py::object{curve_point(*point)} : py::none();
}

py::dict segment_curve(const py::object& points, const py::object& truth, const py::object& thresholds,
                       const std::string& method, const py::object& normals, const py::object& colors,
                       const py::object& radii, double tolerance_m, bool split, std::size_t threads,
                       py::object progress) {
  const SegmentWay way = value_of(kSegmentWayNames, method, "method");
  if (way == SegmentWay::lccp) throw py::value_error{"method lccp has no threshold; sv-lccp and flood-fill have one"};
  const PointCloud cloud = to_cloud(points, normals, colors, radii);
  const std::vector<std::uint32_t> objects = to_labels(truth, "truth");
  const std::vector<double> at = to_numbers(thresholds, "thresholds");
  SegmentationTruthConfig config;
  config.matching.tolerance_m = tolerance_m;
  config.split = split;
  CallerProgress told{std::move(progress)};
  auto found = [&] {
    const py::gil_scoped_release released;
    return find_curve(cloud, objects, way, at, config, Executor::with_threads(threads), told.progress());
  }();
  told.rethrow();
  const ScoreCurve curve = take(std::move(found));
  py::list list;
  for (const CurvePoint& point : curve.points) list.append(curve_point(point));
  py::dict result;
  result["points"] = list;
  result["area"] = curve.area();
  result["best_f"] = point_or_none(curve.best_f());
  result["least_consistency_error"] = point_or_none(curve.least_bce());
  return result;
}

SaliencyHeuristic heuristic_of(const std::string& name) {
  if (name == "objectness") return objectness();
  if (name == "roundness") return roundness_alone();
  if (name == "isolation") return isolation_alone();
  if (name == "rough-first") return rough_first();
  throw py::value_error{"heuristic must be objectness, roundness, isolation or rough-first, not " + name};
}

py::array_t<double> segment_saliency(const py::object& points, const py::object& labels, const std::string& heuristic,
                                     std::size_t threads) {
  const SaliencyHeuristic judge = heuristic_of(heuristic);
  const std::vector<Eigen::Vector3f> positions_m = to_cloud(points, py::none(), py::none(), py::none()).positions_m;
  std::vector<std::uint32_t> segments = to_labels(labels, "labels");
  std::uint32_t count{0};
  for (std::uint32_t& label : segments) {
    if (label == kUnlabelled) continue;
    count = std::max(count, label--);
  }
  if (count > segments.size()) throw py::value_error{"labels must count segments from 1, without large gaps"};
  const auto find = [&]() -> Result<std::vector<Saliency>> {
    const py::gil_scoped_release released;
    SACCADE_TRY(const SegmentedPoints segmented, SegmentedPoints::create(positions_m, segments, count));
    SACCADE_TRY(const auto measures, measure_segments(segmented, {}, Executor::with_threads(threads)));
    return judge({segmented, measures, {}});
  };
  std::vector<double> values;
  for (const Saliency& saliency : take(find())) values.push_back(saliency.value);
  return adopt(std::move(values), {static_cast<py::ssize_t>(count)});
}

}  // namespace

void bind_segments(py::module_& module) {
  module.def(
      "segment", &segment, py::arg("points"), py::arg("method") = "lccp", py::kw_only(),
      py::arg("normals") = py::none(), py::arg("colors") = py::none(), py::arg("radii") = py::none(),
      py::arg("voxel_size_m") = py::none(), py::arg("seed_spacing_m") = py::none(), py::arg("threshold") = py::none(),
      py::arg("spatial_weight") = py::none(), py::arg("normal_weight") = py::none(),
      py::arg("color_weight") = py::none(), py::arg("rounds") = py::none(), py::arg("concavity_deg") = 10.0,
      py::arg("min_supervoxels") = 0, py::arg("single_camera") = false,
      py::arg("viewpoint") = py::make_tuple(0.0, 0.0, 0.0), py::arg("threads") = 0,
      "Divides points, N x 3 metres, into segments. `method`: lccp (supervoxels joined where surfaces bend "
      "outwards), sv-lccp (these kept apart by colours) or flood-fill (surfels that touch and look alike; thesis "
      "4.1.2). `normals`: N x 3; `colors`: N x 3, uint8 or floats in [0, 1]; `radii`: N metres; what is None is "
      "estimated, normals towards `viewpoint`, or left out. `single_camera`: points are in a camera's frame, and "
      "voxels grow with depth. None stands for the method's own value. Returns N uint32: 1, 2, ... by segment, 0 "
      "where a point is not finite.");
  module.def("segment_map", &segment_surface, py::arg("map"), py::kw_only(), py::arg("voxel_size_m") = 0.0075,
             "Divides the surface of a TsdfMap into segments. Returns a dict: points N x 3 float32, metres, world "
             "frame; normals N x 3 float32; labels N uint32 from 1.");
  module.def(
      "depth_points", &depth_points, py::arg("camera"), py::arg("depth"), py::arg("T_world_camera") = py::none(),
      "Returns H x W x 3 float32: the point of each pixel, metres, in the world frame, or in the camera's without "
      "a pose; NaN where there is no return within the camera's range.");
  module.def("segment_scores", &score_labels, py::arg("labels"), py::arg("truth"), py::kw_only(),
             py::arg("points") = py::none(), py::arg("radii") = py::none(), py::arg("objects_from") = 1,
             py::arg("tolerance_m") = 0.02, py::arg("split") = true, py::arg("threads") = 0,
             "Compares segments with true ones, N whole numbers each, 0: none. Returns a dict: objects, "
             "weighted_overlap, over_segmentation, under_segmentation; weighted_overlap_objects (of true labels from "
             "`objects_from`); consistency_error (bidirectional, thesis 4.1.2); with `points`, N x 3 metres, "
             "boundary_precision, boundary_recall, boundary_f within `tolerance_m`, and the truth is split where its "
             "surfels do not touch, unless `split` is False.");
  module.def(
      "segment_curve", &segment_curve, py::arg("points"), py::arg("truth"), py::arg("thresholds"),
      py::arg("method") = "sv-lccp", py::kw_only(), py::arg("normals") = py::none(), py::arg("colors") = py::none(),
      py::arg("radii") = py::none(), py::arg("tolerance_m") = 0.02, py::arg("split") = true, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      "Scores segments at many thresholds, of sv-lccp or flood-fill, against true labels (thesis Figs. 4.10 and "
      "4.11, Table 4.3). Arguments as of segment and segment_scores. Returns a dict: points, one a threshold, each "
      "with threshold, segments, boundary_precision, boundary_recall, boundary_f, consistency_error; area below "
      "precision over recall; "
      "best_f and least_consistency_error, the points that have these.");
  module.def(
      "segment_saliency", &segment_saliency, py::arg("points"), py::arg("labels"), py::arg("heuristic") = "objectness",
      py::kw_only(), py::arg("threads") = 0,
      "How much segments draw attention, float64 in [0, 1] for each label from 1. `points`: N x 3 metres; "
      "`labels`: N as of segment. `heuristic`: objectness (thesis eq. 3.12), roundness, isolation, rough-first.");
}

}  // namespace saccade::python
