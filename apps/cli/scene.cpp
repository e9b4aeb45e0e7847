// SPDX-License-Identifier: Apache-2.0
// saccade scene list|render|export, and sequence: the scenes there are, a picture of one, and its truth for others to
// check against.
#include <CLI/CLI.hpp>
#include <array>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numeric>

#include "command.hpp"
#include "exit_status.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/viewpoint.hpp"
#include "saccade/scene/rendered_sequence.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/scene/surface_samples.hpp"
#include "saccade/trial/metrics.hpp"
#include "scene_sequence.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> kExportFiles{"scene.json", "true_mesh.ply", "surface.ply", "scene.png"};

struct SceneOptions {
  std::string scene;
  std::filesystem::path out;
  double spacing_m{kTruthSpacing_m};
  std::optional<std::pair<int, int>> image_size;
  bool force{false};
};

json scene_json(const RayScene& rays) {
  json objects = json::array();
  for (const SceneObject& object : rays.scene().objects) {
    objects.push_back({{"name", object.name},
                       {"label", objects.size()},
                       {"support", object.support},
                       {"T_world_object", pose_to_json(object.T_world_object)},
                       {"triangles", rays.meshes()[objects.size()].mesh.triangles.size()}});
  }
  const Box& workspace = rays.scene().workspace;
  return {{"scene", rays.scene().name},
          {"workspace", {{"min_m", point_json(workspace.min)}, {"max_m", point_json(workspace.max)}}},
          {"regions", rays.scene().regions.size()},
          {"scan_poses", rays.scene().scan.size()},
          {"objects", std::move(objects)}};
}

/// The scene as the simulated camera sees it, from an overview, four rays per pixel.
ColorImage picture_of(const RayScene& rays, int width, int height, const Executor& executor) {
  constexpr int kRaysAcross{2};
  constexpr Rgb8 kBackground{236, 239, 243};
  OverviewConfig overview;
  overview.width = kRaysAcross * width;
  overview.height = kRaysAcross * height;
  Viewpoint view = overview_of(rays.scene().workspace, overview);
  view.camera.min_range_m = 0.01;
  view.camera.max_range_m = 100.0;
  const ExactFrame frame = rays.render(view.camera, view.T_world_camera, executor);
  ColorImage picture{width, height};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      std::array<int, 3> sum{};
      for (int k = 0; k < kRaysAcross * kRaysAcross; ++k) {
        const int fine_u = kRaysAcross * u + k % kRaysAcross;
        const int fine_v = kRaysAcross * v + k / kRaysAcross;
        const Rgb8& color = frame.object(fine_u, fine_v) < 0 ? kBackground : frame.color(fine_u, fine_v);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        picture(u, v)[c] = static_cast<std::uint8_t>(sum[c] / (kRaysAcross * kRaysAcross));
      }
    }
  }
  return picture;
}

/// All objects in one mesh, the object's index at every vertex.
Status write_true_mesh(const std::filesystem::path& path, const RayScene& rays) {
  TriangleMesh all;
  std::vector<std::int32_t> labels;
  for (std::size_t i = 0; i < rays.meshes().size(); ++i) {
    const TriangleMesh& mesh = rays.meshes()[i].mesh;
    const auto offset = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    if (mesh.colors.empty()) {
      all.colors.insert(all.colors.end(), mesh.vertices.size(), rays.scene().objects[i].color);
    } else {
      all.colors.insert(all.colors.end(), mesh.colors.begin(), mesh.colors.end());
    }
    for (const auto& [a, b, c] : mesh.triangles) all.triangles.push_back({a + offset, b + offset, c + offset});
    labels.insert(labels.end(), mesh.vertices.size(), static_cast<std::int32_t>(i));
  }
  return write_mesh(path, all, PlyFormat::binary_little_endian, labels);
}

Status write_surface(const std::filesystem::path& path, const SurfaceSamples& samples,
                     const std::vector<std::uint8_t>& seen) {
  ColumnTable table;
  const auto add = [&table](const char* name, const std::vector<Eigen::Vector3f>& vectors, Eigen::Index k) {
    std::vector<float> values;
    for (const Eigen::Vector3f& v : vectors) values.push_back(v[k]);
    table.add<float>(name, values);
  };
  constexpr std::array<const char*, 3> kPoint{"x", "y", "z"};
  constexpr std::array<const char*, 3> kNormal{"nx", "ny", "nz"};
  for (Eigen::Index k = 0; k < 3; ++k) add(kPoint[static_cast<std::size_t>(k)], samples.points, k);
  for (Eigen::Index k = 0; k < 3; ++k) add(kNormal[static_cast<std::size_t>(k)], samples.normals, k);
  const std::vector<std::int32_t> labels{samples.objects.begin(), samples.objects.end()};
  table.add<std::int32_t>("label", labels);
  table.add<std::uint8_t>("observable", seen);
  return write_ply(path, table);
}

Status finish(const GlobalOptions& global, const Executor& executor, const Stopwatch& stopwatch, json result) {
  return write_result("scene", global, executor, {{"total", stopwatch.elapsed_ms()}}, std::move(result));
}

