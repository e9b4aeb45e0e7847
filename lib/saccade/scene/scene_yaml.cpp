// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene_yaml.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "saccade/core/angle.hpp"
#include "saccade/core/nearest_word.hpp"
#include "saccade/devices/cell.hpp"
#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/yaml_map.hpp"
#include "saccade/scene/rendered_sequence.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// Scene that is drawn from a seed.
struct DrawnScene {
  std::string_view prefix;
  Scene (*draw)(std::uint64_t seed);
};
constexpr std::array<DrawnScene, 3> kDrawnScenes{{{"clutter:", [](std::uint64_t seed) { return random_clutter(seed); }},
                                                  {"room:", random_room},
                                                  {"street:", random_street}}};

RevolutionShape read_revolution(YamlMap& map) {
  RevolutionShape body;
  const YAML::Node profile = map.need("profile");
  if (!profile.IsSequence()) yaml_problem(profile, "expected a list of [radius, height]");
  for (const YAML::Node& point : profile) {
    const std::vector<double> values = yaml_numbers(point, 2);
    body.profile_m.emplace_back(values[0], values[1]);
  }
  body.wall_m = map.number("wall", 0.0);
  return body;
}

MeshShape read_mesh_shape(YamlMap& map, const fs::path& folder) {
  const YAML::Node path = map.need("path");
  auto mesh = read_any_mesh(folder / yaml_text(path));
  if (!mesh) throw YamlProblem{mesh.error()};
  const double scale = map.number("scale", 1.0);
  if (!(scale > 0.0)) yaml_problem(map.node(), "the scale of a mesh must be positive");
  MeshShape shape{*std::move(mesh)};
  for (Eigen::Vector3f& vertex : shape.mesh.vertices) vertex *= static_cast<float>(scale);
  return shape;
}

/// Returns the readers of bodies by their keys.
using ShapeReader = std::function<Shape(YamlMap&, const fs::path&)>;
const std::vector<std::pair<std::string, ShapeReader>>& shape_readers() {
  static const std::vector<std::pair<std::string, ShapeReader>> readers{
      {"box", [](YamlMap& map, const fs::path&) -> Shape { return BoxShape{yaml_point(map.need("size"))}; }},
      {"cylinder",
       [](YamlMap& map, const fs::path&) -> Shape {
         return CylinderShape{yaml_number(map.need("radius")), yaml_number(map.need("height"))};
       }},
      {"sphere", [](YamlMap& map, const fs::path&) -> Shape { return SphereShape{yaml_number(map.need("radius"))}; }},
      {"cone",
       [](YamlMap& map, const fs::path&) -> Shape {
         return ConeShape{yaml_number(map.need("radius")), map.number("top_radius", 0.0),
                          yaml_number(map.need("height"))};
       }},
      {"superquadric",
       [](YamlMap& map, const fs::path&) -> Shape {
         const std::vector<double> exponents = yaml_numbers(map.need("exponents"), 2);
         return SuperquadricShape{yaml_point(map.need("semi_axes")), exponents[0], exponents[1]};
       }},
      {"revolution", [](YamlMap& map, const fs::path&) -> Shape { return read_revolution(map); }},
      {"jug",
       [](YamlMap& map, const fs::path&) -> Shape {
         JugShape jug;
         jug.body = read_revolution(map);
         const std::vector<double> ends = yaml_numbers(map.need("handle_heights"), 2);
         jug.handle_bottom_m = ends[0];
         jug.handle_top_m = ends[1];
         jug.handle_reach_m = yaml_number(map.need("handle_reach"));
         jug.handle_radius_m = yaml_number(map.need("handle_radius"));
         return jug;
       }},
      {"mesh", [](YamlMap& map, const fs::path& folder) -> Shape { return read_mesh_shape(map, folder); }},
  };
  return readers;
}

Shape read_shape(YamlMap& object, const fs::path& folder) {
  std::optional<Shape> shape;
  for (const auto& [kind, read] : shape_readers()) {
    const YAML::Node node = object.find(kind);
    if (!node.IsDefined()) continue;
    if (shape) yaml_problem(node, "an object has one shape; this is its second");
    YamlMap map{node, "a " + kind};
    shape = read(map, folder);
    map.finish();
  }
  if (!shape) {
    yaml_problem(object.node(),
                 "an object needs a shape: " + joined(shape_readers(), ", ", [](auto& kind) { return kind.first; }));
  }
  return *std::move(shape);
}

