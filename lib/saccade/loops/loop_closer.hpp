// SPDX-License-Identifier: Apache-2.0
#pragma once
// LoopCloser: recognises places that a tracked camera comes back to, and corrects its trajectory.

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/loops/pose_graph.hpp"
#include "saccade/loops/refusion.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/tracking/place_index.hpp"

namespace saccade {

/// How far tracking may be off after a way. The length of a way counts a turn by one radian as a metre.
struct DriftModel {
  double translation_share{0.01};    ///< standard deviation per axis, metres per metre of the way
  double rotation_rad_per_m{0.004};  ///< standard deviation per axis
  double floor_m{0.01};              ///< standard deviation of a way of no length
  double floor_rad{0.3_deg};

  /// Returns the length of the way of a relative pose.
  [[nodiscard]] static double travel_m(const Pose& T_from_to) {
    return T_from_to.translation().norm() + rotation_angle_rad(T_from_to);
  }
  /// Returns by how many standard deviations a pose is off another one after a way, the farther of turn and shift.
  [[nodiscard]] double sigmas(const Pose& T_predicted, const Pose& T_found, double travel_m) const;
};

struct LoopConfig {
  double keyframe_distance_m{0.15};   ///< a keyframe is taken after this motion,
  double keyframe_turn_rad{8.0_deg};  ///< or this turn
  double min_travel_m{3.0};           ///< the way between two keyframes that may close a loop
  PlaceIndexConfig places;
  std::size_t max_candidates{3};   ///< per keyframe, the most alike first
  double max_dissimilarity{0.75};  ///< candidates are more alike
  int model_frames{5};             ///< before and after a keyframe, fused to see the surface around it with less noise
  double min_agreement{0.92};      ///< share of the new surface at the old one's depth (IcpResult::agreement)
  double min_inlier_share{0.45};   ///< share of the new surface with a partner
  double max_rmse_m{0.012};        ///< root mean square of the distances between partners
  double min_constraint{1e-4};     ///< as IcpConfig::min_constraint
  double max_sigmas{3.0};          ///< by which closures may differ from the drift model
  std::size_t confirm_within{3};   ///< keyframes, among which a second closure says the same
  double confirm_m{0.02};          ///< largest difference of two that say the same
  double confirm_rad{0.6_deg};
  DriftModel drift;
  PoseGraphConfig graph;

  [[nodiscard]] Status validate() const;
};

struct LoopCounts {
  std::size_t keyframes{0};
  std::size_t candidates{0};            ///< pairs of keyframes that look alike and are not near each other on the way
  std::size_t rejected_by_surface{0};   ///< ICP found no pose that is good enough
  std::size_t rejected_by_odometry{0};  ///< farther from the tracked pose than it may drift
  std::size_t rejected_alone{0};        ///< contradicted, or not said a second time
  std::size_t dropped{0};               ///< left out by the pose graph
  std::size_t closed{0};                ///< closures in the pose graph
};

/// A loop: keyframe `to` sees what keyframe `from` saw.
struct Closure {
  std::size_t from{0};
  std::size_t to{0};
  Pose T_from_to{Pose::Identity()};
};

/// Closes loops of one trajectory, keyframe by keyframe. Candidates are the most alike places (PlaceIndex). Each is
/// verified by ICP of the new depth image against the surface around the old keyframe, fused of a few frames there; by
/// the drift model; and by another closure nearby that says the same. Then all keyframes are moved by the pose graph.
/// Places that look alike in every respect are told apart by the drift model alone: they must be farther apart than
/// tracking may be off. One caller at a time. Neither threads nor time change a bit of the result.
class LoopCloser {
 public:
  /// @param camera of the frames. @param map of which maps of surroundings are made. @param read is called for
  /// keyframes and for frames near an old keyframe.
  /// Errors: unavailable without a solver for pose graphs (pose_graph_solver()); invalid_argument.
  [[nodiscard]] static Result<LoopCloser> create(const PinholeCamera& camera, const TsdfConfig& map, ReadFrame read,
                                                 const LoopConfig& config = {});
  LoopCloser(LoopCloser&&) noexcept;
  LoopCloser& operator=(LoopCloser&&) noexcept;
  ~LoopCloser();

  /// Goes on with the next frame of the trajectory, at its tracked pose, without any correction.
  /// @return whether poses() changed for frames before it. Errors: those of reading and of ray casting.
  [[nodiscard]] Result<bool> add(const TrackedFrame& frame, const Executor& executor);
  /// Takes the last frame as a keyframe, if it is none yet. @return as add().
  [[nodiscard]] Result<bool> finish(const Executor& executor);

  /// Returns the corrected pose of every frame: keyframes as the pose graph has them, others carried along.
  [[nodiscard]] std::vector<Pose> poses() const;
  [[nodiscard]] std::size_t frames() const;
  [[nodiscard]] const LoopCounts& counts() const;
  /// Returns the closures in the pose graph, in frames of the trajectory.
  [[nodiscard]] std::vector<Closure> closures() const;

 private:
  struct State;
  explicit LoopCloser(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace saccade
