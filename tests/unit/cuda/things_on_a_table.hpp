// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scene in which cameras are aligned and tracked.

#include "saccade/sensor/analytic_scene.hpp"

namespace saccade::test {

inline AnalyticScene things_on_a_table() {
  AnalyticScene scene;
  scene.objects = {{"table", HalfSpace{}},
                   {"box", Box{{-0.2, -0.1, 0.0}, {-0.05, 0.08, 0.15}}},
                   {"ball", Sphere{{0.12, 0.05, 0.07}, 0.07}},
                   {"can", Cylinder{{0.05, -0.18, 0.0}, {0.05, -0.18, 0.12}, 0.04}}};
  return scene;
}

}  // namespace saccade::test
