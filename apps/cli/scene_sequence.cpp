// SPDX-License-Identifier: Apache-2.0
// saccade scene sequence: a hand-held camera before a scene for surfels, as a folder of frames with their truth.
#include "scene_sequence.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

#include "context.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/scene/place_scenes.hpp"
#include "saccade/scene/rendered_sequence.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr const char* kDocument{"sequence.json"};
constexpr const char* kCamera{"camera.json"};
constexpr const char* kTruePoses{"true-poses.txt"};
/// The depth is written last: what reads the folder knows a frame by it.
constexpr std::array<std::string_view, 4> kFrameFiles{".color.png", ".label.png", ".pose.txt", ".depth.png"};
constexpr int kSmallestEdge_px{16};
constexpr int kLargestEdge_px{2048};

struct SequenceOptions {
  std::string scene;
  std::optional<std::size_t> frames;
  std::string sensor;
  std::optional<std::pair<int, int>> image_size;
  bool depth_noise{true};
  bool pose_noise{true};
  bool color_noise{true};
  std::optional<Vignetting> vignetting;
  std::optional<bool> automatic_gain;
};

std::string frame_name(std::size_t index) {
  std::ostringstream name;
  name << "frame-" << std::setw(6) << std::setfill('0') << index;
  return name.str();
}

/// Sequence that the scene and the options describe together.
struct Sequence {
  Scene scene;
  std::vector<Pose> true_poses;
  RenderedSequenceConfig config;
  json switches;
};

/// Scene, path and sensor that a name stands for.
struct Place {
  Scene scene;
  std::vector<Pose> poses;
  std::string_view sensor{"xtion"};
  ColorCameraConfig color{};
};

Result<Place> place_of(const SequenceOptions& options, std::uint64_t seed) {
  if (options.scene.find(':') != std::string::npos) {
    SACCADE_TRY(PlaceScene place, place_scene(options.scene));
    return Place{std::move(place.scene), carried_poses(place.path, options.frames.value_or(place.frames), seed)};
  }
  auto made = surfel_scene(options.scene);
  if (!made) {
    Error error = made.error();
    error.message += ", and loop:SEED and alike:SEED";
    return error;
  }
  return Place{std::move(made->scene), hand_held_poses(made->path, options.frames.value_or(made->frames), seed),
               made->sensor, made->color};
}

Result<Sequence> sequence_of(const SequenceOptions& options, std::uint64_t seed) {
  SACCADE_TRY(Place scene, place_of(options, seed));
  const std::string sensor{options.sensor.empty() ? std::string{scene.sensor} : options.sensor};
  SACCADE_TRY(RenderedSequenceConfig config, surfel_sensor(sensor));
  CameraOptions size;
  size.image_size = options.image_size;
  config.camera = size.camera(config.camera);
  SACCADE_CHECK(config.camera.validate());
  config.color = scene.color;
  config.color.noise = options.color_noise;
  config.color.automatic_gain = options.automatic_gain.value_or(config.color.automatic_gain);
  config.color.vignetting = options.vignetting.value_or(config.color.vignetting);
  if (!options.depth_noise) {
    config.depth_noise.reset();
    config.time_of_flight.reset();
  }
  if (!options.pose_noise) config.pose_noise.reset();
  config.color.seed = seed;
  if (config.pose_noise) config.pose_noise->seed = seed;
  if (config.depth_noise) config.depth_noise->seed = seed;
  if (config.time_of_flight) config.time_of_flight->noise.seed = seed;
  json switches{{"sensor", sensor},
                {"depth_noise", kOnOff.of(options.depth_noise)},
                {"pose_noise", kOnOff.of(options.pose_noise)},
                {"color_noise", kOnOff.of(options.color_noise)},
                {"vignetting", kVignettingNames.of(config.color.vignetting)},
                {"auto_gain", kOnOff.of(config.color.automatic_gain)}};
  return Sequence{std::move(scene.scene), std::move(scene.poses), config, std::move(switches)};
}

/// An earlier sequence must not end where this one does, with other frames behind it.
Status remove_earlier(const RunFolder& out) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(out / kDocument, code)) return {};
  SACCADE_TRY(const json earlier, read_json(out / kDocument));
  if (!earlier.is_object() || !earlier.contains("frames") || !earlier.at("frames").is_number_unsigned()) {
    return Error{Errc::corrupt_data, "does not describe a sequence; remove it, or choose another folder",
                 (out / kDocument).string()};
  }
  // The planned frames, since one that was killed wrote no other number.
  const auto frames = std::min<std::size_t>(earlier.at("frames").get<std::size_t>(), 1000000);
  for (std::size_t i = 0; i < frames; ++i) {
    for (auto end = kFrameFiles.rbegin(); end != kFrameFiles.rend(); ++end) {
      const std::string name = frame_name(i) + std::string{*end};
      SACCADE_CHECK(out.remove(std::array<std::string_view, 1>{name}));
    }
  }
  return out.remove(std::array<std::string_view, 2>{kTruePoses, kDocument});
}

/// A frame and what is true of it.
struct Shot {
  Frame frame;
  Image<std::uint16_t> label;
};

Status write_shot(const RunFolder& out, const Shot& shot) {
  const std::string name = frame_name(shot.frame.index);
  const auto path = [&](std::size_t k) { return out / (name + std::string{kFrameFiles[k]}); };
  SACCADE_CHECK(write_png(path(0), *shot.frame.color));
  SACCADE_CHECK(write_png16(path(1), shot.label));
  SACCADE_CHECK(write_matrices(path(2), std::array{*shot.frame.T_world_camera}));
  return write_png16(path(3), encode_depth(shot.frame.depth, DepthEncoding{}));
}