Result<int> run_list(const GlobalOptions& global) {
  const Stopwatch stopwatch;
  json scenes = json::array();
  for (const BuiltinScene& builtin : builtin_scenes()) {
    SACCADE_TRY(const Scene scene, parse_scene(builtin.yaml));
    scenes.push_back({{"name", builtin.name}, {"objects", scene.objects.size()}, {"regions", scene.regions.size()}});
    if (!global.json_to_stdout()) {
      std::cout << std::left << std::setw(16) << builtin.name << scene.objects.size() << " objects\n";
    }
  }
  for (const std::string_view name : kSurfelScenes) {
    SACCADE_TRY(const SurfelScene made, surfel_scene(name));
    const std::size_t segments = SegmentTable{made.scene}.names().size() - 1;
    scenes.push_back({{"name", name}, {"objects", made.scene.objects.size()}, {"regions", 0}, {"segments", segments}});
    if (!global.json_to_stdout()) {
      std::cout << std::left << std::setw(16) << name << segments << " segments, for surfels\n";
    }
  }
  if (!global.json_to_stdout())
    std::cout << "clutter:SEED    eight random objects\nFILE            a scene of your own\n";
  SACCADE_CHECK(finish(global, global.executor(), stopwatch, {{"scenes", std::move(scenes)}}));
  return static_cast<int>(ExitStatus::done);
}

Result<int> run_render(const SceneOptions& options, const GlobalOptions& global) {
  const Stopwatch stopwatch;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(Scene scene, find_scene(options.scene));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  const auto [width, height] = options.image_size.value_or(std::pair{960, 720});
  SACCADE_CHECK(write_png(options.out, picture_of(rays, width, height, executor)));
  SACCADE_CHECK(finish(global, executor, stopwatch, scene_json(rays)));
  if (!global.json_to_stdout()) std::cout << options.out.string() << '\n';
  return static_cast<int>(ExitStatus::done);
}

Result<int> run_export(const SceneOptions& options, const GlobalOptions& global) {
  const Stopwatch stopwatch;
  const Executor executor = global.executor();
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(Scene scene, find_scene(options.scene));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  SACCADE_TRY(const RunFolder out, RunFolder::open(options.out, kExportFiles, "scene.json", options.force));
  ProgressBar bar{global.quiet};
  bar.update("sampling the surface", 0, 2);
  const SurfaceSamples samples = sample_surfaces(rays.meshes(), options.spacing_m, rays.scene().workspace);
  bar.update("finding what can be seen", 1, 2);
  const std::vector<std::uint8_t> seen = observable(rays, samples, {}, executor);
  bar.finish();
  SACCADE_CHECK(write_true_mesh(out / "true_mesh.ply", rays));
  SACCADE_CHECK(write_surface(out / "surface.ply", samples, seen));
  SACCADE_CHECK(write_png(out / "scene.png", picture_of(rays, 960, 720, executor)));
  json result = scene_json(rays);
  result["surface"] = {{"spacing_m", options.spacing_m},
                       {"points", seen.size()},
                       {"observable", std::accumulate(seen.begin(), seen.end(), std::size_t{0})}};
  SACCADE_CHECK(write_json(out / "scene.json", result));
  if (!global.json_to_stdout()) {
    std::cout << result["surface"]["observable"] << " of " << seen.size() << " surface points can be seen; results in "
              << options.out.string() << '\n';
  }
  SACCADE_CHECK(finish(global, executor, stopwatch, std::move(result)));
  return static_cast<int>(ExitStatus::done);
}

}  // namespace

void add_scene(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("scene", "lists, draws and exports scenes for simulated cameras");
  command->require_subcommand(1);
  CLI::App* list = command->add_subcommand("list", "the built-in scenes");
  list->callback([&global, &action] { action = [&global] { return run_list(global); }; });

  auto options = std::make_shared<SceneOptions>();
  const auto add_common = [&options](CLI::App* sub, const char* out, const char* type) {
    sub->add_option("scene", options->scene, "name of a built-in scene, clutter:SEED, or a YAML file")
        ->required()
        ->type_name("SCENE");
    sub->add_option("--out", options->out, out)->required()->type_name(type);
  };
  CLI::App* render = command->add_subcommand("render", "a picture of a scene");
  add_common(render, "the picture, PNG", "FILE");
  render->add_option("--image-size", options->image_size, "width and height of the picture, pixels")
      ->delimiter(',')
      ->type_name("W,H");
  render->callback([options, &global, &action] {
    if (options->image_size) {
      const auto [width, height] = *options->image_size;
      if (std::min(width, height) < 16 || std::max(width, height) > 8192) {
        usage_error("--image-size", "sizes are within 16 and 8192 pixels");
      }
    }
    action = [options, &global] { return run_render(*options, global); };
  });

  add_scene_sequence(*command, global, action);

  CLI::App* truth = command->add_subcommand("export", "the true mesh, labels and observable surface, as PLY");
  add_common(truth, "folder for the results; made if it is not there", "DIR");
  truth
      ->add_option("--spacing", options->spacing_m,
                   "distance between points of the surface, metres; the default is explore's")
      ->type_name("METRES")
      ->capture_default_str();
  truth->add_flag("--force", options->force, "write into a folder that holds other files");
  truth->callback([options, &global, &action] {
    require_positive(options->spacing_m, "--spacing");
    if (options->spacing_m < 1e-4) usage_error("--spacing", "must be 0.0001 at least");
    action = [options, &global] { return run_export(*options, global); };
  });
}

}  // namespace saccade::cli
