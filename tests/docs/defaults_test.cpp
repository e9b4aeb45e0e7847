// SPDX-License-Identifier: Apache-2.0
// docs/reference/defaults.md says what the code does: each row named here is looked up in the table and compared.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "saccade/annotate/label_seeds.hpp"
#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/arm/arm_collision.hpp"
#include "saccade/arm/arm_silhouette.hpp"
#include "saccade/arm/internal/swept_cells.hpp"
#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/obstacle_map.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/attention/dip_detector.hpp"
#include "saccade/attention/gmm_as.hpp"
#include "saccade/attention/hand_recorder.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/attention/zvc.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/explore/environment_update.hpp"
#include "saccade/map/tsdf_grid.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/segment/flood_fill.hpp"
#include "saccade/segment/internal/boundary_matching.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/segment/live_segments.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "saccade/views/contours.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

/// The cell "default" of the row whose cell "in the code" is `name`; empty without such a row.
std::string documented(const std::string& name) {
  std::ifstream file{test::source_folder() / "docs/reference/defaults.md"};
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::istringstream row{line};
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    if (cells.size() > 4 && cells[4] == " `" + name + "` ") return cells[2];
  }
  return {};
}

void expect_documented(const std::string& name, const std::vector<double>& values) {
  std::istringstream cell{documented(name)};
  for (const double value : values) {
    double shown = 0.0;
    cell >> shown;
    EXPECT_TRUE(cell) << name << " has too few values in docs/reference/defaults.md";
    EXPECT_NEAR(shown, value, 1e-9) << name;
    cell.ignore(1, ',');
  }
}

double degrees(double rad) { return rad * 180.0 / std::numbers::pi; }

TEST(Defaults, OfTheMapAreDocumented) {
  const TsdfConfig map;
  expect_documented("TsdfConfig::voxel_size_m", {map.voxel_size_m});
  expect_documented("TsdfConfig::truncation_vox", {map.truncation_vox});
  expect_documented("TsdfConfig::max_weight", {static_cast<double>(map.max_weight)});
  expect_documented("TsdfConfig::free_weight", {static_cast<double>(map.free_weight)});
  expect_documented("TsdfConfig::clearing_percent", {static_cast<double>(map.clearing_percent)});
}

TEST(Defaults, OfArmsAreDocumented) {
  const IkConfig ik;
  expect_documented("IkConfig::max_turns", {static_cast<double>(ik.max_turns)});
  expect_documented("IkConfig::redundancy_samples", {static_cast<double>(ik.redundancy_samples)});
  expect_documented("NumericIkConfig::restarts", {static_cast<double>(ik.numeric.restarts)});
  expect_documented("NumericIkConfig::max_solutions", {static_cast<double>(ik.numeric.max_solutions)});
  expect_documented("NumericIkConfig::iterations", {static_cast<double>(ik.numeric.iterations)});
  expect_documented("UrdfConfig::default_speed", {UrdfConfig{}.default_speed});
  expect_documented("UrdfConfig::acceleration_time_s", {UrdfConfig{}.acceleration_time_s});
  expect_documented("UrdfConfig::xacro_timeout_s", {UrdfConfig{}.xacro_timeout_s});
  const ArmSilhouetteConfig silhouette;
  expect_documented("ArmSilhouetteConfig::margin_m", {silhouette.margin_m});
  expect_documented("ArmSilhouetteConfig::border_px", {silhouette.border_px});
  expect_documented("ArmSilhouetteConfig::most_share", {silhouette.most_share});
  expect_documented("ArmSilhouetteConfig::depth_error_per_m", {silhouette.depth_error_per_m});
}

