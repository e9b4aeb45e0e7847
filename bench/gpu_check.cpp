// SPDX-License-Identifier: Apache-2.0
// The program of scripts/gpu_check.sh, for a machine with a GPU: times on the thesis' table, then parity with the CPU
// to the bit on random maps. Prints JSON, a line for each part as soon as it is known, so that a run that is cut off
// leaves what it found; exit status 1 where a bit differs, 2 where there is no GPU. --emulated runs the kernels on the
// host, --quick fewer of them.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu_device.hpp"
#include "gpu_steps.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/cuda/gpu_align.hpp"
#include "saccade/cuda/gpu_map.hpp"
#include "saccade/cuda/internal/cuda_compute.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "support/random_run.hpp"
#include "table_map.hpp"

namespace {

using namespace saccade;

using internal::cuda::Compute;
using internal::cuda::GpuMapMaker;
using internal::cuda::HostCompute;

/// What is asked of the GPU, in milliseconds.
constexpr double kAskedGains_ms{2.0};
constexpr double kAskedFusion_ms{0.3};
constexpr double kAskedChoice_ms{10.0};

struct Options {
  bool emulated{false};
  bool quick{false};
  std::shared_ptr<Compute> device;
};

Result<std::shared_ptr<Compute>> open_device(bool emulated) {
  if (emulated) return std::shared_ptr<Compute>{std::make_shared<HostCompute>(Executor::with_threads(0))};
  SACCADE_TRY(std::unique_ptr<Compute> device, internal::cuda::open_cuda());
  return std::shared_ptr<Compute>{std::move(device)};
}

/// Makes a map on the one device.
Result<GpuMap> open(const Options& options, const TsdfConfig& config) {
  return GpuMapMaker::make(config, std::make_unique<bench::BorrowedCompute>(options.device));
}

/// Members of a JSON object: what is asked of a time, and whether that is met.
std::string limit(double took_ms, double asked_ms) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "\"asked_ms\": %.1f, \"met\": %s", asked_ms,
                took_ms <= asked_ms ? "true" : "false");
  return text.data();
}

/// Ends the program on an error.
template <class T>
T need(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  std::fprintf(stderr, "gpu_check: %s\n", result.error().to_string().c_str());
  std::exit(1);
}
void need(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "gpu_check: %s\n", status.error().to_string().c_str());
  std::exit(1);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Parity {
  int maps{0};
  int frames{0};
  int poses{0};
  int different_maps{0};
  int different_gains{0};
  int different_pixels{0};
};

int different_pixels(const SurfaceView& a, const SurfaceView& b) {
  int different{0};
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    different += a.depth.data()[i] != b.depth.data()[i] || a.normals.data()[i] != b.normals.data()[i] ? 1 : 0;
  }
  return different;
}

