// SPDX-License-Identifier: Apache-2.0
#include "experiments/filtered_frames.hpp"

#include "saccade/sensor/kinect_v2_filter.hpp"
#include "thesis/depth_baselines.hpp"

namespace saccade::reproduce {
namespace {

using thesis::FilterScene;

Result<DepthImage> filtered_by(DepthFilterMethod method, const PinholeCamera& camera, const DepthImage& depth,
                               const Executor& executor) {
  DepthFilterConfig config;
  config.method = method;
  SACCADE_TRY(const DepthFilter filter, DepthFilter::create(camera, config));
  SACCADE_TRY(FilteredDepth filtered, filter.filter(depth, executor));
  return std::move(filtered.depth);
}

/// The frames of each pipeline, in the order of kPipelines.
Result<std::array<std::vector<DepthImage>, kPipelines.size()>> filtered_frames(const FilterScene& scene,
                                                                               const PinholeCamera& camera,
                                                                               std::uint64_t seed,
                                                                               const Executor& executor,
                                                                               const Progress& progress) {
  std::array<std::vector<DepthImage>, kPipelines.size()> frames;
  TimeOfFlightConfig measuring;
  measuring.noise.seed = seed;
  for (int n = 0; n < thesis::kAveragedFrames; ++n) {
    progress.report("filtering", static_cast<std::size_t>(n), thesis::kAveragedFrames);
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "Table 3.4"};
    SACCADE_TRY(TimeOfFlightFrame frame, capture_time_of_flight(scene.scene, camera, measuring, scene.T_world_camera,
                                                                static_cast<std::uint64_t>(n), executor));
    const DepthImage smooth = thesis::bilateral(frame.depth);
    frames[0].push_back(std::move(frame.depth));
    frames[2].push_back(thesis::edge_aware(smooth));
    SACCADE_TRY(DepthImage by_thesis, filtered_by(DepthFilterMethod::thesis, camera, smooth, executor));
    frames[3].push_back(std::move(by_thesis));
    SACCADE_TRY(DepthImage by_surface, filtered_by(DepthFilterMethod::surface, camera, smooth, executor));
    frames[4].push_back(std::move(by_surface));
    frames[1].push_back(smooth);
  }
  return frames;
}

}  // namespace

Status carry_out_filters(const TableOptions& options, const Executor& executor, const Progress& progress,
                         std::optional<FilteredFrames>& frames) {
  if (frames) return {};
  SACCADE_TRY(FilterScene scene, thesis::planar_table());
  SACCADE_TRY(const PinholeCamera camera, camera_preset("kinect-v2"));
  SACCADE_TRY(auto by_pipeline, filtered_frames(scene, camera, options.seed, executor, progress));
  frames.emplace(FilteredFrames{std::move(scene), camera, std::move(by_pipeline)});
  return {};
}

}  // namespace saccade::reproduce
