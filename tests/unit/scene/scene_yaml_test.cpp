// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene_yaml.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/scene/surface_samples.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

const std::string kHead{"scene: test\nworkspace: {min: [-1, -1, 0], max: [1, 1, 1]}\nobjects:\n"};
const std::string kBall{"  - {name: ball, at: [0, 0, 0], sphere: {radius: 0.1}}\n"};

void expect_refused(const std::string& yaml, const std::string& part, Errc code = Errc::corrupt_data) {
  const auto scene = parse_scene(yaml);
  ASSERT_FALSE(scene) << yaml;
  EXPECT_EQ(scene.error().code, code) << scene.error().to_string();
  EXPECT_NE(scene.error().to_string().find(part), std::string::npos) << scene.error().to_string();
  EXPECT_EQ(scene.error().to_string().find('\n'), std::string::npos);
}

TEST(SceneYaml, PlacesBeyondAKilometreAreRefused) {
  for (const std::string far : {"1e20", "-1001", "1e300"}) {
    expect_refused("scene: test\nworkspace: {min: [-2000, -1, 0], max: [" + far + ", 1, 1]}\nobjects:\n" + kBall,
                   "the workspace");
    expect_refused(kHead + "  - {name: ball, at: [0, " + far + ", 0], sphere: {radius: 0.1}}\n", "an object");
    expect_refused(kHead + kBall + "scan: [{from: [0, 0, " + far + "], look_at: [0, 0, 0]}]\n", "line 5");
    expect_refused(kHead + kBall + "regions: [sphere: {center: [" + far + ", 0, 0], radius: 0.1}]\n", "a sphere");
  }
  expect_refused(kHead + kBall + "regions: [sphere: {center: [0, 0, 0], radius: 1e30}]\n", "a kilometre",
                 Errc::invalid_argument);
}

TEST(SceneYaml, ReadsEveryKey) {
  const auto scene = parse_scene(R"(
scene: all
workspace: {min: [-1, -1, 0], max: [1, 1, 1]}
max_deviation: 0.001
scan: [{from: [0, -1, 1], look_at: [0, 0, 0]}]
regions:
  - sphere: {center: [0, 0, 0.5], radius: 0.2}
  - box: {min: [0, 0, 0], max: [0.5, 0.5, 0.5]}
objects:
  - {name: a, at: [0, 0, 0], box: {size: [1, 2, 3]}, color: [1, 2, 3], support: true}
  - {name: b, at: [1, 2, 3], cylinder: {radius: 0.1, height: 0.2}, turn_deg: [0, 0, 90]}
  - {name: c, at: [0, 0, 0], cone: {radius: 0.1, height: 0.2}, texture: {kind: stripes, size: 0.5, darkening: 0.25}}
  - {name: d, at: [0, 0, 0], superquadric: {semi_axes: [0.1, 0.2, 0.3], exponents: [0.5, 1.5]}}
  - {name: e, at: [0, 0, 0], revolution: {profile: [[0.1, 0], [0.2, 0.3]], wall: 0.01}}
  - {name: f, at: [0, 0, 0], jug: {profile: [[0.06, 0], [0.06, 0.2]], wall: 0.005, handle_heights: [0.04, 0.16],
     handle_reach: 0.05, handle_radius: 0.008}}
)");
  ASSERT_TRUE(scene) << scene.error().to_string();
  ASSERT_EQ(scene->objects.size(), 6U);
  EXPECT_EQ(std::get<BoxShape>(scene->objects[0].shape).size_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(scene->objects[0].support);
  EXPECT_EQ(scene->objects[0].color, (Rgb8{1, 2, 3}));
  EXPECT_TRUE((scene->objects[1].T_world_object * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3)));
  EXPECT_EQ(scene->objects[2].texture.kind, Texture::Kind::stripes);
  EXPECT_EQ(scene->objects[2].texture.size_m, 0.5);
  EXPECT_EQ(scene->objects[2].texture.darkening, 0.25);
  EXPECT_EQ(std::get<SuperquadricShape>(scene->objects[3].shape).horizontal_exponent, 1.5);
  EXPECT_EQ(std::get<RevolutionShape>(scene->objects[4].shape).profile_m[1].y(), 0.3);
  EXPECT_EQ(std::get<JugShape>(scene->objects[5].shape).handle_top_m, 0.16);
  EXPECT_EQ(scene->regions.size(), 2U);
  EXPECT_EQ(scene->scan.size(), 1U);
  EXPECT_EQ(scene->max_deviation_m, 0.001);
}

