// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/benchmark.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/names.hpp"
#include "saccade/core/nearest_word.hpp"
#include "saccade/trial/benchmark_objects.hpp"
#include "saccade/views/fixed_views.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kAnyGain{1e-9};    // a protocol ends a run after its number of views, no threshold before
constexpr double kShellStart{2.5};  // distance of the first view, in object radii
constexpr double kShellInner{2.0};  // half edge of the cube without views
constexpr double kShellOuter{4.0};  // radius of the sphere of views
constexpr double kHemisphere_m{0.4};
constexpr double kWall_m{1.5};  // something to look at beside an object, so that rays past it show empty space

SceneObject slab(std::string name, const Vector3d& size_m, const Vector3d& at) {
  SceneObject part;
  part.name = std::move(name);
  part.shape = BoxShape{size_m};
  part.T_world_object.translation() = at;
  part.color = {205, 205, 198};
  part.support = true;
  part.fixture = true;  // a camera that flies stays in the room
  return part;
}

/// @param floor_m  height of the floor
void add_room(Scene& scene, double floor_m) {
  constexpr double kThick_m{0.05};
  const double wide_m = 2.0 * (kWall_m + kThick_m);
  const double beside_m = kWall_m + 0.5 * kThick_m;
  const double bottom_m = -kWall_m - kThick_m;  // solid all the way down: there is no place under a table
  scene.objects.push_back(slab("floor", {wide_m, wide_m, floor_m - bottom_m}, {0.0, 0.0, bottom_m}));
  scene.objects.push_back(slab("ceiling", {wide_m, wide_m, kThick_m}, {0.0, 0.0, kWall_m}));
  for (const double side : {-1.0, 1.0}) {
    const std::string which = side < 0.0 ? "-low" : "-high";
    scene.objects.push_back(
        slab("wall-x" + which, {kThick_m, wide_m, 2.0 * kWall_m}, {side * beside_m, 0.0, -kWall_m}));
    scene.objects.push_back(
        slab("wall-y" + which, {wide_m, kThick_m, 2.0 * kWall_m}, {0.0, side * beside_m, -kWall_m}));
  }
}

Eigen::AlignedBox3d bounds_of_bodies(const std::vector<TriangleMesh>& bodies) {
  Eigen::AlignedBox3d bounds;
  for (const TriangleMesh& body : bodies) {
    for (const Eigen::Vector3f& p : body.vertices) bounds.extend(p.cast<double>());
  }
  return bounds;
}

/// Puts the middle of the object at the origin, and scales it where the protocol does.
void place(std::vector<TriangleMesh>& bodies, const Benchmark& benchmark, bool scaled) {
  const Vector3d middle = bounds_of_bodies(bodies).center();
  double farthest = 0.0;
  for (const TriangleMesh& body : bodies) {
    for (const Eigen::Vector3f& p : body.vertices) farthest = std::max(farthest, (p.cast<double>() - middle).norm());
  }
  const double scale = scaled && farthest > 0.0 ? benchmark.object_radius_m / farthest : 1.0;
  for (TriangleMesh& body : bodies) {
    for (Eigen::Vector3f& p : body.vertices) p = (scale * (p.cast<double>() - middle)).cast<float>();
  }
}

