// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_simulated: one exploration of a scene whose truth is known, measured view by view.

#include <memory>

#include "saccade/arm/planned_arm.hpp"
#include "saccade/core/names.hpp"
#include "saccade/explore/explorer.hpp"
#include "saccade/explore/planners.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/trial/carried_camera.hpp"
#include "saccade/trial/metrics.hpp"

namespace saccade {

/// What a simulated camera's depth is like.
enum class DepthSensor : std::uint8_t {
  kinect_v1,  ///< kinect_v1_noise
  kinect_v2,  ///< TimeOfFlightConfig, and its frames through a DepthFilter
};
inline constexpr auto kDepthSensorNames =
    make_names<DepthSensor>({{DepthSensor::kinect_v1, "kinect-v1"}, {DepthSensor::kinect_v2, "kinect-v2"}});
[[nodiscard]] constexpr std::string_view to_string(DepthSensor sensor) { return kDepthSensorNames.of(sensor); }

struct SimulatedRunConfig {
  double voxel_size_m{0.0058};
  double truncation_vox{2.0};          ///< thin: within 2 m depth is better than that, and vessels have thin walls
  std::uint8_t clearing_percent{100};  ///< of its maps
  PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 2.0};  ///< beyond 2 m depth is too coarse here
  bool noise{true};                                                      ///< of `sensor`; else depth is exact
  DepthSensor sensor{DepthSensor::kinect_v1};
  NamedPlanner strategy{surface_planner()};
  ViewPlannerConfig planner{.min_gain = surface_planner().min_gain};
  ViewSphereConfig sphere;  ///< candidates of planners that look at regions
  ContourConfig contours;   ///< what all others look at
  ContourViewConfig contour_views;
  SalientObjectsConfig attention;
  bool weigh_by_saliency{false};                        ///< PlannerSetup
  bool as_printed{false};                               ///< PlannerSetup
  double least_share{SurfaceGainConfig{}.least_share};  ///< PlannerSetup
  int gain_width_px{
      160};  ///< width of the virtual sensor that views are chosen with; its field of view is the camera's
  ExplorerConfig exploration;
  std::uint64_t seed{1};                  ///< of noise and chance
  std::shared_ptr<const ArmModel> arm{};  ///< carries the camera in run_simulated; null: it flies
  /// Of that arm; its planner takes `seed` for its own, and all the time that max_motions take.
  PlannedArmConfig arm_robot{};

  [[nodiscard]] Status validate() const;
  /// As it is for a strategy, planner.min_gain included.
  [[nodiscard]] SimulatedRunConfig with(const NamedPlanner& planner) const;
  /// Of the map, but for the workspace, which is the scene's.
  [[nodiscard]] TsdfConfig map() const;
};

/// The planners of explore, and the oracle.
[[nodiscard]] Planners trial_planners();

/// Where to look: the regions of the scene, if it has some and the planner heeds them, or its whole workspace; never
/// the true objects.
[[nodiscard]] std::vector<Region> regions_of(const Scene& scene, const NamedPlanner& planner);

/// Makes the planner that config names, for a camera and regions (one at least).
/// @param truth  what the oracle knows, which expects it; others do not look at it.
[[nodiscard]] ViewPlanner make_planner(const SimulatedRunConfig& config, const PinholeCamera& camera,
                                       std::span<const Region> regions, const Truth* truth = nullptr);

/// The camera that config describes. Errors: those of SimulatedCamera::create.
[[nodiscard]] Result<SimulatedCamera> simulated_camera(const RayScene& scene, const SimulatedRunConfig& config);

/// A camera that flies, but not into fixtures: its centre stays this far from them.
constexpr double kCameraClearance_m{0.1};
[[nodiscard]] Result<FreeRobot> flying_camera(const RayScene& scene);

/// An arm in the scene, as it stands at the first view of the initial scan, if neither `robot` nor `joints` says
/// anything else. The scene's fixture_boxes are added to its fixtures. Errors: those of fixture_boxes and
/// PlannedArm::create.
/// @param joints  moves the arm; nullptr: it is simulated
[[nodiscard]] Result<PlannedArm> planned_arm(const ArmModel& arm, const Scene& scene, const SimulatedRunConfig& config,
                                             PlannedArmConfig robot = {},
                                             std::shared_ptr<JointController> joints = nullptr);

/// Measures the map and its mesh. Cost: measure() + extract_mesh().
[[nodiscard]] Measures measure_map(const Truth& truth, const TsdfSnapshot& map, const Executor& executor);

/// Holds the map against the truth after the scan and after each view.
class TruthMeter final : public Recorder {
 public:
  TruthMeter(Truth truth, const Executor& executor) : truth_{std::move(truth)}, executor_{executor} {}
  /// The map as it is before the next view; of a run that goes on, where no scan is recorded.
  void begin(const TsdfSnapshot& map) { before_ = map; }
  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override;
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;

 private:
  Truth truth_;
  Executor executor_;
  TsdfSnapshot before_;
};

/// Explores the scene of `truth` with the arm of config, or a flying camera, and measures after every view.
/// @param planner one of your own, in place of the one that config names
/// @return errors of SimulatedRunConfig::validate, Explorer, TsdfMap::create, and with an arm of simulated_arm and
///         CarriedCamera. The same measures for every thread count and on a busy machine; deterministic by seed.
[[nodiscard]] Result<RunRecord> run_simulated(const Truth& truth, const SimulatedRunConfig& config,
                                              ViewPlanner& planner, const Executor& executor,
                                              const Progress& progress = {});
[[nodiscard]] Result<RunRecord> run_simulated(const Truth& truth, const SimulatedRunConfig& config,
                                              const Executor& executor, const Progress& progress = {});

}  // namespace saccade