TEST(SceneYaml, SaysWhatIsWrongAndWhere) {
  expect_refused(kHead + "  - {name: ball, at: [0, 0, 0], sphere: {radius: 0.1}, colour: [1, 2, 3]}\n",
                 "line 4, column 56: unknown key colour in an object; known here: at, box, color");
  expect_refused(kHead + "  - {name: ball, at: [0, 0, 0], sphere: {radius: 0.1, r: 1}}\n", "unknown key r in a sphere");
  expect_refused(kHead + kBall + "lights: 3\n", "line 5, column 1: unknown key lights in a scene");
  expect_refused(kHead + "  - {name: ball, sphere: {radius: 0.1}}\n", "an object needs the key at");
  expect_refused(kHead + "  - {name: ball, at: [0, 0, 0]}\n", "an object needs a shape: box, cylinder");
  expect_refused(kHead + "  - {name: b, at: [0, 0, 0], sphere: {radius: 1}, box: {size: [1, 1, 1]}}\n", "one shape");
  expect_refused(kHead + "  - {name: ball, at: [0, 0], sphere: {radius: 0.1}}\n", "expected a list of 3 numbers");
  expect_refused(kHead + "  - {name: ball, at: [0, 0, .nan], sphere: {radius: 0.1}}\n", "expected a number");
  expect_refused(kHead + "  - {name: ball, name: ball}\n", "the key name is there twice");
  expect_refused(kHead + "  - {name: a, at: [0, 0, 0], sphere: {radius: 1}, texture: {kind: wood}}\n",
                 "a texture is plain");
  expect_refused(kHead + "  - {name: a, at: [0, 0, 0], sphere: {radius: 1}, color: [1, 2, 300]}\n", "from 0 to 255");
  expect_refused("objects: [\n", "not valid YAML");
  expect_refused("", "a scene is a list of \"key: value\"");
  expect_refused("- 1\n- 2\n", "a scene is a list of \"key: value\"");
  expect_refused("scene: a\nworkspace: {min: [0, 0, 0], max: [1, 1, 0]}\nobjects:\n" + kBall, "workspace is empty",
                 Errc::invalid_argument);
  expect_refused(kHead + "  - {name: ball, at: [0, 0, 0], sphere: {radius: -0.1}}\n", "object ball",
                 Errc::invalid_argument);
  expect_refused(kHead + "  - {name: cup, at: [0, 0, 0], mesh: {path: nowhere.stl}}\n",
                 "nowhere.stl: there is no such mesh", Errc::not_found);
}

TEST(SceneYaml, FilesAreNamedInErrors) {
  const TempFolder folder;
  const fs::path path = folder / "scene.yaml";
  std::ofstream{path} << kHead << "  - {name: ball}\n";
  const auto scene = find_scene(path.string());
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().context, path.string() + ", line 4, column 5");
  const auto unknown = find_scene("atrium");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Errc::not_found);
  EXPECT_NE(unknown.error().message.find("tabletop-1"), std::string::npos);
  EXPECT_FALSE(find_scene("clutter:many"));
}

TEST(SceneYaml, BuiltinScenesAreThere) {
  std::vector<std::string> names;
  for (const BuiltinScene& builtin : builtin_scenes()) {
    names.emplace_back(builtin.name);
    const auto scene = parse_scene(builtin.yaml);
    ASSERT_TRUE(scene) << builtin.name << ": " << scene.error().to_string();
    EXPECT_EQ(scene->name, builtin.name);
    EXPECT_GE(scene->scan.size(), 1U) << builtin.name;
    EXPECT_TRUE(RayScene::build(*scene)) << builtin.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"bottle-before", "bottle", "jug-before", "jug", "tabletop-1", "tabletop-2",
                                             "tabletop-3", "tabletop-4"}));
}

