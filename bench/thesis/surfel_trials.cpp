// SPDX-License-Identifier: Apache-2.0
#include "thesis/surfel_trials.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/scene/internal/truth_labels.hpp"
#include "saccade/scene/rendered_sequence.hpp"
#include "saccade/segment/internal/surfel_graph.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/views/gain.hpp"
#include "thesis/surfel_figures.hpp"

namespace saccade::thesis {
namespace {

struct SurfelClouds {
  std::array<PointCloud, 2> by_colors;
  std::vector<Eigen::Vector3f> mode_positions_m;
  std::vector<double> frame_ms;
  std::vector<double> true_gains;
  std::vector<double> found_gains;
};

Result<RenderedSequence> begin_sequence(const SurfelScene& scene, const RayScene& rays, std::size_t frames,
                                        const SurfelTrialConfig& config, const Executor& executor) {
  SACCADE_TRY(RenderedSequenceConfig sensor, surfel_sensor(scene.sensor));
  sensor.color = scene.color;
  sensor.color.seed = config.seed;
  sensor.color.automatic_gain = config.automatic_gain.value_or(scene.color.automatic_gain);
  if (sensor.depth_noise) sensor.depth_noise->seed = config.seed;
  if (sensor.pose_noise) sensor.pose_noise->seed = config.seed;
  if (sensor.time_of_flight) sensor.time_of_flight->noise.seed = config.seed;
  if (!config.noise) {
    sensor.color.noise = false;
    sensor.pose_noise.reset();
    sensor.depth_noise.reset();
    sensor.time_of_flight.reset();
  }
  if (config.image_width_px > 0) {
    sensor.camera = sensor.camera.scaled_to_width(std::min(config.image_width_px, sensor.camera.width));
  }
  return RenderedSequence::create(rays, hand_held_poses(scene.path, frames, config.seed), sensor, executor);
}

/// @param all_frames  of the thesis' scene.
Result<SurfelClouds> fuse(RenderedSequence& sequence, bool is_vignetted, std::size_t all_frames,
                          const SurfelTrialConfig& config, const Executor& executor, const Progress& progress,
                          const std::string& stage) {
  SurfelFusionConfig fusing;
  fusing.image_sigma = is_vignetted ? kVignettedSigma : kImageSigma;
  SACCADE_TRY(SurfelFusion fusion, SurfelFusion::create(fusing));
  SACCADE_TRY(ModeFilter filter, ModeFilter::create(config.mode_filter));
  SACCADE_TRY(ExposureCompensation exposure, ExposureCompensation::create());
  SurfelClouds clouds;
  for (;;) {
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", stage};
    progress.report(stage, clouds.frame_ms.size(), *sequence.size());
    SACCADE_TRY(std::optional<Frame> frame, sequence.next());
    if (!frame) break;
    const Stopwatch stopwatch;
    const auto fused = config.exposure_compensation ? fusion.add_frame(*frame, sequence.camera(), exposure, executor)
                                                    : fusion.add_frame(*frame, sequence.camera(), executor);
    if (!fused) return fused.error();
    if (const auto filtered = filter.add_frame(*frame, fusion.association(), executor); !filtered) {
      return filtered.error();
    }
    clouds.frame_ms.push_back(stopwatch.elapsed_ms());
    clouds.true_gains.push_back(sequence.truth().gain);
    clouds.found_gains.push_back(fused->exposure ? fused->exposure->gain : 1.0);
  }
  const double share = std::min(1.0, double(clouds.frame_ms.size()) / double(all_frames));
  const SurfelMap& map = fusion.map();
  const std::vector<SurfelMode> winners = filter.winners(executor);
  for (SurfelId id = 0; id < map.size(); ++id) {
    const SurfelDisc& disc = map.discs[id];
    if (static_cast<double>(disc.weight) < share * config.min_weight || winners[id].weight <= 0.0F) continue;
    const auto add = [&](SurfelColors colors, const Eigen::Vector3f& position_m, const Eigen::Vector3f& shown) {
      PointCloud& cloud = clouds.by_colors[static_cast<std::size_t>(colors)];
      cloud.positions_m.push_back(position_m);
      cloud.normals.push_back(disc.normal);
      cloud.colors.push_back(shown);
      cloud.radii_m.push_back(disc.radius_m);
    };
    add(SurfelColors::average, disc.position_m, map.colors[id].color);
    add(SurfelColors::modes, config.places_of_modes ? winners[id].position_m : disc.position_m, winners[id].color);
    clouds.mode_positions_m.push_back(winners[id].position_m);
  }
  return clouds;
}

/// Returns the true labels at the surfels' positions without enhancement, at which the thesis' were annotated.
Result<std::vector<std::uint32_t>> true_labels(const PointCloud& cloud, const RayScene& rays,
                                               const Executor& executor) {
  constexpr std::size_t kLookedUpAtOnce{1024};
  SACCADE_TRY(const TruthLabels truth, TruthLabels::build(rays));
  std::vector<std::uint32_t> labels(cloud.positions_m.size(), kUnlabelled);
  executor.parallel_for(labels.size(), kLookedUpAtOnce, [&](std::size_t begin, std::size_t end) {
    constexpr double kBeyond_m{0.03};
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint16_t label =
          truth.label(cloud.positions_m[i].cast<double>(), kBeyond_m, cloud.normals[i].cast<double>());
      if (label != 0) labels[i] = label;
    }
  });
  return labels;
}

/// SurfelColors::truth.
PointCloud with_true_colors(PointCloud cloud, const PointCloud& enhanced, const std::vector<std::uint32_t>& labels) {
  std::map<std::uint32_t, std::pair<Eigen::Vector3d, double>> sums;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    auto& [sum, count] = sums.try_emplace(labels[i], Eigen::Vector3d::Zero(), 0.0).first->second;
    sum += enhanced.colors[i].cast<double>();
    ++count;
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto& [sum, count] = sums.at(labels[i]);
    cloud.colors[i] = labels[i] == kUnlabelled ? enhanced.colors[i] : (sum / count).cast<float>();
  }
  return cloud;
}