Rgb8 read_rgb(const YAML::Node& node) {
  Rgb8 color{};
  const std::vector<double> values = yaml_numbers(node, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(values[k] >= 0.0 && values[k] <= 255.0)) yaml_problem(node, "colours are three numbers from 0 to 255");
    color[k] = static_cast<std::uint8_t>(std::lround(values[k]));
  }
  return color;
}

Texture read_texture(const YAML::Node& node) {
  YamlMap map{node, "a texture", {"kind", "size", "darkening"}};
  Texture texture;
  const YAML::Node kind = map.need("kind");
  const auto found = kTextureNames.find(yaml_text(kind));
  if (!found) yaml_problem(kind, "a texture is " + kTextureNames.listed());
  texture.kind = *found;
  texture.size_m = map.number("size", texture.size_m);
  texture.darkening = map.number("darkening", texture.darkening);
  map.finish();
  return texture;
}

bool read_flag(YamlMap& map, const char* key) {
  bool value = false;
  const YAML::Node node = map.find(key);
  if (node.IsDefined() && !YAML::convert<bool>::decode(node, value)) yaml_problem(node, "expected true or false");
  return value;
}

SceneObject read_object(const YAML::Node& node, const fs::path& folder) {
  std::vector<std::string_view> known{"name", "at", "turn_deg", "color", "texture", "support", "fixture"};
  for (const auto& reader : shape_readers()) known.emplace_back(reader.first);
  YamlMap map{node, "an object", std::move(known)};
  SceneObject object;
  object.name = yaml_text(map.need("name"));
  object.shape = read_shape(map, folder);
  object.T_world_object.translation() = yaml_place(map.need("at"), "an object");
  if (const YAML::Node turn = map.find("turn_deg"); turn.IsDefined()) {
    const Vector3d degrees = yaml_point(turn);
    object.T_world_object.linear() = (Eigen::AngleAxisd{to_rad(degrees.z()), Vector3d::UnitZ()} *
                                      Eigen::AngleAxisd{to_rad(degrees.y()), Vector3d::UnitY()} *
                                      Eigen::AngleAxisd{to_rad(degrees.x()), Vector3d::UnitX()})
                                         .toRotationMatrix();
  }
  if (const YAML::Node color = map.find("color"); color.IsDefined()) object.color = read_rgb(color);
  if (const YAML::Node texture = map.find("texture"); texture.IsDefined()) object.texture = read_texture(texture);
  object.support = read_flag(map, "support");
  object.fixture = read_flag(map, "fixture");
  map.finish();
  return object;
}

Box read_box(const YAML::Node& node, const std::string& what) {
  YamlMap map{node, what, {"min", "max"}};
  const Box box{yaml_place(map.need("min"), what), yaml_place(map.need("max"), what)};
  map.finish();
  return box;
}

Region read_region(const YAML::Node& node) {
  YamlMap map{node, "a region", {"sphere", "box", "cylinder"}};
  const YAML::Node sphere = map.find("sphere");
  const YAML::Node box = map.find("box");
  const YAML::Node cylinder = map.find("cylinder");
  map.finish();
  if ((sphere.IsDefined() ? 1 : 0) + (box.IsDefined() ? 1 : 0) + (cylinder.IsDefined() ? 1 : 0) != 1) {
    yaml_problem(node, "a region is a sphere, a box or a cylinder");
  }
  if (box.IsDefined()) return read_box(box, "a box");
  if (cylinder.IsDefined()) {
    YamlMap can{cylinder, "a cylinder", {"base", "top", "radius"}};
    const Cylinder region{yaml_place(can.need("base"), "a cylinder"), yaml_place(can.need("top"), "a cylinder"),
                          yaml_number(can.need("radius"))};
    can.finish();
    return region;
  }
  YamlMap ball{sphere, "a sphere", {"center", "radius"}};
  const Sphere region{yaml_place(ball.need("center"), "a sphere"), yaml_number(ball.need("radius"))};
  ball.finish();
  return region;
}

Pose read_scan_pose(const YAML::Node& node) {
  YamlMap map{node, "a pose of the scan", {"from", "look_at"}};
  const YAML::Node from = map.need("from");
  const Vector3d position = yaml_place(from, "a pose of the scan");
  const Vector3d target = yaml_place(map.need("look_at"), "a pose of the scan");
  map.finish();
  if ((target - position).norm() < 1e-6) yaml_problem(from, "a camera looks at something else than its own place");
  return look_at(position, target);
}