TEST(Defaults, OfExplorationsAreDocumented) {
  expect_documented("attention_planner().min_gain", {attention_planner().min_gain});
  expect_documented("SalientObjectsConfig::scrap_length_m", {SalientObjectsConfig{}.scrap_length_m});
  expect_documented("SalientObjectsConfig::reach_m", {SalientObjectsConfig{}.reach_m});
  expect_documented("ViewPlannerConfig::rival_share", {ViewPlannerConfig{}.rival_share});
  const SimulatedRunConfig run;
  expect_documented("SimulatedRunConfig::truncation_vox", {run.truncation_vox});
  expect_documented("SimulatedRunConfig::gain_width_px", {static_cast<double>(run.gain_width_px)});
  expect_documented("ViewPlannerConfig::min_gain", {ViewPlannerConfig{}.min_gain});
  expect_documented("ExplorerConfig::good_enough", {run.exploration.good_enough});
  expect_documented("ExplorerConfig::max_views", {static_cast<double>(run.exploration.max_views)});
  expect_documented("ExplorerConfig::oscillation_frames", {static_cast<double>(run.exploration.oscillation_frames)});
  expect_documented("ExplorerConfig::oscillation_rad", {degrees(run.exploration.oscillation_rad)});
  expect_documented("kCameraClearance_m", {kCameraClearance_m});
  expect_documented("kUpdateMinGain", {kUpdateMinGain});
  expect_documented("kUpdateMaxViews", {static_cast<double>(kUpdateMaxViews)});
  expect_documented("kSpeedWhileFusing", {kSpeedWhileFusing});
  expect_documented("kFrameOnWay_s", {kFrameOnWay_s});
}

TEST(Defaults, OfAttentionAreDocumented) {
  const GmmAsConfig gmm;
  expect_documented("GmmAsConfig::bic_threshold", {gmm.bic_threshold});
  expect_documented("GmmAsConfig::max_gaussians", {static_cast<double>(gmm.max_gaussians)});
  expect_documented("GmmAsConfig::poi_threshold", {gmm.poi_threshold});
  expect_documented("GmmAsConfig::neighbours", {static_cast<double>(gmm.neighbours)});
  expect_documented("GmmEmConfig::covariance_floor", {gmm.em.covariance_floor});
  expect_documented("GmmEmConfig::relative_stop", {gmm.em.relative_stop});
  expect_documented("GmmEmConfig::max_iterations", {static_cast<double>(gmm.em.max_iterations)});
  const ZvcConfig zvc;
  expect_documented("ZvcConfig::half_window", {static_cast<double>(zvc.half_window)});
  expect_documented("ZvcConfig::near_m", {zvc.near_m});
  expect_documented("ZvcConfig::far_m", {zvc.far_m});
  expect_documented("ZvcConfig::threshold", {zvc.threshold});
  const DipConfig dips;
  expect_documented("DipConfig::kernel", {dips.kernel.length_m, dips.kernel.speed_noise_share});
  expect_documented("DipConfig::max_kernel_share", {dips.max_kernel_share});
  expect_documented("DipConfig::prominence", {dips.prominence.drop, dips.prominence.rise});
  expect_documented("DipConfig::speed_floor_share", {dips.speed_floor_share});
  expect_documented("DipConfig::outlier_limit", {dips.outlier_limit});
  const DipStreamConfig stream;
  expect_documented("DipStreamConfig::kernel", {stream.kernel.length_m, stream.kernel.speed_noise_share});
  expect_documented("DipStreamConfig::delay", {stream.delay});
  expect_documented("DipStreamConfig::prominence", {stream.prominence.drop, stream.prominence.rise});
  expect_documented("DipStreamConfig::speed_floor_share", {stream.speed_floor_share});
  expect_documented("DipStreamConfig::outlier_limit", {stream.outlier_limit});
  expect_documented("EvaluationConditions::match_radius_m", {EvaluationConditions{}.match_radius_m});
  const HandRecorderConfig recorder;
  expect_documented("SimulatedHandConfig::grip_share",
                    {SimulatedHandConfig{}.grip_share, SimulatedHandConfig{}.wrist_m});
  expect_documented("HandRecorderConfig::margin_m", {recorder.margin_m});
  expect_documented("HandRecorderConfig::dropout_s", {recorder.dropout_s});
}