/// Fuses random frames and evaluates random poses on both.
Parity check_parity(const Options& options) {
  Parity parity;
  const Executor executor = Executor::with_threads(0);
  const std::uint32_t runs = options.quick ? 3 : 200;
  for (std::uint32_t seed = 1; seed <= runs; ++seed) {
    test::RandomRun run = test::RandomRun::with_clearing(seed);
    TsdfMap expected = need(TsdfMap::create(run.config()));
    GpuMap map = need(open(options, run.config()));
    for (int frame = 0; frame < 4; ++frame, ++parity.frames) {
      const DepthImage depth = run.depth();
      const Pose T_world_camera = run.pose();
      need(expected.integrate(run.camera(), depth, T_world_camera, executor));
      need(map.integrate(run.camera(), depth, T_world_camera));
      parity.different_pixels +=
          different_pixels(need(map.raycast(run.camera(), T_world_camera)),
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
};

GainTimes time_gains(const Options& options, std::size_t views) {
  const Executor executor = Executor::with_threads(0);
  const TsdfSnapshot& map = bench::map_after(views);
  GpuMap gpu = need(open(options, map.config));
  need(gpu.assign(map));
  const std::vector<Pose> poses = options.quick ? bench::every_nth_pose(64) : bench::all_poses();
  GainTimes times;
  std::vector<double> gpu_ms;
  std::vector<double> prepare_ms;
  std::vector<double> cpu_ms;
  const int repeats = options.quick ? 1 : 20;
  GainResult expected;
  GainResult got;
  for (int i = 0; i < repeats; ++i) {
    Stopwatch clock;
    expected = need(evaluate_views(map, bench::kRegion, poses, {}, executor));
    cpu_ms.push_back(clock.lap_ms());
    got = need(gpu.evaluate_views(bench::kRegion, poses, {}, executor));
    gpu_ms.push_back(clock.lap_ms());
    prepare_ms.push_back(got.prepare_ms);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) times.different += expected.gains[i] != got.gains[i] ? 1 : 0;
  times.gpu_ms = median(gpu_ms);
  times.gpu_prepare_ms = median(prepare_ms);
  times.cpu_ms = median(cpu_ms);
  times.rays = static_cast<double>(got.rays_total);
  times.rays_cast = static_cast<double>(got.rays_cast);
  return times;
}

/// Times of a whole choice: an image is fused, the 960 views are evaluated, and the best is taken.
struct ChoiceTimes {
  double gpu_ms{0.0};
  double cpu_ms{0.0};
  std::size_t views{0};
  std::size_t choices{0};
  std::size_t different{0};
};

ChoiceTimes time_choices(const Options& options) {
  const Executor executor = Executor::with_threads(0);
  const PinholeCamera camera;
  const TsdfSnapshot& start = bench::map_after(0);
  TsdfMap cpu{start};
  GpuMap gpu = need(open(options, start.config));
  need(gpu.assign(start));
  const std::vector<Pose> views = options.quick ? bench::every_nth_pose(64) : bench::all_poses();
  ChoiceTimes times;
  times.views = views.size();
  std::vector<double> gpu_ms;
  std::vector<double> cpu_ms;
  const auto best = [](const GainResult& result) {
    return std::max_element(result.gains.begin(), result.gains.end()) - result.gains.begin();
  };
  for (const Pose& pose : bench::every_nth_pose(options.quick ? 480 : 48)) {
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

struct FrameTimes {
  double gpu_ms{0.0};
  double cpu_ms{0.0};
  double gpu_raycast_ms{0.0};
  double cpu_raycast_ms{0.0};
  int frames{0};
  int different_pixels{0};
  double gpu_align_ms{0.0};
  double cpu_align_ms{0.0};
  int different_alignments{0};
  bool equal{false};
};

/// Times fusion and ray casts of 640×480 images of the table from poses around it, in a map that has seen them all
/// before.
FrameTimes time_frames(const Options& options) {
  const Executor executor = Executor::with_threads(0);
  const PinholeCamera camera;
  std::vector<Pose> poses = bench::every_nth_pose(options.quick ? 320 : 48);
  std::vector<DepthImage> images;
  for (const Pose& pose : poses) images.push_back(need(render(bench::table(), camera, pose, executor)).depth);
  TsdfMap cpu = need(TsdfMap::create({}));
  GpuMap gpu = need(open(options, {}));
  GpuAligner aligner = need(options.emulated ? GpuAligner::create_emulated(executor) : GpuAligner::create());
  std::vector<double> gpu_ms;
  std::vector<double> cpu_ms;
  std::vector<double> gpu_raycast_ms;
  std::vector<double> cpu_raycast_ms;
  std::vector<double> gpu_align_ms;
  std::vector<double> cpu_align_ms;
  FrameTimes times;
  Pose T_start = Pose::Identity();
  T_start.translation() = Eigen::Vector3d{0.01, -0.005, 0.008};
  for (int round = 0; round < (options.quick ? 1 : 3); ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i, ++times.frames) {
      Stopwatch clock;
      need(cpu.integrate(camera, images[i], poses[i], executor));
      const double cpu_took_ms = clock.lap_ms();
      need(gpu.integrate(camera, images[i], poses[i]));
      const double gpu_took_ms = clock.lap_ms();
      const SurfaceView on_gpu = need(gpu.raycast(camera, poses[i]));
      const double gpu_cast_took_ms = clock.lap_ms();
      const SurfaceView on_cpu = need(raycast(cpu.content(), camera, poses[i], executor));
      const double cpu_cast_took_ms = clock.lap_ms();
      times.different_pixels += different_pixels(on_gpu, on_cpu);
      const PointImage measured = to_points(images[i], camera, executor);
      const PointImage model = to_points(on_cpu, executor);
      clock.lap_ms();
      const IcpResult aligned = align(measured, model, camera, T_start, executor);
      const double cpu_align_took_ms = clock.lap_ms();
      const IcpResult gpu_aligned = need(aligner.align(measured, model, camera, T_start));
      const double gpu_align_took_ms = clock.lap_ms();
      const bool same = aligned.T_model_camera.matrix() == gpu_aligned.T_model_camera.matrix();
      times.different_alignments += same ? 0 : 1;
      if (round == 0 && !options.quick) continue;
      cpu_ms.push_back(cpu_took_ms);
      gpu_ms.push_back(gpu_took_ms);
      gpu_raycast_ms.push_back(gpu_cast_took_ms);
      cpu_raycast_ms.push_back(cpu_cast_took_ms);
      gpu_align_ms.push_back(gpu_align_took_ms);
      cpu_align_ms.push_back(cpu_align_took_ms);
    }
  }
  times.gpu_ms = median(gpu_ms);
  times.cpu_ms = median(cpu_ms);
  times.gpu_raycast_ms = median(gpu_raycast_ms);
  times.cpu_raycast_ms = median(cpu_raycast_ms);
  times.gpu_align_ms = median(gpu_align_ms);
  times.cpu_align_ms = median(cpu_align_ms);
  times.equal = need(gpu.snapshot()).grid == cpu.content().grid;
  return times;
}

const char* text_of(bool value) { return value ? "true" : "false"; }

void print_device(const Options& options, const Result<CudaDevice>& device) {
  std::printf("{\"device\": \"%s\", \"memory_gib\": %.1f, \"compute\": \"%d.%d\", \"driver\": %d,\n",
              options.emulated ? "emulated" : device->name.c_str(),
              device.ok() ? static_cast<double>(device->memory_bytes) / (1U << 30U) : 0.0,
              device.ok() ? device->compute_major : 0, device.ok() ? device->compute_minor : 0,
              device.ok() ? device->driver_version : 0);
}

// Each of the following prints a part, and returns whether all bits are equal.

bool check_gains(const Options& options) {
  bool equal{true};
  for (std::size_t views = 0; views < (options.quick ? 1U : 4U); views += 3) {
    const GainTimes gains = time_gains(options, views);
    std::printf(
        " \"gains_after_%zu_views\": {\"gpu_ms\": %.3f, %s, \"of_it_prepare_ms\": %.3f, \"cpu_ms\": %.3f, "
        "\"rays\": %.0f, \"rays_cast\": %.0f, \"different\": %zu},\n",
        views, gains.gpu_ms, limit(gains.gpu_ms, kAskedGains_ms).c_str(), gains.gpu_prepare_ms, gains.cpu_ms,
        gains.rays, gains.rays_cast, gains.different);
    equal = equal && gains.different == 0;
  }
  return equal;
}

bool check_choices(const Options& options) {
  const ChoiceTimes choices = time_choices(options);
  std::printf(
      " \"choice\": {\"gpu_ms\": %.3f, %s, \"cpu_ms\": %.3f, \"views\": %zu, \"choices\": %zu, \"different\": %zu},\n",
      choices.gpu_ms, limit(choices.gpu_ms, kAskedChoice_ms).c_str(), choices.cpu_ms, choices.views, choices.choices,
      choices.different);
  return choices.different == 0;
}

bool check_frames(const Options& options) {
  const FrameTimes frames = time_frames(options);
  std::printf(" \"fusion\": {\"gpu_ms\": %.3f, %s, \"cpu_ms\": %.3f, \"frames\": %d, \"equal\": %s},\n", frames.gpu_ms,
              limit(frames.gpu_ms, kAskedFusion_ms).c_str(), frames.cpu_ms, frames.frames, text_of(frames.equal));
  std::printf(" \"raycast\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"different\": %d},\n", frames.gpu_raycast_ms,
              frames.cpu_raycast_ms, frames.different_pixels);
  std::printf(" \"align\": {\"gpu_ms\": %.3f, \"cpu_ms\": %.3f, \"different\": %d},\n", frames.gpu_align_ms,
              frames.cpu_align_ms, frames.different_alignments);
  return frames.equal && frames.different_pixels == 0 && frames.different_alignments == 0;
}

bool check_maps(const Options& options) {
  const Stopwatch clock;
  const Parity parity = check_parity(options);
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
  Options options;
  for (const char* argument : std::span{argv, static_cast<std::size_t>(argc)}.subspan(1)) {
    options.emulated = options.emulated || std::strcmp(argument, "--emulated") == 0;
    options.quick = options.quick || std::strcmp(argument, "--quick") == 0;
  }
  const auto device = cuda_device();
  if (!device.ok() && !options.emulated) {
    std::fprintf(stderr, "gpu_check: %s\n", device.error().to_string().c_str());
    return 2;
  }
  const Stopwatch clock;
  options.device = need(open_device(options.emulated));
  print_device(options, device);
  std::printf(" \"opening_ms\": %.1f,\n", clock.elapsed_ms());
  bool equal = check_gains(options);
  equal = check_choices(options) && equal;
  equal = check_frames(options) && equal;
  equal = need(bench::check_gpu_steps(
              {options.quick, options.emulated, [&](const TsdfConfig& config) { return open(options, config); }})) &&
          equal;
  equal = check_maps(options) && equal;
  std::printf(" \"status\": %d}\n", equal ? 0 : 1);
  return equal ? 0 : 1;
}