/// One frame per thread: most of the time goes into packing colours.
Status write_shots(const RunFolder& out, std::span<const Shot> shots, const Executor& executor) {
  std::vector<Status> written(shots.size());
  executor.parallel_for(shots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) written[i] = write_shot(out, shots[i]);
  });
  for (const Status& status : written) SACCADE_CHECK(status);
  return {};
}

json document(const Sequence& sequence, std::uint64_t seed, const std::vector<std::string>& segments) {
  json names = json::object();
  for (std::size_t label = 1; label < segments.size(); ++label) names[std::to_string(label)] = segments[label];
  return {{"scene", sequence.scene.name},  {"frames", sequence.true_poses.size()}, {"complete", false}, {"seed", seed},
          {"switches", sequence.switches}, {"segments", std::move(names)}};
}

class SceneSequence final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "sequence",
            .description = "renders frames of a hand-held camera in a scene, with the ground truth of every pixel",
            .result_name = "scene"};
  }

  void declare(Options& options) override {
    options.value("scene", options_.scene, "SCENE", joined(kSurfelScenes) + ", loop:SEED, alike:SEED").required();
    options.folder({.help = "folder for the frames; made if it is not there",
                    .marker = kDocument,
                    .required = true,
                    .opened_by_command = true});
    options.value("--frames", options_.frames, "N", "number of frames; without it, as many as the thesis' scene has")
        .range(std::size_t{1}, std::size_t{1000000});
    const auto take = [this](const std::string& name) { options_.sensor = name; };
    add_words(options.group(), "--camera", kSurfelSensors, take,
              "sensor and its noise; without it, that of the thesis' scene");
    options.value("--image-size", options_.image_size, "W,H", "width and height, pixels; the lens stays the same")
        .delimiter(',');
    options.choice("--depth-noise", options_.depth_noise, kOnOff, "noise and flaws of the sensor's depth");
    options.choice("--pose-noise", options_.pose_noise, kOnOff, "drift and jitter of the written poses");
    options.choice("--color-noise", options_.color_noise, kOnOff, "noise of colours");
    options.choice("--vignetting", options_.vignetting, kVignettingNames,
                   "darker corners; without it, as in the thesis' scene");
    options.choice("--auto-gain", options_.automatic_gain, kOnOff,
                   "the gain follows the image's light; without it, as in the thesis' scene");
  }

  void check(const GlobalOptions& /*global*/) override {
    if (!options_.image_size) return;
    const auto [width, height] = *options_.image_size;
    if (std::min(width, height) < kSmallestEdge_px || std::max(width, height) > kLargestEdge_px) {
      usage_error("--image-size", "sizes are within 16 and 2048 pixels");
    }
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    const Executor& executor = context.executor();
    SACCADE_TRY(Sequence sequence, sequence_of(options_, context.seed()));
    SACCADE_TRY(const RayScene rays, RayScene::build(sequence.scene));
    SACCADE_TRY(RenderedSequence camera,
                RenderedSequence::create(rays, sequence.true_poses, sequence.config, executor));
    const std::size_t frames = sequence.true_poses.size();
    SACCADE_CHECK(context.open_folder());
    const RunFolder& out = *context.folder();
    SACCADE_CHECK(remove_earlier(out));
    json written = document(sequence, context.seed(), camera.segments().names());
    SACCADE_CHECK(write_json(out / kDocument, written));
    SACCADE_CHECK(write_json(out / kCamera, camera_to_json(sequence.config.camera)));
    std::vector<double> render_ms;
    std::vector<double> write_ms;
    std::vector<double> gains;
    std::vector<Pose> true_poses;
    const std::size_t at_once = std::max<std::size_t>(1, executor.threads());
    while (true_poses.size() < frames && !interrupted()) {
      std::vector<Shot> shots;
      const std::size_t wanted = std::min(at_once, frames - true_poses.size());
      while (shots.size() < wanted && !interrupted()) {
        context.bar().update("rendering", true_poses.size(), frames);
        const Stopwatch rendering;
        SACCADE_TRY(std::optional<Frame> frame, camera.next());
        render_ms.push_back(rendering.elapsed_ms());
        shots.push_back({std::move(*frame), camera.truth().label});
        true_poses.push_back(camera.truth().T_world_camera);
        gains.push_back(camera.truth().gain);
      }
      const Stopwatch writing;
      SACCADE_CHECK(write_shots(out, shots, executor));
      write_ms.push_back(writing.elapsed_ms() / static_cast<double>(std::max<std::size_t>(1, shots.size())));
    }
    if (!true_poses.empty()) SACCADE_CHECK(write_matrices(out / kTruePoses, true_poses));
    written["frames"] = true_poses.size();
    written["complete"] = true_poses.size() == frames;
    if (sequence.config.color.automatic_gain) written["gains"] = gains;
    SACCADE_CHECK(write_json(out / kDocument, written));
    json result{
        {"out", context.out().string()},
        {"scene", sequence.scene.name},
        {"switches", sequence.switches},
        {"frames", true_poses.size()},
        {"segments", camera.segments().names().size() - 1},
        {"interrupted", interrupted()},
        {"ms_per_frame", {{"render", {{"median", median(render_ms)}}}, {"write", {{"median", median(write_ms)}}}}}};
    std::ostringstream text;
    text << true_poses.size() << " frames with " << result["segments"] << " true segments in " << context.out().string()
         << '\n';
    Outcome outcome{.result = std::move(result), .text = text.str()};
    if (true_poses.size() < frames) {
      outcome.cut_short = "interrupted after " + std::to_string(true_poses.size()) + " of " + std::to_string(frames) +
                          " frames; they are in " + context.out().string();
    }
    return outcome;
  }

 private:
  SequenceOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_scene_sequence() { return std::make_unique<SceneSequence>(); }

}  // namespace saccade::cli
