// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "gpu_steps.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/cuda/gpu_tracker.hpp"
#include "saccade/tracking/reconstruction.hpp"
#include "table_map.hpp"

namespace saccade::bench {
namespace {

struct TrackedFrames {
  std::vector<double> track_ms;  ///< ray cast and alignment
  std::vector<double> integrate_ms;
  std::vector<Pose> T_world_camera;
  TsdfSnapshot map;
};

/// Fuses images of a camera that goes around the table, tracked by ICP. @param device  nullptr: the CPU tracks
TrackedFrames track_around_table(const GpuCheck& check, TrackingDevice* device) {
  const Executor executor = Executor::with_threads(0);
  const PinholeCamera camera = PinholeCamera{}.scaled_to_width(check.quick ? 160 : 640);
  Reconstruction reconstruction = need(Reconstruction::create({}));
  reconstruction.track_on(device);
  TrackedFrames frames;
  for (int i = 0; i < (check.quick ? 3 : 40); ++i) {
    const double turn = i * 1.5_deg;
    const Pose T_world_true =
        look_at({0.7 * std::cos(turn), 0.7 * std::sin(turn), 0.6}, {0.0, 0.0, 0.05}, Eigen::Vector3d::UnitZ());
    Frame frame;
    frame.depth = need(render(table(), camera, T_world_true, executor)).depth;
    const FrameReport report = need(reconstruction.process(frame, camera, TrackingMode::icp, T_world_true, executor));
    frames.T_world_camera.push_back(report.T_world_camera);
    if (i == 0) continue;  // it is not tracked
    frames.track_ms.push_back(report.raycast_ms + report.track_ms);
    frames.integrate_ms.push_back(report.integrate_ms);
  }
  frames.map = reconstruction.map().snapshot();
  return frames;
}

}  // namespace

bool check_gpu_tracking(const GpuCheck& check) {
  GpuTracker gpu =
      need(check.emulated ? GpuTracker::create_emulated({}, Executor::with_threads(0)) : GpuTracker::create({}));
  const TrackedFrames expected = track_around_table(check, nullptr);
  const TrackedFrames tracked = track_around_table(check, &gpu);
  std::size_t different{0};
  for (std::size_t i = 0; i < tracked.T_world_camera.size(); ++i) {
    different += tracked.T_world_camera[i].matrix() == expected.T_world_camera[i].matrix() ? 0 : 1;
  }
  const bool equal = different == 0 && tracked.map.grid == expected.map.grid && !gpu.take_problem();
  std::printf(
      " \"tracking\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"integrate_beside_gpu_ms\": %.3f, \"integrate_ms\": %.3f, "
      "\"frames\": %zu, \"answered\": %zu, \"different\": %zu, \"equal\": %s},\n",
      median(tracked.track_ms), median(expected.track_ms), median(tracked.integrate_ms), median(expected.integrate_ms),
      tracked.T_world_camera.size(), gpu.answered(), different, text_of(equal));
  return equal;
}

}  // namespace saccade::bench