TEST(Defaults, OfSegmentationAreDocumented) {
  const SupervoxelConfig supervoxels;
  expect_documented("VoxelCloudConfig::voxel_size_m", {supervoxels.voxels.voxel_size_m});
  expect_documented("SupervoxelConfig::seed_spacing_m", {supervoxels.seed_spacing_m});
  expect_documented("SupervoxelConfig::spatial_weight",
                    {supervoxels.spatial_weight, supervoxels.normal_weight, supervoxels.color_weight});
  expect_documented("SupervoxelConfig::rounds", {static_cast<double>(supervoxels.rounds)});
  expect_documented("SupervoxelConfig::min_seed_share", {supervoxels.min_seed_share});
  expect_documented("SupervoxelConfig::reach", {supervoxels.reach});
  const MapSegmentsConfig map;
  expect_documented("MapSegmentsConfig::voxel_size_m", {map.voxel_size_m});
  EXPECT_EQ(map.spatial_weight, supervoxels.spatial_weight);
  EXPECT_EQ(map.normal_weight, supervoxels.normal_weight);
  EXPECT_EQ(map.color_weight, supervoxels.color_weight);
  EXPECT_EQ(map.min_seed_share, supervoxels.min_seed_share);
  const LccpConfig lccp;
  expect_documented("LccpConfig::concavity_tolerance_rad", {degrees(lccp.concavity_tolerance_rad)});
  expect_documented("LccpConfig::smoothness", {lccp.smoothness});
  expect_documented("LccpConfig::min_supervoxels", {static_cast<double>(lccp.min_supervoxels)});
}

TEST(Defaults, OfSurfelsAreDocumented) {
  const SurfelFusionConfig fusion;
  expect_documented("SurfelFusionConfig::image_sigma", {fusion.image_sigma});
  expect_documented("SurfelFusionConfig::depth_tolerance_m",
                    {fusion.depth_tolerance_m, fusion.depth_tolerance_growth_per_m});
  expect_documented("SurfelFusionConfig::max_normal_angle_rad", {fusion.max_normal_angle_rad});
  expect_documented("SurfelFusionConfig::max_view_angle_rad", {fusion.max_view_angle_rad});
  expect_documented("SurfelFusionConfig::max_radius_m", {fusion.max_radius_m});
  const ExposureCompensationConfig exposure;
  expect_documented("ExposureCompensationConfig::step_px", {static_cast<double>(exposure.step_px)});
  expect_documented("ExposureCompensationConfig::darkest", {exposure.darkest, exposure.brightest});
  expect_documented("ExposureCompensationConfig::outlier_color", {exposure.outlier_color});
  expect_documented("ExposureCompensationConfig::settled_weight", {exposure.settled_weight});
  expect_documented("ExposureCompensationConfig::min_samples", {exposure.min_samples, exposure.min_agreement});
  expect_documented("ExposureCompensationConfig::max_gain", {exposure.max_gain});
  const ModeFilterConfig filter;
  expect_documented("GuidedFilterConfig::radius_px", {static_cast<double>(filter.guided.radius_px)});
  expect_documented("GuidedFilterConfig::color_sigma", {filter.guided.color_sigma});
  expect_documented("GuidedFilterConfig::depth_sigma_m", {filter.guided.depth_sigma_m});
  expect_documented("ModeFilterConfig::color_sigmas", {filter.color_sigmas});
  expect_documented("ModeFilterConfig::max_modes", {static_cast<double>(filter.max_modes)});
  expect_documented("ModeFilterConfig::max_depth_change_m", {filter.max_depth_change_m});
  expect_documented("ModeFilterConfig::choice_sigmas", {filter.choice_sigmas});
  expect_documented("ModeSharpeningConfig::strength", {filter.sharpening.strength});
  expect_documented("ModeSharpeningConfig::reach_m", {filter.sharpening.reach_m});
  expect_documented("ModeSharpeningConfig::color_sigma", {filter.sharpening.color_sigma});
}

