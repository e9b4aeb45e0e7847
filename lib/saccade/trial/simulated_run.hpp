// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_simulated: one exploration of a scene with known ground truth, measured view by view.

#include <memory>

#include "saccade/arm/planned_arm.hpp"
#include "saccade/core/names.hpp"
#include "saccade/explore/explorer.hpp"
#include "saccade/explore/planners.hpp"
#include "saccade/explore/surfel_model.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/trial/masked_camera.hpp"
#include "saccade/trial/metrics.hpp"

namespace saccade {

/// Depth sensor to simulate.
enum class DepthSensor : std::uint8_t {
  kinect_v1,  ///< kinect_v1_noise
  kinect_v2,  ///< TimeOfFlightConfig, with a DepthFilter on its frames
};
inline constexpr auto kDepthSensorNames =
    make_names<DepthSensor>({{DepthSensor::kinect_v1, "kinect-v1"}, {DepthSensor::kinect_v2, "kinect-v2"}});
[[nodiscard]] constexpr std::string_view to_string(DepthSensor sensor) { return kDepthSensorNames.of(sensor); }

/// Map that a run makes, measures and chooses views on.
enum class MapKind : std::uint8_t {
  volume,   ///< a TsdfMap
  surfels,  ///< a SurfelModel, beside a coarse TsdfMap of what is free
};
inline constexpr auto kMapKindNames = make_names<MapKind>({{MapKind::volume, "volume"}, {MapKind::surfels, "surfels"}});
[[nodiscard]] constexpr std::string_view to_string(MapKind kind) { return kMapKindNames.of(kind); }

struct SimulatedRunConfig {
  MapKind map_kind{MapKind::volume};
  double free_voxel_m{0.02};    ///< surfels: edge of the voxels of free space, half a cell of an arm's obstacles
  double voxel_size_m{0.0058};  ///< volume: its voxels; for either kind the distance within which a point is covered
  double truncation_vox{2.0};   ///< small: depth within 2 m is more accurate than that, and vessels have thin
                                ///< walls
  std::uint8_t clearing_percent{100};                                    ///< TsdfConfig::clearing_percent
  PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 2.0};  ///< beyond 2 m depth is too coarse here
  bool noise{true};                                                      ///< noise of `sensor`; false: exact depth
  DepthSensor sensor{DepthSensor::kinect_v1};
  NamedPlanner strategy{surface_planner()};
  ViewPlannerConfig planner{.min_gain = surface_planner().min_gain};
  ViewSphereConfig sphere;  ///< candidates of planners that explore regions
  ContourConfig contours;   ///< contours for all other planners
  ContourViewConfig contour_views;
  SalientObjectsConfig attention;
  bool weigh_by_saliency{false};                        ///< PlannerSetup
  bool as_printed{false};                               ///< PlannerSetup
  double least_share{SurfaceGainConfig{}.least_share};  ///< PlannerSetup
  /// Candidate views that replace those of every planner, for protocols in which all choose from one set; null: each
  /// planner generates its own.
  std::shared_ptr<const std::vector<Pose>> fixed_views{};
  int gain_width_px{160};  ///< image width of the virtual sensor for choosing views; its field of view is the camera's
  ExplorerConfig exploration;
  std::uint64_t seed{1};                  ///< seed of noise and random choices
  std::shared_ptr<const ArmModel> arm{};  ///< carries the camera in run_simulated; null: the camera flies
  /// Configuration of that arm. Its planner takes `seed`, and all the time that max_motions take.
  PlannedArmConfig arm_robot{};

  [[nodiscard]] Status validate() const;
  /// Returns the configuration for a strategy, planner.min_gain included.
  [[nodiscard]] SimulatedRunConfig with(const NamedPlanner& planner) const;
  /// Returns the configuration of the map, which with surfels is that of free space, except the workspace, which is the
  /// scene's.
  [[nodiscard]] TsdfConfig map() const;
};

/// Returns the planners of explore, and the oracles.
[[nodiscard]] Planners trial_planners();

/// Returns the regions to explore: those of the scene, if it has some and the planner uses them, or its whole
/// workspace; never the true objects.
[[nodiscard]] std::vector<Region> regions_of(const Scene& scene, const NamedPlanner& planner);

/// Makes the planner that config names, for a camera and at least one region.
/// @param truth  ground truth, required by the oracle; others ignore it.
[[nodiscard]] ViewPlanner make_planner(const SimulatedRunConfig& config, const PinholeCamera& camera,
                                       std::span<const Region> regions, const GroundTruth* truth = nullptr);

/// Creates the camera that config describes. Errors: those of SimulatedCamera::create.
[[nodiscard]] Result<SimulatedCamera> simulated_camera(const RayScene& scene, const SimulatedRunConfig& config);

/// Distance that the centre of a flying camera keeps from fixtures.
constexpr double kCameraClearance_m{0.1};
[[nodiscard]] Result<FreeRobot> flying_camera(const RayScene& scene);

/// Creates an arm in the scene. It starts at the first view of the initial scan, unless `robot` or `joints` says
/// otherwise. The scene's fixture_boxes are added to its fixtures. Errors: those of fixture_boxes and
/// PlannedArm::create.
/// @param joints  moves the arm; nullptr: it is simulated
[[nodiscard]] Result<PlannedArm> planned_arm(const ArmModel& arm, const Scene& scene, const SimulatedRunConfig& config,
                                             PlannedArmConfig robot = {},
                                             std::shared_ptr<JointController> joints = nullptr);

/// Measures the map and its mesh. Cost: measure() + extract_mesh().
[[nodiscard]] Measures measure_map(const GroundTruth& truth, const TsdfSnapshot& map, const Executor& executor);

/// Measures the map of a run, or its surfels, where it has some.
/// @param surfels nullptr: the map is a volume
[[nodiscard]] Measures measure_run(const GroundTruth& truth, const TsdfSnapshot& map, const SurfelModel* surfels,
                                   const SimulatedRunConfig& config, const Executor& executor);

/// Compares the map, or the surfels, with the ground truth after the scan and after each view.
class TruthMeter final : public Recorder {
 public:
  /// @param surfels nullptr: the map is a volume
  TruthMeter(GroundTruth truth, const SimulatedRunConfig& config, const SurfelModel* surfels, const Executor& executor)
      : truth_{std::move(truth)}, config_{config}, surfels_{surfels}, executor_{executor} {}
  /// Sets the map before the next view, for a resumed run, which records no scan.
  void begin(const TsdfSnapshot& map) { before_ = map; }
  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override;
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;

 private:
  GroundTruth truth_;
  SimulatedRunConfig config_;
  const SurfelModel* surfels_;
  Executor executor_;
  TsdfSnapshot before_;
};

/// Explores the scene of `truth` with the arm of config, or a flying camera, and measures after every view.
/// @param planner your own, instead of the one that config names; it chooses views on a volume
/// @return invalid_argument for a planner of your own and surfels; errors of SimulatedRunConfig::validate, Explorer,
/// TsdfMap::create, and with an arm of planned_arm and MaskedCamera. The measures depend on the seed only, not on the
/// thread count or a busy machine.
[[nodiscard]] Result<RunRecord> run_simulated(const GroundTruth& truth, const SimulatedRunConfig& config,
                                              ViewPlanner& planner, const Executor& executor,
                                              const Progress& progress = {});
[[nodiscard]] Result<RunRecord> run_simulated(const GroundTruth& truth, const SimulatedRunConfig& config,
                                              const Executor& executor, const Progress& progress = {});

}  // namespace saccade
