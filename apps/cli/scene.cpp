// SPDX-License-Identifier: Apache-2.0
// saccade scene list|render|export, scan and sequence: the scenes there are, a picture of one, and its truth for others
// to check against.
#include <array>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "context.hpp"
#include "interrupt.hpp"
#include "length_options.hpp"
#include "run_options.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/viewpoint.hpp"
#include "saccade/scene/rendered_sequence.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/scene/surface_samples.hpp"
#include "saccade/trial/metrics.hpp"
#include "scene_scan.hpp"
#include "scene_sequence.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> kExportFiles{"scene.json", "true_mesh.ply", "surface.ply", "scene.png"};

constexpr const char* kSceneHelp{
    "name of a built-in scene, clutter:SEED, room:SEED, street:SEED, a YAML file, or a mesh file"};

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

class SceneList final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "list", .description = "the built-in scenes", .result_name = "scene"};
  }

  [[nodiscard]] Result<Outcome> run(Context& /*context*/) override {
    json scenes = json::array();
    std::ostringstream text;
    text << std::left;
    for (const BuiltinScene& builtin : builtin_scenes()) {
      SACCADE_TRY(const Scene scene, parse_scene(builtin.yaml));
      scenes.push_back({{"name", builtin.name}, {"objects", scene.objects.size()}, {"regions", scene.regions.size()}});
      text << std::setw(16) << builtin.name << scene.objects.size() << " objects\n";
    }
    for (const std::string_view name : kSurfelScenes) {
      SACCADE_TRY(const SurfelScene made, surfel_scene(name));
      const std::size_t segments = SegmentTable{made.scene}.names().size() - 1;
      scenes.push_back(
          {{"name", name}, {"objects", made.scene.objects.size()}, {"regions", 0}, {"segments", segments}});
      text << std::setw(16) << name << segments << " segments, for surfels\n";
    }
    text << "clutter:SEED    eight random objects\nroom:SEED       a furnished room, for scans\n"
            "street:SEED     a street between houses, for scans\nFILE            a scene of your own: YAML, or a mesh "
            "on a table\n";
    return Outcome{.result = {{"scenes", std::move(scenes)}}, .text = text.str()};
  }
};

class SceneRender final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "render", .description = "a picture of a scene", .result_name = "scene"};
  }

  void declare(Options& options) override {
    options.value("scene", scene_, "SCENE", kSceneHelp).required();
    options.value("--out", out_, "FILE", "the picture, PNG").required();
    options.value("--image-size", image_size_, "W,H", "width and height of the picture, pixels").delimiter(',');
  }

  void check(const GlobalOptions& /*global*/) override {
    if (!image_size_) return;
    const auto [width, height] = *image_size_;
    if (std::min(width, height) < 16 || std::max(width, height) > 8192) {
      usage_error("--image-size", "sizes are within 16 and 8192 pixels");
    }
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_TRY(Scene scene, find_scene(scene_));
    SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
    const auto [width, height] = image_size_.value_or(std::pair{960, 720});
    SACCADE_CHECK(write_png(out_, picture_of(rays, width, height, context.executor())));
    return Outcome{.result = scene_json(rays), .text = out_.string() + "\n"};
  }

 private:
  std::string scene_;
  std::filesystem::path out_;
  std::optional<std::pair<int, int>> image_size_;
};

/// Refuses a spacing at which the points of a large scene would not fit into memory.
Status check_points(const RayScene& rays, double spacing_m) {
  constexpr double kMostPoints{2e7};
  const double area_m2 = surface_area_m2(rays.meshes(), rays.scene().workspace);
  const double points = area_m2 / (spacing_m * spacing_m);
  if (points <= kMostPoints) return {};
  const double fitting_m = 0.001 * std::ceil(1000.0 * std::sqrt(area_m2 / kMostPoints));
  return Error{Errc::invalid_argument,
               fixed(area_m2, 0) + " m² of surface have " + fixed(1e-6 * points, 0) +
                   " million points at a spacing of " + millimetres(spacing_m) +
                   ", and 20 million are the most; --spacing " + fixed(fitting_m, 3) + " would do",
               rays.scene().name};
}

class SceneExport final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "export",
            .description = "the true mesh, labels and observable surface, as PLY",
            .result_name = "scene"};
  }

  void declare(Options& options) override {
    options.value("scene", scene_, "SCENE", kSceneHelp).required();
    options.folder({.help = "folder for the results; made if it is not there",
                    .files = {kExportFiles.begin(), kExportFiles.end()},
                    .marker = kExportFiles.front(),
                    .required = true});
    options.flag("--no-pictures{false}", pictures_, "draw no picture");
    add_mesh_options(options.group(), mesh_);
    options.value("--spacing", spacing_m_, "METRES",
                  "distance between points of the surface, metres; the default is explore's");
  }

  void check(const GlobalOptions& /*global*/) override {
    require_ok(mesh_.validate(), "--mesh-scale");
    require_length(spacing_m_, "--spacing");
    if (spacing_m_ < 1e-4) usage_error("--spacing", "must be 0.0001 at least");
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    const Executor& executor = context.executor();
    const RunFolder& out = *context.folder();
    SACCADE_TRY(Scene scene, find_scene(scene_, mesh_));
    SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
    SACCADE_CHECK(check_points(rays, spacing_m_));
    context.bar().update("sampling the surface", 0, 2);
    const SurfaceSamples samples = sample_surfaces(rays.meshes(), spacing_m_, rays.scene().workspace);
    context.bar().update("finding what can be seen", 1, 2);
    Progress cancel;
    const CancelOnInterrupt guard{cancel};
    const std::vector<std::uint8_t> seen = observable(rays, samples, {}, executor, cancel);
    if (cancel.cancelled()) return Error{Errc::cancelled, "interrupted; nothing was written", context.out().string()};
    SACCADE_CHECK(write_true_mesh(out / "true_mesh.ply", rays));
    SACCADE_CHECK(write_surface(out / "surface.ply", samples, seen));
    if (pictures_) SACCADE_CHECK(write_png(out / "scene.png", picture_of(rays, 960, 720, executor)));
    json result = scene_json(rays);
    const auto observed = std::accumulate(seen.begin(), seen.end(), std::size_t{0});
    result["surface"] = {{"spacing_m", spacing_m_}, {"points", seen.size()}, {"observable", observed}};
    SACCADE_CHECK(write_json(out / "scene.json", result));
    return Outcome{.result = std::move(result),
                   .text = std::to_string(observed) + " of " + std::to_string(seen.size()) +
                           " surface points can be seen; results in " + context.out().string() + "\n"};
  }

 private:
  std::string scene_;
  MeshSceneConfig mesh_;
  double spacing_m_{kTruthSpacing_m};
  bool pictures_{true};
};

class SceneCommands final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"scene", "lists, draws and exports scenes for simulated cameras"};
  }
  [[nodiscard]] std::vector<std::unique_ptr<Command>> parts() const override {
    std::vector<std::unique_ptr<Command>> parts;
    parts.push_back(std::make_unique<SceneList>());
    parts.push_back(std::make_unique<SceneRender>());
    parts.push_back(make_scene_sequence());
    parts.push_back(make_scene_scan());
    parts.push_back(std::make_unique<SceneExport>());
    return parts;
  }
};

}  // namespace

void add_scene(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<SceneCommands>(program, global, action);
}

}  // namespace saccade::cli