TEST(Defaults, OfSurfelSegmentationAreDocumented) {
  const FloodFillConfig fill;
  expect_documented("FloodFillConfig::color_weight", {fill.color_weight, fill.normal_weight});
  expect_documented("FloodFillConfig::threshold", {fill.threshold});
  const SvLccpConfig surfels;
  const SupervoxelConfig& of_surfels = surfels.supervoxels;
  expect_documented("SvLccpConfig::supervoxels", {of_surfels.voxels.voxel_size_m, of_surfels.seed_spacing_m});
  expect_documented("SvLccpConfig::supervoxels.spatial_weight",
                    {of_surfels.spatial_weight, of_surfels.normal_weight, of_surfels.color_weight});
  expect_documented("SvLccpConfig::supervoxels.rounds", {static_cast<double>(of_surfels.rounds)});
  expect_documented("SvLccpConfig::max_color_difference", {surfels.max_color_difference});
  const BoundaryMatchingConfig matching;
  expect_documented("BoundaryMatchingConfig::tolerance_m", {matching.tolerance_m});
  expect_documented("BoundaryMatchingConfig::exact_cluster", {static_cast<double>(matching.exact_cluster)});
}

TEST(Defaults, OfSaliencyAreDocumented) {
  const SizePriorConfig size;
  const HeightConfig height;
  expect_documented("MeasureConfig::isolation_distance_m", {MeasureConfig{}.isolation_distance_m});
  expect_documented("SizePriorConfig::size_m", {size.size_m, size.factor});
  expect_documented("HeightConfig::half_height_m", {height.half_height_m});
  expect_documented("HeightConfig::level_rad", {degrees(height.level_rad)});
}

TEST(Defaults, OfDepthFiltersAreDocumented) {
  const DepthFilterConfig filter;
  expect_documented("DepthFilterConfig::baseline_m", {filter.baseline_m});
  EXPECT_EQ(documented("DepthFilterConfig::emitter_side"),
            filter.emitter_side == EmitterSide::left ? " left " : " right ");
  expect_documented("DepthFilterConfig::veil_angle_rad", {degrees(filter.veil_angle_rad)});
  expect_documented("DepthFilterConfig::baseline_uncertainty", {filter.baseline_uncertainty});
  expect_documented("DepthFilterConfig::tolerance_m", {filter.tolerance_m, filter.tolerance_per_m});
  const TimeOfFlightConfig measuring;
  expect_documented("TimeOfFlightConfig::baseline_m", {measuring.baseline_m});
  expect_documented("TimeOfFlightConfig::shadow_bias_m", {measuring.shadow_bias_m, measuring.shadow_sigma_m});
  expect_documented("TimeOfFlightConfig::footprint_px", {measuring.footprint_px});
  expect_documented("TimeOfFlightConfig::footprint_samples", {static_cast<double>(measuring.footprint_samples)});
  expect_documented("TimeOfFlightConfig::veil_distance_m", {measuring.veil_distance_m});
  expect_documented("TimeOfFlightConfig::noise", {measuring.noise.base_m});
}

TEST(Defaults, OfViewsAreDocumented) {
  const ViewSphereConfig sphere;
  expect_documented("ViewSphereConfig::radii_m", sphere.radii_m);
  expect_documented("ViewSphereConfig::longitude_step_rad", {degrees(sphere.longitude_step_rad)});
  expect_documented("ViewSphereConfig::latitude_step_rad", {degrees(sphere.latitude_step_rad)});
  expect_documented("ViewSphereConfig::roll_step_rad", {degrees(sphere.roll_step_rad)});
  expect_documented("GainConfig::tilt_rad", {degrees(GainConfig{}.tilt_rad)});
}

