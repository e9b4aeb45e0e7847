// SPDX-License-Identifier: Apache-2.0
#pragma once
// fixture_boxes: what an arm must keep clear of in a scene whatever it has seen, as boxes.

#include <string>
#include <vector>

#include "saccade/scene/scene.hpp"

namespace saccade {

/// An object that is a fixture or a support.
struct FixtureBox {
  std::string name;
  Box box;
  bool support{false};
};

/// The bounding boxes, along the world's axes, of a scene's fixtures and supports, in the scene's order; what leans is
/// given more room than it takes. Whole micrometres; no side is shorter than a millimetre. Errors: those of
/// true_meshes.
[[nodiscard]] Result<std::vector<FixtureBox>> fixture_boxes(const Scene& scene);

}  // namespace saccade
