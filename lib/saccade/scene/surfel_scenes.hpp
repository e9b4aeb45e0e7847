// SPDX-License-Identifier: Apache-2.0
#pragma once
// surfel_scene: scenes with small painted parts, made after the five of the thesis (§4.1.3, Fig. 4.4), with a path.

#include <array>
#include <string_view>

#include "saccade/scene/rendered_sequence.hpp"

namespace saccade {

constexpr std::array<std::string_view, 5> kSurfelScenes{"workshop-1", "workshop-2", "desk", "magazines-1",
                                                        "magazines-2"};

struct SurfelScene {
  Scene scene;
  HandHeldPath path;
  std::size_t frames{0};    ///< as many as the thesis' scene has (Table 4.1)
  std::string_view sensor;  ///< that the thesis used
  ColorCameraConfig color;  ///< what its colour camera does, and what was corrected
};

constexpr std::array<std::string_view, 2> kSurfelSensors{"xtion", "kinect-v2"};
/// The camera of the preset, and the noise of its depth and colour and of poses; docs/surfel-scenes.md says from where
/// the figures are. not_found with the known names.
[[nodiscard]] Result<RenderedSequenceConfig> surfel_sensor(std::string_view name);

/// not_found with the known names.
[[nodiscard]] Result<SurfelScene> surfel_scene(std::string_view name);

}  // namespace saccade