/// Tells whether the ray upwards leaves the only body of the scene: it then crosses its surface an odd number of times.
bool inside(const RayScene& body, Eigen::Vector3d p) {
  bool odd = false;
  for (auto hit = body.cast(p, Eigen::Vector3d::UnitZ()); hit; hit = body.cast(p, Eigen::Vector3d::UnitZ())) {
    p.z() += hit->t + 1e-6;
    odd = !odd;
  }
  return odd;
}

TEST(SceneYaml, ObjectsOfBuiltinScenesDoNotRunIntoEachOther) {
  // Bodies touch, and their edges lie in each other's faces: what counts is points below the surface, and more than a
  // few.
  constexpr float kDepth_m{0.003F};
  constexpr double kAtEdges{0.005};
  std::vector<std::string> names{"clutter:1", "clutter:2", "clutter:3"};
  for (const BuiltinScene& builtin : builtin_scenes()) names.emplace_back(builtin.name);
  for (const std::string& name : names) {
    const auto scene = find_scene(name);
    ASSERT_TRUE(scene);
    const SurfaceSamples samples = sample_surfaces(*true_meshes(*scene), 0.01, scene->workspace);
    for (const SceneObject& object : scene->objects) {
      if (object.support) continue;
      Scene alone = *scene;
      alone.objects = {object};
      const RayScene body = *RayScene::build(alone);
      std::vector<int> points(scene->objects.size());
      std::vector<int> caught(scene->objects.size());
      for (std::size_t i = 0; i < samples.points.size(); ++i) {
        ++points[samples.objects[i]];
        const Eigen::Vector3f below = samples.points[i] - kDepth_m * samples.normals[i];
        caught[samples.objects[i]] += inside(body, below.cast<double>()) ? 1 : 0;
      }
      for (std::size_t other = 0; other < points.size(); ++other) {
        if (scene->objects[other].name == object.name) continue;
        EXPECT_LE(caught[other], kAtEdges * points[other])
            << name << ": " << scene->objects[other].name << " runs into " << object.name;
      }
    }
  }
}

TEST(SceneYaml, MeshesOfSeveralFormatsAreRead) {
  const TempFolder folder;
  const TriangleMesh ball = *tessellate(SphereShape{0.1}, 1e-3);
  ASSERT_TRUE(write_mesh(folder / "ball.ply", ball));
  {
    std::ofstream obj{folder / "ball.obj"};
    for (const auto& v : ball.vertices) obj << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (const auto& t : ball.triangles) obj << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  for (const char* name : {"ball.ply", "ball.obj"}) {
    const auto scene =
        parse_scene(kHead + "  - {name: ball, at: [0, 0, 0], mesh: {path: " + name + ", scale: 2}}\n", folder / "");
    ASSERT_TRUE(scene) << scene.error().to_string();
    const auto rays = RayScene::build(*scene);
    ASSERT_TRUE(rays);
    const auto hit = rays->cast({0.01, 0.02, 2.0}, {0.0, 0.0, -1.0});
    ASSERT_TRUE(hit) << name;
    EXPECT_NEAR(hit->t, 2.0 - 0.4, 4e-3) << name;
  }
  std::ofstream{folder / "rubbish.obj"} << "nothing of the kind\n";
  EXPECT_FALSE(read_any_mesh(folder / "rubbish.obj"));
}

TEST(SceneYaml, ScannedObjectsAreRead) {
  const fs::path meshes = test::shared_data() / "meshes_ycb";
  if (!fs::exists(meshes)) GTEST_SKIP() << meshes << " is not there";
  const auto scene = parse_scene(kHead + "  - {name: mug, at: [0, 0, 0], mesh: {path: 025_mug.stl}}\n" +
                                     "  - {name: banana, at: [0.3, 0, 0], mesh: {path: 011_banana_rgb.ply}}\n",
                                 meshes);
  ASSERT_TRUE(scene) << scene.error().to_string();
  EXPECT_EQ(std::get<MeshShape>(scene->objects[0].shape).mesh.triangles.size(), 16384U);
  EXPECT_FALSE(std::get<MeshShape>(scene->objects[1].shape).mesh.colors.empty());
}

}  // namespace
}  // namespace saccade
