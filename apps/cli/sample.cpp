// SPDX-License-Identifier: Apache-2.0
// saccade sample: writes a small RGB-D sequence with poses, of a simulated table, in the layout of 7-Scenes.
#include <array>
#include <iomanip>
#include <sstream>

#include "context.hpp"
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
  std::size_t frames{60};
  bool noise{false};
  CameraOptions camera_options;
  PinholeCamera camera;
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

class Sample final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"sample", "writes a small RGB-D sequence with poses, of a simulated table"};
  }

  void declare(Options& options) override {
    options.folder({.help = "folder for the frames; made if it is not there", .required = true});
    options.value("--frames", sample_.frames, "N", "number of frames").range(std::size_t{1}, std::size_t{1000000});
    options.flag("--noise", sample_.noise, "depth noise as of a Kinect v1, drawn from --seed");
    add_camera_options(options.group(), sample_.camera_options, true);
  }

  void check(const GlobalOptions& /*global*/) override {
    PinholeCamera near_camera;  // the table, and some of the floor and the wall
    near_camera.max_range_m = kMaxRange_m;
    sample_.camera = sample_.camera_options.camera(near_camera);
    require_ok(sample_.camera.validate(), "the camera");
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    const RunFolder& out = *context.folder();
    const AnalyticScene scene = sample_tabletop();
    const std::vector<Pose> T_world_camera = sample_trajectory(sample_.frames);
    SACCADE_CHECK(write_intrinsics(out / kIntrinsicsFile, sample_.camera));
    std::size_t done = 0;
    for (; done < T_world_camera.size() && !interrupted(); ++done) {
      context.bar().update("rendering", done, T_world_camera.size());
      SACCADE_TRY(const RenderedFrame frame, render(scene, sample_.camera, T_world_camera[done], context.executor()));
      SACCADE_CHECK(write_frame(out, sample_, frame, T_world_camera[done], done, context.seed()));
    }
    return Outcome{.result = {{"out", context.out().string()}, {"frames", done}, {"interrupted", interrupted()}},
                   .text = std::to_string(done) + " frames in " + context.out().string() + "\n"};
  }

 private:
  SampleOptions sample_;
};

}  // namespace

void add_sample(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Sample>(program, global, action);
}

}  // namespace saccade::cli