TEST(Defaults, OfContoursAreDocumented) {
  const ContourConfig contours;
  expect_documented("ContourConfig::known_weight", {static_cast<double>(contours.known_weight)});
  expect_documented("ContourConfig::group_distance_m", {contours.group_distance_m});
  expect_documented("ContourConfig::group_angle_rad", {degrees(contours.group_angle_rad)});
  const ContourViewConfig views;
  expect_documented("ContourViewConfig::distances_m", views.distances_m);
  expect_documented("ContourViewConfig::cone_rad", {degrees(views.cone_rad)});
  expect_documented("ContourViewConfig::roll_step_rad", {degrees(views.roll_step_rad)});
}

TEST(Defaults, OfObstaclesAreDocumented) {
  const ObstacleConfig obstacles;
  expect_documented("ObstacleConfig::cell_size_m", {obstacles.cell_size_m});
  expect_documented("ObstacleConfig::max_distance_m", {obstacles.max_distance_m});
  const ArmCollisionConfig arm;
  expect_documented("ArmCollisionConfig::max_excess_m", {arm.max_excess_m});
  expect_documented("ArmCollisionConfig::max_step_m", {arm.max_step_m});
  expect_documented("SweptCells::kMargin_m", {SweptCells::kMargin_m});
  expect_documented("SimulatedJoints::kSample_s", {SimulatedJoints::kSample_s});
}

TEST(Defaults, OfMotionPlanningAreDocumented) {
  const MotionPlannerConfig planning;
  EXPECT_EQ(documented("MotionPlannerConfig::planner"), " " + planning.planner + " ");
  expect_documented("MotionPlannerConfig::max_motions", {static_cast<double>(planning.max_motions)});
  expect_documented("MotionPlannerConfig::budget_s", {planning.budget_s});
  expect_documented("MotionPlannerConfig::shortcut_tries", {static_cast<double>(planning.shortcut_tries)});
}

TEST(Defaults, OfTrackingAreDocumented) {
  const IcpConfig icp;
  expect_documented("IcpConfig::strides", {icp.strides.begin(), icp.strides.end()});
  expect_documented("IcpConfig::iterations", {icp.iterations.begin(), icp.iterations.end()});
  expect_documented("IcpConfig::max_distance_m", {icp.max_distance_m});
  expect_documented("IcpConfig::max_normal_angle_rad", {icp.max_normal_angle_rad});
  expect_documented("IcpConfig::min_inlier_share", {icp.min_inlier_share});
  expect_documented("IcpConfig::min_agreement", {icp.min_agreement});
  expect_documented("IcpConfig::max_rmse_m", {icp.max_rmse_m});
  expect_documented("IcpConfig::max_translation_m", {icp.max_translation_m});
  expect_documented("IcpConfig::max_rotation_rad", {icp.max_rotation_rad});
  expect_documented("kRotationTolerance", {kRotationTolerance});
}

TEST(Defaults, OfAnnotationAreDocumented) {
  const NeighbourhoodConfig graph;
  expect_documented("NeighbourhoodConfig::neighbours", {static_cast<double>(graph.neighbours)});
  expect_documented("NeighbourhoodConfig::position_weight_per_m", {graph.position_weight_per_m});
  expect_documented("NeighbourhoodConfig::normal_weight", {graph.normal_weight});
  expect_documented("NeighbourhoodConfig::color_weight", {graph.color_weight});
  expect_documented("NeighbourhoodConfig::max_path", {graph.max_path});
  const SeedConfig seeds;
  expect_documented("SeedConfig::share", {seeds.share});
  expect_documented("SeedConfig::most_per_label", {static_cast<double>(seeds.most_per_label)});
}

TEST(Defaults, ARowThatIsNotThereFails) { EXPECT_TRUE(documented("TsdfConfig::nothing").empty()); }

}  // namespace
}  // namespace saccade
