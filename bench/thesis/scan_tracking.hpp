// SPDX-License-Identifier: Apache-2.0
#pragma once
// track_scan: one scan of a table, fused with poses tracked by ICP and with those that the arm reports (thesis §2.4.1).

#include <string>
#include <vector>

#include "saccade/core/progress.hpp"
#include "saccade/trial/metrics.hpp"

namespace saccade::thesis {

struct ScanTrackingConfig {
  double pace{0.5};  ///< share of the arm's speed
  /// Hand-eye calibration is not exact: the camera sits in the arm's hand as far off and turned as much as this.
  double calibration_m{0.001};
  double calibration_rad{0.0017453292519943296};  ///< 0.1°
  std::size_t frames{0};                          ///< frames from the motion's beginning; 0: all
  std::uint64_t seed{1};
};

/// Results of one source of the camera's pose.
struct ScanTracking {
  bool egomotion{false};    ///< by ICP; else by the arm
  double depth_scale{1.0};  ///< measured / true depth, but for noise
  /// For each frame, against the camera's true motion since the first.
  std::vector<double> translation_m;
  std::vector<double> rotation_rad;
  std::size_t lost{0};              ///< frames that ICP could not place; they are not fused
  std::vector<ObjectShape> errors;  ///< errors of the objects that could be measured
  std::size_t unmeasured{0};        ///< objects
};

/// Carries the simulated camera (Kinect noise) along scan_motion in a built-in scene, once, and fuses what it sees four
/// times: by egomotion and by the arm's poses, with true depth and with depth that is measured 1 % too long. Egomotion
/// begins at the first pose that the arm reports.
/// @return errors of find_scene, find_robot and scan_motion; cancelled. O(frames); a tenth of a second each.
[[nodiscard]] Result<std::vector<ScanTracking>> track_scan(const std::string& scene, const ScanTrackingConfig& config,
                                                           const Executor& executor, const Progress& progress);

}  // namespace saccade::thesis