/// With the sizes and weights of Table 4.2.
SvLccpConfig thesis_sv_lccp(SvLccpConfig config) {
  SupervoxelConfig& growing = config.supervoxels;
  growing.voxels.voxel_size_m = kVoxel_m;
  growing.seed_spacing_m = kSupervoxel_m;
  growing.spatial_weight = kPositionWeight;
  growing.normal_weight = kNormalWeight;
  growing.color_weight = kColorWeight;
  return config;
}

FloodFillConfig thesis_flood_fill(FloodFillConfig config) {
  config.color_weight = kColorWeight;
  config.normal_weight = kNormalWeight;
  return config;
}

/// With the grid of seeds moved along its diagonal by a share of its spacing.
Result<ScoreCurve> sv_lccp_curve_at(PointCloud cloud, double share, const SvLccpConfig& config,
                                    const SegmentationTruth& truth, const std::vector<double>& thresholds,
                                    const Progress& progress) {
  const auto step_m = static_cast<float>(share * kSupervoxel_m);
  for (Eigen::Vector3f& position_m : cloud.positions_m) position_m.array() += step_m;
  const Executor here;
  SACCADE_TRY(const SupervoxelResult supervoxels, find_supervoxels(cloud, config.supervoxels, here));
  return sv_lccp_curve(supervoxels, truth, thresholds, config.lccp, here, progress);
}

/// Where the grid of seeds lies is chance, and with it by how much a supervoxel joins two things: the greatest F of one
/// place and another differ by 0.006 to 0.009 (standard deviation, magazines-2). So the figures of several places are
/// taken together.
Result<ScoreCurve> sv_lccp_curve_of_placements(const PointCloud& cloud, const SvLccpConfig& config,
                                               const SegmentationTruth& truth, const std::vector<double>& thresholds,
                                               std::size_t placements, const Executor& executor,
                                               const Progress& progress) {
  const auto count = static_cast<double>(placements);
  std::vector<Result<ScoreCurve>> curves(placements, ScoreCurve{});
  std::mutex reporting;
  std::size_t done{0};
  executor.parallel_for(placements, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Progress followed{[&followed, &progress](auto&&...) {
        if (progress.cancelled()) followed.request_cancel();
      }};
      curves[i] = sv_lccp_curve_at(cloud, double(i) / count, config, truth, thresholds, followed);
      const std::lock_guard lock{reporting};
      progress.report("SV-LCCP", ++done, placements);
    }
  });
  ScoreCurve together;
  for (const Result<ScoreCurve>& curve : curves) {
    if (!curve) return curve.error();
    together.points.resize(curve->points.size());
    for (std::size_t i = 0; i < curve->points.size(); ++i) {
      CurvePoint& sum = together.points[i];
      const CurvePoint& point = curve->points[i];
      sum.threshold = point.threshold;
      sum.segments += point.segments;
      sum.score.boundary += point.score.boundary;
      sum.score.true_boundary += point.score.true_boundary;
      sum.score.matched += point.score.matched;
      sum.score.distance_m += point.score.distance_m / count;
      sum.score.bce += point.score.bce / count;
    }
  }
  for (CurvePoint& point : together.points) point.segments /= placements;
  return together;
}