template <class Read>
void read_list(const YAML::Node& node, const Read& read) {
  if (!node.IsDefined()) return;
  if (!node.IsSequence()) yaml_problem(node, "expected a list");
  for (const YAML::Node& item : node) read(item);
}

Scene read_document(const YAML::Node& document, const fs::path& folder) {
  std::vector<std::string_view> known{"cell", "scene", "workspace", "max_deviation", "objects", "regions", "scan"};
  known.insert(known.end(), kCellKeys.begin(), kCellKeys.end());
  YamlMap map{document, "a scene", std::move(known)};
  Scene scene;
  const YAML::Node cell = map.find("cell");
  const YAML::Node name = cell.IsDefined() ? cell : map.need("scene");
  scene.name = yaml_text(name);
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (scene.name.empty()) yaml_problem(name, "the name is empty");
  if (std::any_of(scene.name.begin(), scene.name.end(), is_control)) {
    yaml_problem(name, "the name holds a control character");
  }
  for (const std::string_view key : kCellKeys) static_cast<void>(map.find(std::string{key}));  // read_cell reads these
  scene.workspace = read_box(map.need("workspace"), "the workspace");
  scene.max_deviation_m = map.number("max_deviation", scene.max_deviation_m);
  read_list(map.find("objects"), [&](const YAML::Node& item) { scene.objects.push_back(read_object(item, folder)); });
  read_list(map.find("regions"), [&](const YAML::Node& item) { scene.regions.push_back(read_region(item)); });
  read_list(map.find("scan"), [&](const YAML::Node& item) { scene.scan.push_back(read_scan_pose(item)); });
  map.finish();
  return scene;
}

}  // namespace

Result<Scene> parse_scene(std::string_view yaml, const fs::path& folder) {
  Scene scene;
  try {
    scene = read_document(YAML::Load(std::string{yaml}), folder);
  } catch (const YamlProblem& problem) {
    return problem.error;
  } catch (const YAML::Exception& exception) {
    return yaml_error(exception);
  }
  SACCADE_CHECK(scene.validate());
  return scene;
}

Result<Scene> read_scene(const fs::path& path) {
  SACCADE_TRY(const std::string text, read_yaml_file(path));
  auto scene = parse_scene(text, path.parent_path());
  if (scene) return scene;
  Error error = scene.error();
  error.context = path.string() + (error.context.empty() ? "" : ", " + error.context);
  return error;
}

Result<Scene> find_scene(const std::string& name_or_path, const MeshSceneConfig& mesh) {
  std::string known;
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.name == name_or_path) return parse_scene(builtin.yaml);
    known += std::string{builtin.name} + ", ";
  }
  for (const std::string_view name : kSurfelScenes) {
    known += std::string{name} + ", ";
    if (name != name_or_path) continue;
    SACCADE_TRY(SurfelScene made, surfel_scene(name));
    return std::move(made.scene);
  }
  for (const auto& [prefix, draw] : kDrawnScenes) {
    if (!name_or_path.starts_with(prefix)) continue;
    const std::string digits = name_or_path.substr(prefix.size());
    const bool is_number =
        !digits.empty() && digits.size() <= 18 && digits.find_first_not_of("0123456789") == std::string::npos;
    if (is_number) return draw(std::stoull(digits));
    return Error{Errc::invalid_argument, "a seed is a whole number: " + std::string{prefix} + "7", name_or_path};
  }
  if (fs::exists(name_or_path)) {
    return is_mesh_file(name_or_path) ? mesh_scene(name_or_path, mesh) : read_scene(name_or_path);
  }
  const fs::path path{name_or_path};
  if (path.has_parent_path() || is_mesh_file(path) || path.extension() == ".yaml" || path.extension() == ".yml") {
    return Error{Errc::not_found, "there is no such file", name_or_path};
  }
  std::vector<std::string_view> names{kSurfelScenes.begin(), kSurfelScenes.end()};
  for (const BuiltinScene& builtin : builtin_scenes()) names.push_back(builtin.name);
  return Error{Errc::not_found,
               "no such scene; there are " + known + "clutter:SEED, room:SEED, street:SEED, and files (YAML, meshes)" +
                   did_you_mean(name_or_path, names),
               name_or_path};
}

}  // namespace saccade
