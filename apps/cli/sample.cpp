// SPDX-License-Identifier: Apache-2.0
// saccade sample: writes a small posed RGB-D sequence of a made-up table, in the layout of 7-Scenes.
#include <CLI/CLI.hpp>
#include <array>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>

#include "add_value.hpp"
#include "command.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/noise.hpp"

namespace saccade::cli {
namespace {

constexpr const char* kIntrinsicsFile{"camera-intrinsics.txt"};
constexpr double kMaxRange_m{2.5};

struct SampleOptions {
  std::filesystem::path out;
  std::size_t frames{60};
  bool noise{false};
  CameraOptions camera_options;
  PinholeCamera camera;
  bool force{false};
};

Status write_intrinsics(const std::filesystem::path& path, const PinholeCamera& camera) {
  std::ostringstream text;
  text << std::setprecision(17) << camera.fx << " 0 " << camera.cx << "\n0 " << camera.fy << ' ' << camera.cy
       << "\n0 0 1\n";
  return write_file_atomically(path, text.str());
}

Status write_frame(const RunFolder& out, const SampleOptions& options, const RenderedFrame& rendered,
                   const Pose& T_world_camera, std::size_t index, std::uint64_t seed) {
  std::ostringstream name;
  name << "frame-" << std::setw(6) << std::setfill('0') << index;
  DepthNoise noise;
  noise.seed = seed;
  const DepthImage depth = options.noise ? with_noise(rendered.depth, noise, index) : rendered.depth;
  SACCADE_CHECK(write_png16(out / (name.str() + ".depth.png"), encode_depth(depth, DepthEncoding{})));
  SACCADE_CHECK(write_png(out / (name.str() + ".color.png"), rendered.color));
  return write_matrices(out / (name.str() + ".pose.txt"), std::array{T_world_camera});
}

Result<int> run_sample(const SampleOptions& options, const GlobalOptions& global) {
  const Stopwatch stopwatch;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(const RunFolder out, RunFolder::open(options.out, {}, "", options.force));
  const AnalyticScene scene = sample_tabletop();
  const std::vector<Pose> T_world_camera = sample_trajectory(options.frames);
  ProgressBar bar{global.quiet};
  SACCADE_CHECK(write_intrinsics(out / kIntrinsicsFile, options.camera));
  std::size_t done = 0;
  for (; done < T_world_camera.size() && !interrupted(); ++done) {
    bar.update("rendering", done, T_world_camera.size());
    SACCADE_TRY(const RenderedFrame frame, render(scene, options.camera, T_world_camera[done], executor));
    SACCADE_CHECK(write_frame(out, options, frame, T_world_camera[done], done, global.seed));
  }
  bar.finish();
  const nlohmann::json result{{"out", options.out.string()}, {"frames", done}, {"interrupted", interrupted()}};
  SACCADE_CHECK(write_result("sample", global, executor, {{"total", stopwatch.elapsed_ms()}}, result));
  if (!global.json_to_stdout()) std::cout << done << " frames in " << options.out.string() << '\n';
  return interrupted() ? interrupt_status() : static_cast<int>(ExitStatus::done);
}

}  // namespace

void add_sample(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("sample", "writes a small posed RGB-D sequence of a made-up table");
  auto options = std::make_shared<SampleOptions>();
  add_value(*command, "--out", options->out, "DIR", "folder for the frames; made if it is not there")->required();
  add_value(*command, "--frames", options->frames, "N", "number of frames")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  command->add_flag("--noise", options->noise, "depth noise as of a Kinect v1, drawn from --seed");
  add_camera_options(*command, options->camera_options, true);
  command->add_flag("--force", options->force, "write into a folder that holds other files");
  command->callback([options, &global, &action] {
    PinholeCamera near_camera;  // the table, and some of the floor and the wall
    near_camera.max_range_m = kMaxRange_m;
    options->camera = options->camera_options.camera(near_camera);
    require_ok(options->camera.validate(), "the camera");
    action = [options, &global] { return run_sample(*options, global); };
  });
}

}  // namespace saccade::cli