Result<Scene> scene_of(BenchmarkObject object, const Benchmark& benchmark, bool scaled) {
  for (const TriangleMesh& body : object.bodies) {
    const auto finite = [](const Eigen::Vector3f& p) { return p.allFinite(); };
    if (!std::all_of(body.vertices.begin(), body.vertices.end(), finite)) {
      return Error{Errc::corrupt_data, "a coordinate of the mesh is not finite", object.name};
    }
  }
  place(object.bodies, benchmark, scaled);
  const Eigen::AlignedBox3d bounds = bounds_of_bodies(object.bodies);
  Scene scene;
  scene.name = object.name;
  const double reach_m = std::max(0.15, bounds.max().cwiseAbs().maxCoeff() + 0.05);
  scene.workspace = Box{Vector3d::Constant(-reach_m), Vector3d::Constant(reach_m)};
  double floor_m = -kWall_m;
  if (benchmark.on_table) {  // a table as wide as the room, so that a camera that flies stays above it
    constexpr double kAround_m{
        0.15};  // table in the workspace beside the object, so that it is found as the objects' support
    floor_m = bounds.min().z();
    const double beside_m = reach_m + kAround_m;
    scene.workspace = Box{{-beside_m, -beside_m, floor_m - 0.03}, {beside_m, beside_m, reach_m}};
  }
  add_room(scene, floor_m);
  for (std::size_t i = 0; i < object.bodies.size(); ++i) {
    SceneObject body;
    body.name = "body-" + std::to_string(i + 1);
    body.shape = MeshShape{std::move(object.bodies[i])};
    body.color = {198, 140, 82};
    scene.objects.push_back(std::move(body));
  }
  return scene;
}

/// Returns the candidates of a protocol, none where every strategy has its own.
Result<std::vector<Pose>> candidates_of(const Benchmark& benchmark) {
  if (benchmark.views == ViewSpace::own) return std::vector<Pose>{};
  if (benchmark.views == ViewSpace::hemisphere) {
    return hemisphere_views(Vector3d::Zero(), kHemisphere_m, benchmark.candidates);
  }
  const double radius_m = benchmark.object_radius_m;
  SACCADE_TRY(std::vector<Pose> views, shell_views(Vector3d::Zero(), {.inner_half_edge_m = kShellInner * radius_m,
                                                                      .outer_radius_m = kShellOuter * radius_m,
                                                                      .count = benchmark.candidates}));
  views.front() = look_at({-kShellStart * radius_m, 0.0, 0.0}, Vector3d::Zero());
  return views;
}

/// A first view of an object, and its name where there are several.
struct Start {
  std::string name;
  Pose T_world_camera;
};

std::vector<Start> starts_of(const Benchmark& benchmark, const std::vector<Pose>& candidates) {
  if (candidates.empty()) return {{"", look_at({-0.75, 0.0, 0.3}, Vector3d::Zero())}};
  if (benchmark.starts == 1) return {{"", candidates.front()}};
  std::vector<Start> starts;
  for (std::size_t i = 0; i < benchmark.starts; ++i) {
    const std::size_t view = (2 * i + 1) * candidates.size() / (2 * benchmark.starts);
    starts.push_back({std::string{"@"} + std::to_string(view), candidates[view]});
  }
  return starts;
}

SimulatedRunConfig run_of(const Benchmark& benchmark, std::vector<Pose> candidates) {
  SimulatedRunConfig run;
  run.noise = benchmark.noise;
  if (benchmark.has_own_scenes()) {
    run.exploration.max_views = static_cast<int>(benchmark.budget);
    return run;
  }
  run.camera = benchmark.camera;
  run.voxel_size_m = benchmark.voxel_size_m;
  run.exploration.max_views = static_cast<int>(benchmark.views_in_all) - 1;
  run.exploration.oscillation_frames = 1;
  run.exploration.oscillation_rad = 0.0;
  run.contours.known_weight = 1;  // the only frame of a view makes known what it shows
  run.planner.min_gain = kAnyGain;
  run.least_share = 0.0;
  if (!candidates.empty()) run.fixed_views = std::make_shared<const std::vector<Pose>>(std::move(candidates));
  return run;
}

