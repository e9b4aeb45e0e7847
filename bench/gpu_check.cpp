// SPDX-License-Identifier: Apache-2.0
// The program of scripts/gpu_check.sh, for a machine with a GPU: times on the thesis' table, then parity with the CPU
// to the bit on random maps. Prints JSON, a line for each part as soon as it is known, so that a run that is cut off
// leaves what it found; exit status 1 where a bit differs, 2 where there is no GPU. --emulated runs the kernels on the
// host, --quick fewer of them.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "gpu_steps.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/cuda/gpu_map.hpp"
#include "saccade/cuda/internal/cuda_compute.hpp"
#include "support/random_run.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;

using bench::GpuCheck;
using bench::limit;
using bench::median;
using bench::need;
using internal::cuda::Compute;
using internal::cuda::HostCompute;

/// What is asked of the GPU, in milliseconds.
constexpr double kAskedGains_ms{2.0};

Result<std::shared_ptr<Compute>> open_device(bool emulated) {
  if (emulated) return std::shared_ptr<Compute>{std::make_shared<HostCompute>(Executor::with_threads(0))};
  SACCADE_TRY(std::unique_ptr<Compute> device, internal::cuda::open_cuda());
  return std::shared_ptr<Compute>{std::move(device)};
}

struct Parity {
  int maps{0};
  int frames{0};
  int poses{0};
  int different_maps{0};
  int different_gains{0};
  int different_pixels{0};
};

/// Fuses random frames and evaluates random poses on both.
Parity check_parity(const GpuCheck& check) {
  Parity parity;
  const Executor executor = Executor::with_threads(0);
  const std::uint32_t runs = check.quick ? 3 : 200;
  for (std::uint32_t seed = 1; seed <= runs; ++seed) {
    test::RandomRun run = test::RandomRun::with_clearing(seed);
    TsdfMap expected = need(TsdfMap::create(run.config()));
    GpuMap map = bench::open(check, run.config());
    for (int frame = 0; frame < 4; ++frame, ++parity.frames) {
      const DepthImage depth = run.depth();
      const Pose T_world_camera = run.pose();
      need(expected.integrate(run.camera(), depth, T_world_camera, executor));
      need(map.integrate(run.camera(), depth, T_world_camera));
      parity.different_pixels +=
          bench::different_pixels(need(map.raycast(run.camera(), T_world_camera)),
                                  need(raycast(expected.content(), run.camera(), T_world_camera, executor)));
      if (!(need(map.snapshot()).grid == expected.content().grid)) ++parity.different_maps;
    }
    ++parity.maps;
    Region region = run.region();
    while (std::holds_alternative<Cylinder>(region)) region = run.region();
    std::vector<Pose> poses;
    for (int i = 0; i < 16; ++i) poses.push_back(run.pose());
    GainConfig config;
    config.sensor = run.camera();
    const auto wanted = need(evaluate_views(expected.content(), region, poses, config, executor)).gains;
    const auto got = need(map.evaluate_views(region, poses, config, executor)).gains;
    for (std::size_t i = 0; i < poses.size(); ++i, ++parity.poses)
      parity.different_gains += wanted[i] != got[i] ? 1 : 0;
  }
  return parity;
}

/// Times of the 960 views of thesis §2.2.3.
struct GainTimes {
  double gpu_ms{0.0};
  double gpu_prepare_ms{0.0};
  double cpu_ms{0.0};
  double rays{0.0};       ///< pixels of all poses
  double rays_cast{0.0};  ///< walked by the GPU
  std::size_t different{0};
  bench::LeastBytes least;
};

/// Returns a number of rays that surely score where this many do of each pose: poses with the same camera centre follow
/// each other and share rays, so that only the most of them counts.
double scoring_rays(std::span<const Pose> poses, std::span<const std::uint64_t> gains) {
  double rays{0.0};
  for (std::size_t begin = 0, end = 0; begin < poses.size(); begin = end) {
    while (end < poses.size() && poses[end].translation() == poses[begin].translation()) ++end;
    rays += static_cast<double>(*std::max_element(gains.begin() + static_cast<std::ptrdiff_t>(begin),
                                                  gains.begin() + static_cast<std::ptrdiff_t>(end)));
  }
  return rays;
}

GainTimes time_gains(const GpuCheck& check, std::size_t views) {
  const Executor executor = Executor::with_threads(0);
  const TsdfSnapshot& map = bench::map_after(views);
  GpuMap gpu = bench::open(check, map.config);
  need(gpu.assign(map));
  const std::vector<Pose> poses = check.quick ? bench::every_nth_pose(64) : bench::all_poses();
  GainTimes times;
  std::vector<double> gpu_ms;
  std::vector<double> prepare_ms;
  std::vector<double> cpu_ms;
  const int repeats = check.quick ? 1 : 20;
  GainResult expected;
  GainResult got;
  for (int i = 0; i < repeats; ++i) {
    Stopwatch clock;
    expected = need(evaluate_views(map, bench::kRegion, poses, {}, executor));
    cpu_ms.push_back(clock.lap_ms());
    const GpuTraffic before = gpu.traffic();
    got = need(gpu.evaluate_views(bench::kRegion, poses, {}, executor));
    gpu_ms.push_back(clock.lap_ms());
    times.least = bench::link_bytes(before, gpu.traffic());
    prepare_ms.push_back(got.prepare_ms);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) times.different += expected.gains[i] != got.gains[i] ? 1 : 0;
  times.gpu_ms = median(gpu_ms);
  times.gpu_prepare_ms = median(prepare_ms);
  times.cpu_ms = median(cpu_ms);
  times.rays = static_cast<double>(got.rays_total);
  times.rays_cast = static_cast<double>(got.rays_cast);
  // The kernel reads all that was sent; each ray that scores reads the entry of the brick where it ends, 4 bytes.
  times.least.memory = times.least.sent + times.least.read + 4.0 * scoring_rays(poses, got.gains);
  return times;
}

