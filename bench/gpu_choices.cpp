// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <vector>

#include "gpu_steps.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/views/surface_gain.hpp"
#include "saccade/views/surface_views.hpp"
#include "table_map.hpp"

namespace saccade::bench {
namespace {

/// What is asked of the GPU, in milliseconds.
constexpr double kAskedChoice_ms{10.0};
constexpr std::size_t kTries{4};  // as the surface strategy
/// A choice reads states, finds exposed voxels and traces lines of sight. Fewer kernels: the CPU did some of it.
constexpr std::uint64_t kKernels{3};

/// The surface strategy without a robot, on the CPU or with a device beside it. Follows one map.
class Chooser {
 public:
  explicit Chooser(ViewDevice* device, std::size_t every) : device_{device}, every_{every} {}

  /// Chooses as ViewPlanner::rank does for the workspace as the region: expected surface (the device follows the map
  /// first), candidates, the best of them.
  Result<RankedViews> choose(const TsdfSnapshot& map, const std::vector<Pose>& taken) {
    const Executor executor = Executor::with_threads(0);
    std::shared_ptr<const ExpectedSurface> expected;
    PlanningContext context{map, executor};
    context.expected = &expected;
    context.device = device_;
    context.attempted = [&](const Pose& pose) {
      return std::any_of(taken.begin(), taken.end(),
                         [&](const Pose& other) { return other.matrix() == pose.matrix(); });
    };
    const Stopwatch whole;
    Stopwatch clock;
    SACCADE_TRY(const auto regions, WholeWorkspace{}.regions(context));
    const SurfaceGainConfig config;
    SACCADE_TRY(const auto surface, expected_surface(context, config.surface));
    surface_ms.push_back(clock.lap_ms());
    SACCADE_TRY(ViewCandidates found, views_.views(context, regions.front()));
    candidates = found.T_world_camera.size();
    candidates_ms.push_back(clock.lap_ms());
    if (every_ > 1) {
      std::vector<Pose> some;
      for (std::size_t i = 0; i < candidates; i += every_) some.push_back(found.T_world_camera[i]);
      found.T_world_camera = std::move(some);
      clock.lap_ms();
    }
    SACCADE_TRY(RankedViews best, SurfaceGain{config}.best(context, regions.front(), found.T_world_camera, kTries));
    evaluated = best.evaluated;
    best_ms.push_back(clock.lap_ms());
    whole_ms.push_back(whole.elapsed_ms());
    return best;
  }

  std::vector<double> surface_ms;
  std::vector<double> candidates_ms;
  std::vector<double> best_ms;
  std::vector<double> whole_ms;
  std::size_t candidates{0};
  std::size_t evaluated{0};

 private:
  ViewDevice* device_;
  std::size_t every_;
  SurfaceViews views_{std::make_shared<ContourViews>()};
};

bool equal(const RankedViews& a, const RankedViews& b) {
  return std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(),
                    [](const RankedView& p, const RankedView& q) {
                      return p.gain == q.gain && p.T_world_camera.matrix() == q.T_world_camera.matrix();
                    });
}

/// Returns the first view that was not taken; nullptr: there is none.
const RankedView* next_of(const RankedViews& ranked, const std::vector<Pose>& taken) {
  for (const RankedView& view : ranked.views) {
    const bool again = std::any_of(taken.begin(), taken.end(),
                                   [&](const Pose& pose) { return pose.matrix() == view.T_world_camera.matrix(); });
    if (!again && view.gain > 0.0) return &view;
  }
  return nullptr;
}

}  // namespace

Result<bool> check_gpu_choices(const GpuCheck& check) {
  const Executor executor = Executor::with_threads(0);
  const PinholeCamera camera;
  TsdfSnapshot start = map_after(0);
  start.config.workspace = Box{{-0.6, -0.6, -0.1}, {0.6, 0.6, 0.5}};
  TsdfMap map{start};
  GpuMap gpu = open(check, start.config);
  const std::size_t every = check.quick ? 64 : 1;
  Chooser on_gpu{&gpu, every};
  Chooser on_cpu{nullptr, every};
  std::vector<Pose> taken;
  bool same{true};
  std::uint64_t kernels{0};  // the least of a choice
  for (int i = 0; i < (check.quick ? 2 : 12); ++i) {
    const GpuTraffic before = gpu.traffic();
    SACCADE_TRY(const RankedViews got, on_gpu.choose(map.content(), taken));
    const std::uint64_t started = gpu.traffic().kernels - before.kernels;
    kernels = i == 0 ? started : std::min(kernels, started);
    SACCADE_TRY(const RankedViews wanted, on_cpu.choose(map.content(), taken));
    same = same && equal(got, wanted);
    const RankedView* const next = next_of(wanted, taken);
    if (next == nullptr) break;
    SACCADE_TRY(const RenderedFrame seen, render(table(), camera, next->T_world_camera, executor));
    SACCADE_CHECK(map.integrate(camera, seen.depth, next->T_world_camera, executor));
    taken.push_back(next->T_world_camera);
  }
  same = same && kernels >= kKernels;
  const double gpu_ms = median(on_gpu.whole_ms);
  std::printf(
      " \"choice_surface\": {\"gpu_ms\": %.3f, %s, \"first_ms\": %.3f, \"of_it_surface_ms\": %.3f, "
      "\"of_it_candidates_ms\": %.3f, \"of_it_best_ms\": %.3f, \"cpu_ms\": %.3f, \"cpu_surface_ms\": %.3f, "
      "\"cpu_best_ms\": %.3f, \"candidates\": %zu, \"evaluated\": %zu, \"choices\": %zu, \"kernels\": %zu, \"equal\": "
      "%s},\n",
      gpu_ms, limit(gpu_ms, kAskedChoice_ms).c_str(), on_gpu.whole_ms.front(), median(on_gpu.surface_ms),
      median(on_gpu.candidates_ms), median(on_gpu.best_ms), median(on_cpu.whole_ms), median(on_cpu.surface_ms),
      median(on_cpu.best_ms), on_gpu.candidates, on_gpu.evaluated, on_gpu.whole_ms.size(),
      static_cast<std::size_t>(kernels), text_of(same));
  return same;
}

}  // namespace saccade::bench