/// Puts each object into its scenes, one for each first view.
Result<BenchmarkPlan> plan_of(const Benchmark& benchmark, std::vector<BenchmarkObject> found, ObjectSource source) {
  BenchmarkPlan plan;
  plan.objects = source;
  SACCADE_TRY(std::vector<Pose> candidates, candidates_of(benchmark));
  const std::vector<Start> starts = starts_of(benchmark, candidates);
  for (BenchmarkObject& object : found) {
    SACCADE_TRY(const Scene scene,
                scene_of(std::move(object), benchmark, source == ObjectSource::stand_ins || !benchmark.true_size));
    for (const Start& start : starts) {
      plan.scenes.push_back(scene);
      plan.scenes.back().name += start.name;
      plan.scenes.back().scan = {start.T_world_camera};
    }
  }
  plan.run = run_of(benchmark, std::move(candidates));
  return plan;
}

}  // namespace

Result<Benchmark> find_benchmark(std::string_view name) {
  std::vector<std::string_view> known;
  for (const Benchmark& benchmark : benchmarks()) {
    if (benchmark.name == name) return benchmark;
    known.emplace_back(benchmark.name);
  }
  return Error{Errc::invalid_argument,
               "there is no benchmark \"" + std::string{name} +
                   "\"; known: " + joined(benchmarks(), ", ", &Benchmark::name) + did_you_mean(name, known),
               ""};
}

bool has_same_object(const Benchmark& benchmark, const BenchmarkPlan& plan, const PublishedFigure& figure) {
  if (plan.objects != ObjectSource::published || !figure.measured) return false;
  return std::all_of(plan.scenes.begin(), plan.scenes.end(), [&](const Scene& scene) {
    const std::string name = scene.name.substr(0, benchmark.starts > 1 ? scene.name.rfind('@') : std::string::npos);
    return std::any_of(benchmark.meshes.begin(), benchmark.meshes.end(), [&](const BenchmarkMesh& mesh) {
      return mesh.object == *figure.measured && std::filesystem::path{mesh.file}.stem() == name;
    });
  });
}

Result<BenchmarkPlan> plan_benchmark(const Benchmark& benchmark, const std::optional<std::filesystem::path>& objects) {
  if (benchmark.has_own_scenes()) {
    BenchmarkPlan plan;
    if (objects) SACCADE_CHECK(read_objects(benchmark, *objects));
    for (const std::string& name : benchmark.scenes) {
      SACCADE_TRY(Scene scene, find_scene(name));
      plan.scenes.push_back(std::move(scene));
    }
    plan.run = run_of(benchmark, {});
    return plan;
  }
  SACCADE_TRY(std::vector<BenchmarkObject> found,
              objects ? read_objects(benchmark, *objects) : stand_ins_of(benchmark));
  return plan_of(benchmark, std::move(found), objects ? ObjectSource::published : ObjectSource::stand_ins);
}

Result<BenchmarkPlan> plan_benchmark(const Benchmark& benchmark, std::span<const std::filesystem::path> own_meshes,
                                     const MeshSceneConfig& config) {
  SACCADE_TRY(std::vector<BenchmarkObject> found, read_own_objects(benchmark, own_meshes, config));
  return plan_of(benchmark, std::move(found), ObjectSource::own);
}

Result<std::vector<BenchmarkCurve>> measure_benchmark(const Benchmark& benchmark, const RayScene& scene,
                                                      const SimulatedRunConfig& run,
                                                      std::span<const std::vector<Pose>> views,
                                                      const Executor& executor) {
  SACCADE_EXPECTS(benchmark.rule.has_value());
  std::span<const Pose> candidates;
  if (run.fixed_views) candidates = *run.fixed_views;
  SACCADE_TRY(const SurfaceCoverage surface,
              SurfaceCoverage::build(scene, run.camera, candidates, *benchmark.rule, executor));
  std::vector<BenchmarkCurve> curves;
  for (const std::vector<Pose>& taken : views) {
    std::vector<Pose> all = scene.scene().scan;
    all.insert(all.end(), taken.begin(), taken.end());
    BenchmarkCurve curve{surface.along(all, executor), all.size()};
    while (curve.after.size() < benchmark.views_in_all) curve.after.push_back(curve.after.back());
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace saccade
