// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/planned_arm.hpp"

#include <algorithm>
#include <utility>

#include "saccade/arm/arm_silhouette.hpp"
#include "saccade/arm/internal/executed_path.hpp"
#include "saccade/arm/internal/swept_cells.hpp"
#include "saccade/arm/motion_planner.hpp"

namespace saccade {
namespace {

/// Returns the nearest configuration. Expects at least one.
const Configuration& nearest(const ArmModel& arm, const Configuration& from, const std::vector<Configuration>& to) {
  return *std::min_element(to.begin(), to.end(), [&](const Configuration& a, const Configuration& b) {
    return rest_to_rest_s(arm, from, a) < rest_to_rest_s(arm, from, b);
  });
}

/// Keeps the configurations of one pose that are nearest in seconds. A pose with a free value has hundreds, samples of
/// a continuum, and a planner tries the straight motion to each.
void keep_nearest(const ArmModel& arm, const Configuration& from, std::vector<Configuration>& of_pose) {
  constexpr std::size_t kMost{32};
  if (of_pose.size() <= kMost) return;
  std::vector<std::pair<double, std::size_t>> times_s;
  for (std::size_t i = 0; i < of_pose.size(); ++i) times_s.emplace_back(rest_to_rest_s(arm, from, of_pose[i]), i);
  std::sort(times_s.begin(), times_s.end());
  std::vector<Configuration> kept;
  for (std::size_t i = 0; i < kMost; ++i) kept.push_back(of_pose[times_s[i].second]);
  of_pose = std::move(kept);
}

/// Returns the start configuration that config selects, regardless of collisions.
Configuration choose_start(const PlannedArmConfig& config, const Reachability& reachability,
                           const ObstacleMap& fixtures) {
  if (config.start) return *config.start;
  const Configuration& middle = reachability.arm().middle();
  for (const Pose& pose : config.first_poses) {
    const std::vector<Configuration> free = reachability.goals(pose, middle, fixtures).free;
    if (!free.empty()) return nearest(reachability.arm(), middle, free);
  }
  return middle;
}

Status check_configuration(const ArmModel& arm, const Configuration& q) {
  const auto fail = [&](const std::string& what) { return Error{Errc::invalid_argument, what, arm.name()}; };
  if (q.size() != arm.dof()) {
    return fail("the configuration has " + std::to_string(q.size()) + " values, the arm " + std::to_string(arm.dof()) +
                " joints");
  }
  if (!q.allFinite() || !arm.within_limits(q)) return fail("the configuration is outside the joints' limits");
  return {};
}

}  // namespace

Status PlannedArmConfig::validate() const {
  SACCADE_CHECK(collision.validate());
  SACCADE_CHECK(planner.validate());
  return obstacles.validate();
}

Result<PlannedArm> PlannedArm::create(const ArmModel& arm, const TsdfConfig& map, PlannedArmConfig config,
                                      std::shared_ptr<JointController> joints) {
  if (joints && !config.start) {
    SACCADE_TRY(config.start, joints->position());
  }
  SACCADE_TRY(Parts parts, make_parts(arm, map, config));
  if (!joints) joints = std::make_shared<SimulatedJoints>(parts.start);
  return PlannedArm{std::move(parts), std::move(joints)};
}

Result<PlannedArm::Parts> PlannedArm::make_parts(const ArmModel& arm, const TsdfConfig& map,
                                                 const PlannedArmConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(const ArmCollision collision, ArmCollision::create(arm, config.collision));
  SACCADE_TRY(Reachability reachability, Reachability::create(collision, config.ik));
  SACCADE_TRY(MotionPlanner planner, MotionPlanner::create(collision, config.planner));
  SACCADE_TRY(const TsdfMap unseen, TsdfMap::create(map));
  SACCADE_TRY(ObstacleMap obstacles, ObstacleMap::create(unseen.snapshot(), config.obstacles, Executor{}));
  ObstacleConfig fixtures_alone = config.obstacles;
  fixtures_alone.unknown_is_obstacle = false;
  SACCADE_TRY(ObstacleMap fixtures, ObstacleMap::create(unseen.snapshot(), fixtures_alone, Executor{}));
  const Configuration start = choose_start(config, reachability, fixtures);
  SACCADE_CHECK(check_configuration(arm, start));
  if (const auto contact = collision.contact(start, fixtures)) {
    return Error{Errc::invalid_argument, "the arm cannot begin as it stands: " + describe(arm, *contact), arm.name()};
  }
  return Parts{std::move(reachability), std::move(planner), std::move(fixtures), std::move(obstacles), start};
}

PlannedArm::PlannedArm(Parts parts, std::shared_ptr<JointController> joints)
    : reachability_{std::move(parts.reachability)},
      planner_{std::move(parts.planner)},
      joints_{std::move(joints)},
      fixtures_{std::move(parts.fixtures)},
      obstacles_{std::move(parts.obstacles)},
      stand_by_{parts.start},
      q_{parts.start},
      way_{ExecutedPath{}} {}

Status PlannedArm::place(const Configuration& q) {
  SACCADE_CHECK(check_configuration(arm(), q));
  way_->clear();
  q_ = q;
  retreat_.reset();
  return {};
}

Status PlannedArm::follow(const TsdfSnapshot& map, const Executor& executor) {
  SACCADE_TRY([[maybe_unused]] const ObstacleUpdate update, obstacles_.update(map, executor));
  const ArmCollision& collision = reachability_.collision();
  retreat_.reset();
  if (collision.contact(q_, obstacles_)) retreat_ = way_->retreat_from(q_, collision, obstacles_);
  return {};
}

Result<std::vector<Box>> PlannedArm::swept_volume(std::span<const Pose> T_world_camera) {
  SweptCells cells{reachability_.collision(), obstacles_};
  Configuration at = q_;
  cells.add(at);
  for (const Pose& pose : T_world_camera) {
    SACCADE_TRY(const PlannedMotion planned, plan_among(std::span{&pose, 1}, MotionKind::planned, at, fixtures_));
    if (!planned.motion) continue;
    cells.add(planned.motion->trajectory);
    at = planned.motion->trajectory.end();
  }
  return cells.boxes();
}

std::vector<std::optional<Refusal>> PlannedArm::test(std::span<const Pose> T_world_camera,
                                                     const Executor& executor) const {
  return reachability_.test(T_world_camera, q_, obstacles_, executor);
}

Result<OwnBody> PlannedArm::own_body(const PinholeCamera& sensor) const {
  SACCADE_TRY(ArmSilhouette silhouette, ArmSilhouette::create(arm(), sensor));
  return OwnBody{[this, silhouette = std::move(silhouette)](const Pose& T_world_camera) -> std::optional<DepthImage> {
    const std::vector<Configuration> free = reachability_.goals(T_world_camera, q_, obstacles_).free;
    if (free.empty()) return std::nullopt;
    const Configuration& q = nearest(arm(), q_, free);
    if (!silhouette.in_picture(q)) return std::nullopt;
    return silhouette.depth(q);
  }};
}

Result<PlannedMotion> PlannedArm::plan(std::span<const Pose> T_world_camera, MotionKind way) {
  if (way == MotionKind::direct) return plan_among(T_world_camera, way, q_, obstacles_);
  SACCADE_TRY(PlannedMotion planned, plan_among(T_world_camera, way, planned_from(), obstacles_));
  if (planned.motion) begin_with_retreat(*planned.motion);
  return planned;
}

std::vector<MotionSample> PlannedArm::camera_on_way(const Motion& motion, double every_s) const {
  SACCADE_EXPECTS(every_s > 0.0);
  std::vector<MotionSample> samples;
  for (double t_s = every_s; t_s < motion.trajectory.duration_s(); t_s += every_s) {
    samples.push_back({t_s, camera_pose(arm(), motion.trajectory.at(t_s).q)});
  }
  return samples;
}

bool PlannedArm::still_free(const Motion& motion, double t_s) const {
  const double end_s = motion.trajectory.duration_s();
  double from_s = std::max(t_s, motion.retreat_s);
  while (from_s < end_s) {
    const double to_s = std::min(from_s + kLookAhead_s, end_s);
    if (reachability_.collision().motion_contact(motion.trajectory.at(from_s).q, motion.trajectory.at(to_s).q,
                                                 obstacles_)) {
      return false;
    }
    from_s = to_s;
  }
  return true;
}

Result<PlannedMotion> PlannedArm::plan_to_stand_by() {
  SACCADE_TRY(PlanOutcome outcome, planner_.plan(planned_from(), std::span{&stand_by_, 1}, obstacles_));
  if (!outcome.plan) return PlannedMotion{std::nullopt, outcome.refusal, std::move(outcome.why)};
  Motion motion{0, camera_pose(arm(), stand_by_), std::move(outcome.plan->trajectory)};
  begin_with_retreat(motion);
  return PlannedMotion{std::move(motion), std::nullopt, ""};
}

void PlannedArm::begin_with_retreat(Motion& motion) const {
  if (!retreat_) return;
  std::vector<Trajectory::Piece> pieces = retreat_->pieces();
  const std::vector<Trajectory::Piece>& onwards = motion.trajectory.pieces();
  pieces.insert(pieces.end(), onwards.begin(), onwards.end());
  motion.trajectory = Trajectory{std::move(pieces)};
  motion.retreat_s = retreat_->duration_s();
}

Result<PlannedMotion> PlannedArm::plan_among(std::span<const Pose> T_world_camera, MotionKind way,
                                             const Configuration& from, const ObstacleMap& obstacles) const {
  SACCADE_EXPECTS(!T_world_camera.empty());
  std::vector<Configuration> goals;
  std::vector<std::size_t> pose_of;
  std::optional<Refusal> refusal;
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    PoseGoals at_pose = reachability_.goals(T_world_camera[i], from, obstacles);
    // Keeps, among several poses, the reason of the one that passed the most tests.
    if (at_pose.refusal && (!refusal || *at_pose.refusal > *refusal)) refusal = at_pose.refusal;
    if (reachability_.ik().redundancy() != IkRedundancy::none) keep_nearest(arm(), from, at_pose.free);
    pose_of.insert(pose_of.end(), at_pose.free.size(), i);
    std::move(at_pose.free.begin(), at_pose.free.end(), std::back_inserter(goals));
  }
  if (goals.empty()) return PlannedMotion{std::nullopt, refusal, ""};
  SACCADE_TRY(PlanOutcome outcome, way == MotionKind::direct ? planner_.plan_straight(from, goals, obstacles)
                                                             : planner_.plan(from, goals, obstacles));
  if (!outcome.plan) return PlannedMotion{std::nullopt, outcome.refusal, std::move(outcome.why)};
  const std::size_t pose = pose_of[outcome.plan->goal];
  return PlannedMotion{Motion{pose, T_world_camera[pose], std::move(outcome.plan->trajectory)}, std::nullopt, ""};
}

Status PlannedArm::check_start(const Motion& motion) const {
  constexpr double kSame{1e-6};
  if (!motion.trajectory.empty() && (motion.trajectory.at(0.0).q - q_).lpNorm<Eigen::Infinity>() <= kSame) return {};
  return Error{Errc::invalid_argument, "the motion does not begin where the arm stands", arm().name()};
}

Result<std::optional<Arrival>> PlannedArm::execute(const Motion& motion, const MotionObserver& on_way) {
  SACCADE_CHECK(check_start(motion));
  JointPath driven{q_};
  const JointObserver observer = [&](const JointSample& sample) {
    q_ = sample.q;
    driven.push_back(q_);
    return on_way ? on_way({sample.t_s, T_world_camera(), sample.time_s}) : Advance::go_on;
  };
  SACCADE_TRY(const JointArrival arrival, joints_->execute(motion.trajectory, observer));
  q_ = arrival.q;
  driven.push_back(q_);
  motions_.push_back(arrival.stopped ? parametrise(arm(), driven) : motion.trajectory);
  way_->add(motions_.back());
  retreat_.reset();
  return std::optional{Arrival{T_world_camera(), motions_.back().duration_s(), arrival.stopped}};
}

}  // namespace saccade
