// SPDX-License-Identifier: Apache-2.0
#include "experiments/labelled_clouds.hpp"

#include <algorithm>
#include <array>

#include "saccade/scene/scene_yaml.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade::reproduce {
namespace {

constexpr std::array<const char*, 4> kLabelledScenes{"tabletop-1", "tabletop-2", "tabletop-3", "tabletop-4"};

/// Before the long side of a table, its whole top in view.
Pose before_table() { return look_at({0.0, -1.0, 0.75}, {0.0, 0.0, 0.05}); }

/// 1 for what objects stand on or lean at, and the following numbers for objects.
std::vector<std::uint32_t> labels_of(const Scene& scene) {
  std::vector<std::uint32_t> labels;
  std::uint32_t last{1};
  for (const SceneObject& object : scene.objects) labels.push_back(object.support ? 1 : ++last);
  return labels;
}

}  // namespace

std::size_t LabelledCloud::finite_points() const {
  return static_cast<std::size_t>(std::count_if(points.positions_m.begin(), points.positions_m.end(),
                                                [](const Eigen::Vector3f& p) { return p.allFinite(); }));
}

Result<LabelledClouds> LabelledClouds::open(const TableOptions& options) {
  LabelledClouds clouds;
  clouds.seed_ = options.seed;
  clouds.image_width_px_ = options.image_width_px;
  if (options.clouds.empty()) {
    for (const char* scene : kLabelledScenes) clouds.jobs_.emplace_back().cloud = scene;
    return clouds;
  }
  clouds.files_.cloud = options.clouds;
  clouds.files_.truth = options.clouds;
  SACCADE_TRY(cli::JobList list, plan_jobs(clouds.files_));
  clouds.jobs_ = std::move(list.jobs);
  return clouds;
}

std::string LabelledClouds::about() const {
  const std::string count = std::to_string(size());
  if (!are_made()) {
    return "On " + count + " labelled clouds in " + files_.cloud.string() +
           ", not the thesis' two, which are not published. Labels of parts of one object (mOSD's tens) are one.";
  }
  return "On " + count +
         " made clouds, one simulated frame of a Kinect v1 of each built-in tabletop, cropped to its workspace; "
         "--clouds DIR takes recorded ones (mOSD). The thesis' two clouds, fused of many frames, are not published.";
}

Result<LabelledCloud> LabelledClouds::load(std::size_t cloud, const Executor& executor) const {
  const cli::CloudJob& job = jobs_[cloud];
  if (are_made()) return make(job, executor);
  SACCADE_TRY(cli::LoadedCloud loaded, cli::load_cloud(job.cloud));
  cli::ProgressBar quiet{true};
  cli::AnnotateProgress silent{quiet, false};
  SACCADE_TRY(std::vector<std::uint32_t> truth, read_truth(files_, job, loaded.points, silent));
  return LabelledCloud{job, std::move(loaded.points), std::move(truth)};
}

Result<LabelledCloud> LabelledClouds::make(const cli::CloudJob& job, const Executor& executor) const {
  SACCADE_TRY(const Scene scene, find_scene(job.cloud.string()));
  SACCADE_TRY(const RayScene rays, RayScene::build(scene));
  SimulatedCameraConfig config;
  SACCADE_TRY(config.camera, camera_preset("kinect-v1"));
  if (image_width_px_ > 0) config.camera = config.camera.scaled_to_width(image_width_px_);
  config.noise = kinect_v1_noise(seed_);
  SACCADE_TRY(SimulatedCamera camera, SimulatedCamera::create(rays, config));
  const Pose T_world_camera = before_table();
  const Frame frame = camera.capture(T_world_camera, executor);
  const ExactFrame exact = rays.render(config.camera, T_world_camera, executor);
  const std::vector<std::uint32_t> labels = labels_of(scene);
  LabelledCloud made{job, {}, {}};
  for (int v = 0; v < config.camera.height; ++v) {
    for (int u = 0; u < config.camera.width; ++u) {
      const double depth_m = frame.depth(u, v);
      const int object = exact.object(u, v);
      const Eigen::Vector3d p_camera = depth_m * config.camera.ray(u, v);
      if (!(depth_m > 0.0) || object < 0 || !contains(scene.workspace, T_world_camera * p_camera)) continue;
      made.points.positions_m.emplace_back(p_camera.cast<float>());
      const Rgb8& color = (*frame.color)(u, v);
      made.points.colors.emplace_back(Eigen::Vector3f(color[0], color[1], color[2]) / 255.0F);
      made.truth.push_back(labels[static_cast<std::size_t>(object)]);
    }
  }
  return made;
}

}  // namespace saccade::reproduce
