// SPDX-License-Identifier: Apache-2.0
// Frames of a table with noise into surfels and their modes: ours beside Algorithm 6 as it is printed, on the same
// frames and associations.
#include "saccade/surfel/mode_filter.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/noise.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "support/naive_mode_filter.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kFrames{6};

/// Frames, and what the fusion made of each.
struct Sequence {
  PinholeCamera camera;
  std::vector<Frame> frames;
  std::vector<SurfelAssociation> seen;
};

const Sequence& sequence() {
  static const Sequence made = [] {
    Sequence all;
    all.camera = camera_preset("kinect-v1").value();
    SurfelFusion fusion = SurfelFusion::create().value();
    std::mt19937 random{5};
    const std::vector<Pose> poses = sample_trajectory(200);
    for (std::size_t i = 0; i < kFrames; ++i) {
      RenderedFrame seen = render(sample_tabletop(), all.camera, poses[i]).value();
      Frame frame;
      frame.depth = with_noise(seen.depth, DepthNoise{.seed = i});
      frame.color = std::move(seen.color);
      for (std::size_t k = 0; k < frame.color->size(); ++k) {  // some twelve levels, as a camera's noise
        for (std::uint8_t& channel : frame.color->data()[k])
          channel = static_cast<std::uint8_t>(channel / 2 + random() % 13);
      }
      frame.T_world_camera = poses[i];
      if (!fusion.add_frame(frame, all.camera, {})) std::abort();
      all.seen.push_back(fusion.association());
      all.frames.push_back(std::move(frame));
    }
    return all;
  }();
  return made;
}

std::size_t count_modes(const ModeFilter& filter) {
  std::size_t modes{0};
  for (SurfelId id = 0; id < filter.size(); ++id) modes += filter.modes(id).size();
  return modes;
}

void ours(benchmark::State& state) {
  const Sequence& all = sequence();
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  std::size_t modes{0};
  for (auto _ : state) {
    ModeFilter filter = ModeFilter::create().value();
    for (std::size_t i = 0; i < kFrames; ++i) {
      if (!filter.add_frame(all.frames[i], all.seen[i], executor)) state.SkipWithError("a frame that cannot be taken");
    }
    state.PauseTiming();
    modes = count_modes(filter);
    state.ResumeTiming();
  }
  test::NaiveModes naive;
  for (std::size_t i = 0; i < kFrames; ++i) test::naive_mode_filter(naive, all.frames[i], all.seen[i], {});
  std::size_t wanted{0};
  for (const auto& of_surfel : naive) wanted += of_surfel.size();
  const std::size_t off = modes > wanted ? modes - wanted : wanted - modes;  // where single and double precision part
  if (off > 10 || modes < 1'000'000) state.SkipWithError("other modes than the naive ones");
  state.counters["modes"] = static_cast<double>(modes);
}

void naive(benchmark::State& state) {
  const Sequence& all = sequence();
  for (auto _ : state) {
    test::NaiveModes modes;
    for (std::size_t i = 0; i < kFrames; ++i) test::naive_mode_filter(modes, all.frames[i], all.seen[i], {});
    benchmark::DoNotOptimize(modes);
  }
}

BENCHMARK(ours)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(naive)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
