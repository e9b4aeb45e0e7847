// SPDX-License-Identifier: Apache-2.0
#include "rehearsal.hpp"

#include <algorithm>
#include <utility>

#include "saccade/scene/simulated_camera.hpp"

namespace saccade::cli {
namespace {

SceneObject object_of(const Box& box, std::size_t number) {
  SceneObject object;
  object.name = "fixture-" + std::to_string(number);
  object.shape = BoxShape{box.max - box.min};
  object.T_world_object.translation() = 0.5 * (box.min + box.max);
  object.T_world_object.translation().z() = box.min.z();  // a shape stands on its own plane z = 0
  object.support = object.fixture = true;
  return object;
}

}  // namespace

Result<std::unique_ptr<Camera>> rehearsal_camera(std::unique_ptr<Camera> camera, const Scene& scene,
                                                 std::span<const Box> fixtures,
                                                 const std::optional<Pose>& T_world_standing) {
  Scene known = scene;
  std::erase_if(known.objects, [](const SceneObject& object) { return !object.support && !object.fixture; });
  for (const Box& box : fixtures) known.objects.push_back(object_of(box, known.objects.size() + 1));
  const PinholeCamera intrinsics = camera->intrinsics();
  std::shared_ptr<SimulatedCamera> imagined;
  if (!known.objects.empty()) {
    SACCADE_TRY(RayScene rays, RayScene::build(known));
    SimulatedCameraConfig config;
    config.camera = intrinsics;
    SACCADE_TRY(SimulatedCamera simulated, SimulatedCamera::create(std::move(rays), config));
    imagined = std::make_shared<SimulatedCamera>(std::move(simulated));
  }
  const std::shared_ptr<Camera> real{std::move(camera)};
  const auto capture = [real, imagined, intrinsics, T_world_standing](const Pose& T_world_camera) -> Result<Frame> {
    constexpr double kSame{1e-6};
    if (T_world_standing && T_world_camera.isApprox(*T_world_standing, kSame)) return real->capture(T_world_camera);
    if (imagined) return imagined->capture(T_world_camera);
    return FunctionCamera{intrinsics}.capture(T_world_camera);
  };
  return std::unique_ptr<Camera>{std::make_unique<FunctionCamera>(intrinsics, capture)};
}

}  // namespace saccade::cli
