// SPDX-License-Identifier: Apache-2.0
#pragma once
// placed: an object of a scene, not turned.

#include <string>
#include <utility>

#include "saccade/scene/scene.hpp"

namespace saccade::test {

inline SceneObject placed(const std::string& name, Shape shape, const Eigen::Vector3d& at) {
  SceneObject object;
  object.name = name;
  object.shape = std::move(shape);
  object.T_world_object.translation() = at;
  return object;
}

}  // namespace saccade::test
