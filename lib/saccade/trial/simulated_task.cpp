// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/simulated_task.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "saccade/core/seeded_random.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

Error bad(std::string what) { return Error{Errc::invalid_argument, std::move(what), "simulated task"}; }

const ObjectMesh* find(const std::vector<ObjectMesh>& meshes, const std::string& name) {
  const auto found = std::find_if(meshes.begin(), meshes.end(), [&](const ObjectMesh& m) { return m.name == name; });
  return found == meshes.end() ? nullptr : &*found;
}

bool same_surface(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

bool is_known(const Scene& scene, const std::string& name) {
  const auto found =
      std::find_if(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& o) { return o.name == name; });
  return found != scene.objects.end() && (found->support || found->fixture);
}

/// Returns the sensor's position while the object is held there.
Vector3d held_at(const Box& object, const Vector3d& user_m, const SimulatedHandConfig& config) {
  Vector3d grip = 0.5 * (object.min + object.max);
  grip.z() = object.min.z() + config.grip_share * (object.max.z() - object.min.z());
  Vector3d towards_user = user_m - grip;
  towards_user.z() = 0.0;
  const double half_m = 0.5 * config.wrist_m;
  const Vector3d beside = towards_user.norm() > 0.0 ? towards_user.normalized() : Vector3d{Vector3d::Zero()};
  return grip + half_m * Vector3d::UnitZ() + std::sqrt(3.0) * half_m * beside;
}

/// Returns the box that the sensor must stay above, so that neither the hand nor its load comes near the object.
Box to_pass_over(const Box& object, const Vector3d& carried_m, const SimulatedHandConfig& config) {
  const double half_m = 0.5 * std::max(carried_m.x(), carried_m.y());
  const double below_m = config.grip_share * carried_m.z() + 0.5 * config.wrist_m + config.clearance_m;
  return {object.min - Vector3d{half_m, half_m, 0.0}, object.max + Vector3d{half_m, half_m, below_m}};
}

}  // namespace

Result<std::vector<SceneChange>> scene_changes(const Scene& before, const Scene& after) {
  if (before.workspace.min != after.workspace.min || before.workspace.max != after.workspace.max) {
    return bad("the scenes \"" + before.name + "\" and \"" + after.name + "\" have different workspaces");
  }
  SACCADE_TRY(const std::vector<ObjectMesh> were, true_meshes(before));
  Scene as_fine = after;
  as_fine.max_deviation_m = before.max_deviation_m;
  SACCADE_TRY(const std::vector<ObjectMesh> are, true_meshes(as_fine));
  std::vector<SceneChange> changes;
  for (const ObjectMesh& was : were) {
    if (find(are, was.name) == nullptr) changes.push_back({was.name, bounds_of(was.mesh), {}});
  }
  for (const ObjectMesh& is : are) {
    const ObjectMesh* was = find(were, is.name);
    if (was != nullptr && same_surface(was->mesh, is.mesh)) continue;
    changes.push_back(
        {is.name, was != nullptr ? std::optional{bounds_of(was->mesh)} : std::nullopt, bounds_of(is.mesh)});
  }
  for (const SceneChange& change : changes) {
    if (!is_known(before, change.object) && !is_known(after, change.object)) continue;
    return bad("\"" + change.object + "\", a support or fixture, is not the same in the scenes \"" + before.name +
               "\" and \"" + after.name + "\"");
  }
  return changes;
}

Status SimulatedHandConfig::validate() const {
  for (const double value : {motion.rate_hz, motion.speed_m_s, motion.action_s}) {
    if (!(std::isfinite(value) && value > 0.0)) return bad("rate, speed and time of a hand must be positive");
  }
  for (const double value : {motion.noise_m, motion.sway_m, wrist_m, clearance_m}) {
    if (!(std::isfinite(value) && value >= 0.0)) return bad("noise and lengths of a hand must not be negative");
  }
  for (const double share : {motion.repeat_share, grip_share}) {
    if (!(share >= 0.0 && share <= 1.0)) return bad("a share lies within 0 and 1");
  }
  if (!user_m.allFinite()) return bad("the place of the user is not finite");
  return {};
}

Result<SimulatedHand> simulated_hand(const Scene& before, const std::vector<SceneChange>& changes, std::uint64_t seed,
                                     const SimulatedHandConfig& config) {
  SACCADE_CHECK(config.validate());
  if (changes.empty()) return bad("nothing changes in the scene \"" + before.name + "\"");
  constexpr double kBeside_m{0.2};
  SeededRandom random{seed};
  SyntheticHandPath way;
  way.outside_m = config.user_m + kBeside_m * Vector3d{random.uniform(-1.0, 1.0), 0.0, random.uniform(-0.5, 0.5)};
  SimulatedHand hand;
  Vector3d largest_m = Vector3d::Zero();
  for (const SceneChange& change : changes) {
    for (const bool picked_up : {true, false}) {
      const std::optional<Box>& object = picked_up ? change.was : change.is;
      if (!object) continue;
      hand.places.push_back({change.object, picked_up, held_at(*object, way.outside_m, config)});
      way.places_m.push_back(hand.places.back().position_m);
      largest_m = largest_m.cwiseMax(object->max - object->min);
    }
  }
  SACCADE_TRY(const std::vector<ObjectMesh> meshes, true_meshes(before));
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto is_it = [&](const SceneChange& change) { return change.object == meshes[i].name; };
    const bool stays = std::none_of(changes.begin(), changes.end(), is_it);
    if (!stays || before.objects[i].support || before.objects[i].fixture) continue;
    way.obstacles.push_back(to_pass_over(bounds_of(meshes[i].mesh), largest_m, config));
  }
  hand.trajectory = synthetic_task(way, seed, config.motion).trajectory;
  return hand;
}

}  // namespace saccade
