// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/rendered_sequence.hpp"

#include "saccade/scene/internal/scene_maker.hpp"

namespace saccade {
namespace {

SurfelScene taken_with(SurfelScene made, std::string_view sensor, Vignetting vignetting, bool automatic_gain) {
  made.sensor = sensor;
  made.color.vignetting = vignetting;
  made.color.automatic_gain = automatic_gain;
  return made;
}

Error unknown(std::string_view what, std::string_view name, std::span<const std::string_view> known) {
  return {Errc::not_found, "no such " + std::string{what} + "; there are " + joined(known), std::string{name}};
}

/// Disparity steps of f·b = 580 px · 75 mm, an eighth of a pixel each.
constexpr double kDisparityStepPerM{348.0};
constexpr double kLateralNoise_px{0.8};

}  // namespace

Result<RenderedSequenceConfig> surfel_sensor(std::string_view name) {
  RenderedSequenceConfig config;
  if (name == "xtion") {
    DepthNoise noise;
    noise.disparity_step_per_m = kDisparityStepPerM;
    config.depth_noise = noise;
    config.lateral_noise_px = kLateralNoise_px;
  } else if (name == "kinect-v2") {
    config.time_of_flight = TimeOfFlightConfig{};
  } else {
    return unknown("sensor", name, kSurfelSensors);
  }
  SACCADE_TRY(config.camera, camera_preset(name));
  return config;
}

Result<SurfelScene> surfel_scene(std::string_view name) {
  // Frames, sensor and correction of scenarios 1 to 5 (Table 4.1, §4.1.3).
  if (name == "workshop-1") {
    const WorkshopPlan plan{2, 6, 0.7, true, {{{196, 160, 112}, {186, 150, 104}}}};
    return taken_with(workshop_scene(name, plan, 1737, 1), "xtion", Vignetting::corrected, false);
  }
  if (name == "workshop-2") {
    const WorkshopPlan plan{4, 8, 1.25, false, {{{172, 182, 176}, {198, 164, 118}}}};
    return taken_with(workshop_scene(name, plan, 1737, 2), "xtion", Vignetting::corrected, false);
  }
  if (name == "desk") return taken_with(desk_scene(name, 2209, 5), "xtion", Vignetting::on, false);
  if (name == "magazines-1") {
    return taken_with(magazine_scene(name, 5, 2, 1831, 3), "kinect-v2", Vignetting::off, true);
  }
  if (name == "magazines-2") {
    return taken_with(magazine_scene(name, 4, 2, 1698, 4), "kinect-v2", Vignetting::off, true);
  }
  return unknown("scene for surfels", name, kSurfelScenes);
}

}  // namespace saccade
