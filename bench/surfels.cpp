// SPDX-License-Identifier: Apache-2.0
// Frames of the 7-Scenes kitchen into surfels, with the mode filter and without: the median of a frame's milliseconds,
// of each phase, and bytes per surfel.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <optional>
#include <vector>

#include "saccade/core/statistics.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kFrames{200};

struct Frames {
  PinholeCamera camera;
  std::vector<Frame> all;
};

std::optional<Frames> recorded(const std::filesystem::path& folder) {
  RgbdFolderConfig config;
  config.count = kFrames;
  const auto source = open_rgbd_folder(folder, config);
  if (!source) return std::nullopt;
  Frames frames{(*source)->camera(), {}};
  while (true) {
    auto frame = (*source)->next();
    if (!frame) return std::nullopt;
    if (!frame->has_value()) return frames;
    frames.all.push_back(*std::move(*frame));
  }
}

/// Recorded ones where they are there, else of the sample table, which have no noise.
const Frames& frames() {
  static const Frames made = [] {
    const char* data = std::getenv("SACCADE_DATA");
    const std::filesystem::path folder =
        std::filesystem::path{data != nullptr ? data : "../shared/data"} / "rgbd_redkitchen";
    if (auto read = recorded(folder)) return *std::move(read);
    std::fprintf(stderr, "%s: no frames there, the sample scene is used\n", folder.c_str());
    Frames rendered{camera_preset("kinect-v1").value(), {}};
    for (const Pose& T_world_camera : sample_trajectory(static_cast<int>(kFrames))) {
      RenderedFrame seen = render(sample_tabletop(), rendered.camera, T_world_camera).value();
      Frame& frame = rendered.all.emplace_back();
      frame.depth = std::move(seen.depth);
      frame.color = std::move(seen.color);
      frame.T_world_camera = T_world_camera;
    }
    return rendered;
  }();
  return made;
}

/// One repetition is a whole sequence, and its time that of the median frame.
void fuse_frames(benchmark::State& state, bool filtered) {
  constexpr std::array kPhases{"points", "index", "associate", "integrate", "modes", "guided_filter", "move"};
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  const auto count = std::min(frames().all.size(), static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    SurfelFusion fusion = SurfelFusion::create().value();
    ModeFilter filter = ModeFilter::create().value();
    std::vector<double> totals_ms;
    std::array<std::vector<double>, kPhases.size()> phases_ms;
    for (std::size_t i = 0; i < count; ++i) {
      const Frame& frame = frames().all[i];
      const auto fused = fusion.add_frame(frame, frames().camera, executor);
      if (!fused) return state.SkipWithError(fused.error().to_string().c_str());
      ModeFilterReport modes;
      if (filtered) modes = filter.add_frame(frame, fusion.association(), executor).value();
      const std::array ms{fused->points_ms,   fused->index_ms,        fused->associate_ms, fused->integrate_ms,
                          modes.integrate_ms, modes.guided_filter_ms, modes.move_ms};
      totals_ms.push_back(std::accumulate(ms.begin(), ms.end(), 0.0));
      for (std::size_t k = 0; k < ms.size(); ++k) phases_ms[k].push_back(ms[k]);
    }
    state.SetIterationTime(1e-3 * median(totals_ms));
    const auto surfels = static_cast<double>(fusion.map().size());
    if (surfels < 1e5) return state.SkipWithError("hardly any surfels");
    state.counters["surfels"] = surfels;
    state.counters["bytes_per_surfel"] =
        static_cast<double>(fusion.map().memory_bytes() + filter.memory_bytes()) / surfels;
    for (std::size_t k = 0; k < (filtered ? kPhases.size() : 4); ++k) {
      state.counters[std::string{kPhases[k]} + "_ms"] = median(phases_ms[k]);
    }
  }
}

void fusion(benchmark::State& state) { fuse_frames(state, false); }
void fusion_and_mode_filter(benchmark::State& state) { fuse_frames(state, true); }

void lengths(benchmark::internal::Benchmark* row) {
  for (const int count : {5, 200}) row->Args({count, 2});
  row->Args({200, 1})->ArgNames({"frames", "threads"})->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK(fusion)->Apply(lengths);
BENCHMARK(fusion_and_mode_filter)->Apply(lengths);

}  // namespace

BENCHMARK_MAIN();