/// Times of a choice by Algorithm 2: an image is fused, the 960 views are evaluated, and the best is taken.
struct ChoiceTimes {
  double gpu_ms{0.0};
  double cpu_ms{0.0};
  std::size_t views{0};
  std::size_t choices{0};
  std::size_t different{0};
};

ChoiceTimes time_choices(const GpuCheck& check) {
  const Executor executor = Executor::with_threads(0);
  const PinholeCamera camera;
  const TsdfSnapshot& start = bench::map_after(0);
  TsdfMap cpu{start};
  GpuMap gpu = bench::open(check, start.config);
  need(gpu.assign(start));
  const std::vector<Pose> views = check.quick ? bench::every_nth_pose(64) : bench::all_poses();
  ChoiceTimes times;
  times.views = views.size();
  std::vector<double> gpu_ms;
  std::vector<double> cpu_ms;
  const auto best = [](const GainResult& result) {
    return std::max_element(result.gains.begin(), result.gains.end()) - result.gains.begin();
  };
  for (const Pose& pose : bench::every_nth_pose(check.quick ? 480 : 48)) {
    const DepthImage depth = need(render(bench::table(), camera, pose, executor)).depth;
    Stopwatch clock;
    need(gpu.integrate(camera, depth, pose));
    const auto got = best(need(gpu.evaluate_views(bench::kRegion, views, {}, executor)));
    gpu_ms.push_back(clock.lap_ms());
    need(cpu.integrate(camera, depth, pose, executor));
    const auto wanted = best(need(evaluate_views(cpu.content(), bench::kRegion, views, {}, executor)));
    cpu_ms.push_back(clock.lap_ms());
    times.different += got != wanted ? 1 : 0;
    ++times.choices;
  }
  times.gpu_ms = median(gpu_ms);
  times.cpu_ms = median(cpu_ms);
  return times;
}

void print_device(const GpuCheck& check, const Result<CudaDevice>& device) {
  std::printf("{\"device\": \"%s\", \"memory_gib\": %.1f, \"compute\": \"%d.%d\", \"driver\": %d,\n",
              check.emulated ? "emulated" : device->name.c_str(),
              device.ok() ? static_cast<double>(device->memory_bytes) / (1U << 30U) : 0.0,
              device.ok() ? device->compute_major : 0, device.ok() ? device->compute_minor : 0,
              device.ok() ? device->driver_version : 0);
}

// Each of the following prints a part, and returns whether all bits are equal.

bool check_gains(const GpuCheck& check) {
  bool equal{true};
  for (std::size_t views = 0; views < (check.quick ? 1U : 4U); views += 3) {
    const GainTimes gains = time_gains(check, views);
    std::printf(
        " \"gains_after_%zu_views\": {\"gpu_ms\": %.3f, %s, \"of_it_prepare_ms\": %.3f, \"cpu_ms\": %.3f, "
        "\"rays\": %.0f, \"rays_cast\": %.0f, \"different\": %zu, %s},\n",
        views, gains.gpu_ms, limit(gains.gpu_ms, kAskedGains_ms).c_str(), gains.gpu_prepare_ms, gains.cpu_ms,
        gains.rays, gains.rays_cast, gains.different,
        bench::share_of_rates(check.rates, gains.least, gains.gpu_ms).c_str());
    equal = equal && gains.different == 0;
  }
  return equal;
}

bool check_choices(const GpuCheck& check) {
  const ChoiceTimes choices = time_choices(check);
  std::printf(
      " \"choice_algorithm_2\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"views\": %zu, \"choices\": %zu, "
      "\"different\": %zu},\n",
      choices.gpu_ms, choices.cpu_ms, choices.views, choices.choices, choices.different);
  return choices.different == 0;
}

bool check_maps(const GpuCheck& check) {
  const Stopwatch clock;
  const Parity parity = check_parity(check);
  std::printf(
      " \"parity\": {\"maps\": %d, \"frames\": %d, \"poses\": %d, \"different_maps\": %d, \"different_gains\": %d, "
      "\"different_pixels\": %d, \"took_s\": %.1f},\n",
      parity.maps, parity.frames, parity.poses, parity.different_maps, parity.different_gains, parity.different_pixels,
      clock.elapsed_ms() / 1000.0);
  return parity.different_maps == 0 && parity.different_gains == 0 && parity.different_pixels == 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // a line is in the file once its part is done
  GpuCheck check;
  for (const char* argument : std::span{argv, static_cast<std::size_t>(argc)}.subspan(1)) {
    check.emulated = check.emulated || std::strcmp(argument, "--emulated") == 0;
    check.quick = check.quick || std::strcmp(argument, "--quick") == 0;
  }
  const auto device = cuda_device();
  if (!device.ok() && !check.emulated) {
    std::fprintf(stderr, "gpu_check: %s\n", device.error().to_string().c_str());
    return 2;
  }
  const Stopwatch clock;
  check.device = need(open_device(check.emulated));
  print_device(check, device);
  std::printf(" \"opening_ms\": %.1f,\n", clock.elapsed_ms());
  check.rates = need(bench::check_copies(*check.device, check.quick));
  bool equal = check_gains(check);
  equal = bench::check_gpu_frames(check) && equal;
  equal = bench::check_gpu_tracking(check) && equal;
  equal = need(bench::check_gpu_choices(check)) && equal;
  equal = check_choices(check) && equal;
  equal = need(bench::check_gpu_steps(check)) && equal;
  equal = check_maps(check) && equal;
  std::printf(" \"status\": %d}\n", equal ? 0 : 1);
  return equal ? 0 : 1;
}
