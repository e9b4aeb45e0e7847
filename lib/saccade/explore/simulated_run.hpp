// SPDX-License-Identifier: Apache-2.0
#pragma once
// SimulatedRun: one exploration of a scene whose truth is known, measured view by view.

#include <memory>

#include "saccade/explore/carried_camera.hpp"
#include "saccade/explore/metrics.hpp"
#include "saccade/explore/object_attention.hpp"
#include "saccade/explore/strategy_kind.hpp"
#include "saccade/robot/arm_robot.hpp"
#include "saccade/scene/simulated_camera.hpp"

namespace saccade {

/// What a simulated camera's depth is like.
enum class DepthSensor : std::uint8_t {
  kinect_v1,  ///< kinect_v1_noise
  kinect_v2,  ///< TimeOfFlightConfig, and its frames through a DepthFilter
};
[[nodiscard]] std::string_view to_string(DepthSensor sensor);
/// invalid_argument, with the known names, for any other.
[[nodiscard]] Result<DepthSensor> depth_sensor(std::string_view name);

struct SimulatedRunConfig {
  double voxel_size_m{0.0058};
  double truncation_vox{2.0};          ///< thin: within 2 m depth is better than that, and vessels have thin walls
  std::uint8_t clearing_percent{100};  ///< of its maps
  PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 2.0};  ///< beyond 2 m depth is too coarse here
  bool noise{true};                                                      ///< of `sensor`; else depth is exact
  DepthSensor sensor{DepthSensor::kinect_v1};
  StrategyKind strategy{StrategyKind::attention};
  ViewSphereConfig sphere;          ///< of strategies that look at regions
  ObjectAttentionConfig attention;  ///< its contours are those of all others
  ContourViewConfig contour_views;
  int gain_width_px{
      160};  ///< width of the virtual sensor that views are chosen with; its field of view is the camera's
  ExplorationConfig exploration{.min_gain = min_gain_of(StrategyKind::attention)};
  std::uint64_t seed{1};                  ///< of noise and chance
  std::shared_ptr<const ArmModel> arm{};  ///< carries the camera in run_simulated; null: it flies
  /// Of that arm; its planner takes `seed` for its own, and all the time that max_motions take.
  ArmRobotConfig arm_robot{};

  [[nodiscard]] Status validate() const;
  /// As it is for a strategy, exploration.min_gain included.
  [[nodiscard]] SimulatedRunConfig with(StrategyKind kind) const;
  /// Of the map, but for the workspace, which is the scene's.
  [[nodiscard]] TsdfConfig map() const;
};

/// Where to look: the regions of the scene, if it has some and the strategy heeds them, or its whole workspace; never
/// the true objects.
[[nodiscard]] std::vector<Region> regions_of(const Scene& scene, StrategyKind strategy);

/// The strategy that config names, for a camera and so many regions (one at least).
/// @param truth  what StrategyKind::oracle knows, which expects it; others do not look at it.
[[nodiscard]] std::unique_ptr<Strategy> make_strategy(const SimulatedRunConfig& config, const PinholeCamera& camera,
                                                      std::size_t regions, const Truth* truth = nullptr);

/// The camera that config describes. Errors: those of SimulatedCamera::create.
[[nodiscard]] Result<SimulatedCamera> simulated_camera(const RayScene& scene, const SimulatedRunConfig& config);

/// A camera that flies, but not into fixtures: its centre stays this far from them.
constexpr double kCameraClearance_m{0.1};
[[nodiscard]] Result<FreeRobot> flying_camera(const RayScene& scene);

/// An arm in the scene, as it stands at the first view of the initial scan, if `robot` says nothing else. The scene's
/// fixture_boxes are added to its fixtures. Errors: those of fixture_boxes and SimulatedRobot::create.
[[nodiscard]] Result<SimulatedRobot> simulated_arm(const ArmModel& arm, const Scene& scene,
                                                   const SimulatedRunConfig& config, ArmRobotConfig robot = {});

/// A map as it is after some views, held against the truth.
struct MeasuredMap {
  Metrics metrics;
  std::size_t unknown_left{0};  ///< voxels of the workspace
};

/// Measures the map and its mesh. Cost: measure() + extract_mesh().
[[nodiscard]] MeasuredMap measure_map(const Truth& truth, const TsdfSnapshot& map, const Executor& executor);

struct MeasuredView {
  ExploredView view;
  MeasuredMap after;
  NewlyKnown newly_known;
  bool looks_at_object{false};
};

struct SimulatedRun {
  ScanResult scan;
  MeasuredMap initial;  ///< after the initial scan
  std::vector<MeasuredView> views;
  StopReason stopped_because{StopReason::regions_done};
  RefusalCounts refused_at_end{};  ///< ExplorationResult::refused_at_end

  [[nodiscard]] const MeasuredMap& final() const { return views.empty() ? initial : views.back().after; }
};

/// Explores the scene of `truth` with the arm of config, or a flying camera, and measures after every view.
/// @param strategy one of your own, in place of the one that config names
/// @return errors of SimulatedRunConfig::validate, explore, TsdfMap::create, and with an arm of simulated_arm and
///         CarriedCamera. The same figures for every thread count and on a busy machine; deterministic by seed.
[[nodiscard]] Result<SimulatedRun> run_simulated(const Truth& truth, const SimulatedRunConfig& config,
                                                 const Strategy& strategy, const Executor& executor,
                                                 const Progress& progress = {});
[[nodiscard]] Result<SimulatedRun> run_simulated(const Truth& truth, const SimulatedRunConfig& config,
                                                 const Executor& executor, const Progress& progress = {});

}  // namespace saccade