Status score(const PointCloud& cloud, const SurfelComponents& segments, SurfelColors colors, std::size_t placements,
             SurfelTrial& trial, const Executor& executor, const Progress& progress) {
  const std::vector<double> thresholds = surfel_thresholds();
  SegmentationTruthConfig truths;
  truths.matching.tolerance_m = kEvaluation_m;
  truths.split = false;  // it is already
  SACCADE_TRY(const SegmentationTruth truth, SegmentationTruth::create(cloud, segments.labels, truths, executor));
  const auto of = static_cast<std::size_t>(colors);
  SACCADE_TRY(trial.flood_fill[of],
              flood_fill_curve(cloud, truth, thresholds, trial.flood_fill_config, executor, progress));
  SACCADE_TRY(trial.sv_lccp[of], sv_lccp_curve_of_placements(cloud, trial.sv_lccp_config, truth, thresholds, placements,
                                                             executor, progress));
  return {};
}

}  // namespace

std::vector<double> surfel_thresholds() {
  constexpr int kThresholds{32};
  constexpr double kLeast{0.0005};
  constexpr double kMost{0.5};
  std::vector<double> thresholds;
  for (int i = 0; i < kThresholds; ++i) {
    thresholds.push_back(kLeast * std::pow(kMost / kLeast, double(i) / (kThresholds - 1)));
  }
  return thresholds;
}

Result<SurfelTrial> carry_out_surfel_trial(std::string_view name, const SurfelTrialConfig& config,
                                           const Executor& executor, const Progress& progress) {
  if (config.placements == 0) return Error{Errc::invalid_argument, "the seeds' grid needs a place", "placements"};
  SACCADE_TRY(const SurfelScene scene, surfel_scene(name));
  SACCADE_TRY(const RayScene rays, RayScene::build(scene.scene));
  SurfelTrial trial;
  trial.scene = name;
  trial.flood_fill_config = thesis_flood_fill(config.flood_fill);
  trial.sv_lccp_config = thesis_sv_lccp(config.sv_lccp);
  trial.frames = config.frames == 0 ? scene.frames : config.frames;
  SACCADE_TRY(RenderedSequence sequence, begin_sequence(scene, rays, trial.frames, config, executor));
  const bool is_vignetted = scene.color.vignetting == Vignetting::on;
  SACCADE_TRY(SurfelClouds clouds,
              fuse(sequence, is_vignetted, scene.frames, config, executor, progress, "surfels of " + trial.scene));
  for (const double gain : clouds.true_gains) trial.true_gains.push_back(gain / clouds.true_gains.front());
  trial.found_gains = std::move(clouds.found_gains);
  std::sort(clouds.frame_ms.begin(), clouds.frame_ms.end());
  trial.ms_per_frame = clouds.frame_ms[clouds.frame_ms.size() / 2];
  const PointCloud& not_enhanced = clouds.by_colors.front();
  SACCADE_TRY(const std::vector<std::uint32_t> labels, true_labels(not_enhanced, rays, executor));
  SACCADE_TRY(const SurfelGraph graph, SurfelGraph::create(not_enhanced));
  SACCADE_TRY(const SurfelComponents segments, split_unconnected(graph, labels, executor));
  trial.surfels = not_enhanced.positions_m.size();
  trial.segments = segments.count;
  for (const SurfelColors colors : kSurfelColors) {
    SACCADE_CHECK(score(clouds.by_colors[static_cast<std::size_t>(colors)], segments, colors, config.placements, trial,
                        executor, progress));
  }
  SACCADE_CHECK(score(with_true_colors(not_enhanced, clouds.by_colors.back(), labels), segments, SurfelColors::truth,
                      config.placements, trial, executor, progress));
  trial.clouds = std::move(clouds.by_colors);
  trial.mode_positions_m = std::move(clouds.mode_positions_m);
  trial.true_segments = segments.labels;
  return trial;
}

Result<BestSegments> best_segments(const SurfelTrial& trial, bool by_flood_fill, SurfelColors colors,
                                   const Executor& executor) {
  const PointCloud& cloud = trial.clouds[static_cast<std::size_t>(colors)];
  const std::optional<CurvePoint> best = trial.curve(by_flood_fill, colors).least_bce();
  if (!best) return Error{Errc::not_found, "the curve has no points", trial.scene};
  BestSegments segments{best->threshold, best->score.bce, {}, 0};
  if (by_flood_fill) {
    FloodFillConfig config = trial.flood_fill_config;
    config.threshold = best->threshold;
    SACCADE_TRY(SurfelComponents found, flood_fill(cloud, config, executor));
    segments.labels = std::move(found.labels);
    segments.count = found.count;
  } else {
    SvLccpConfig config = trial.sv_lccp_config;
    config.max_color_difference = best->threshold;
    SACCADE_TRY(SvLccpResult found, segment_by_sv_lccp(cloud, config, executor));
    segments.labels = std::move(found.segments.labels);
    segments.count = found.segments.segments;
  }
  return segments;
}

}  // namespace saccade::thesis
