// SPDX-License-Identifier: Apache-2.0
// saccade info of maps, clouds, meshes, arrays, arms and scenes.
#include <algorithm>
#include <set>
#include <sstream>

#include "info_files.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/cloud/point_spacing.hpp"
#include "saccade/core/names.hpp"
#include "saccade/devices/cell.hpp"
#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "shell_quoted.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string corner_text(const Eigen::Vector3d& p) {
  return "(" + fixed(p.x(), 2) + ", " + fixed(p.y(), 2) + ", " + fixed(p.z(), 2) + ")";
}

std::string box_text(const Box& box) { return corner_text(box.min) + " to " + corner_text(box.max) + " m"; }

json box_json(const Box& box) { return {{"min", point_json(box.min)}, {"max", point_json(box.max)}}; }

/// The smallest box around all points that are finite; nullopt without any.
std::optional<Box> bounds_of(const std::vector<Eigen::Vector3f>& positions_m) {
  std::optional<Box> box;
  for (const Eigen::Vector3f& position_m : positions_m) {
    if (!position_m.allFinite()) continue;
    const Eigen::Vector3d p = position_m.cast<double>();
    if (!box) box = Box{p, p};
    box->min = box->min.cwiseMin(p);
    box->max = box->max.cwiseMax(p);
  }
  return box;
}

/// "x y z (f32), label (u32)": neighbours of one type together.
std::string fields_text(const ColumnTable& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size();) {
    std::size_t end = i;
    text += i == 0 ? "" : ", ";
    for (; end < table.columns.size() && table.columns[end].type == table.columns[i].type; ++end) {
      text += (end == i ? "" : " ") + table.columns[end].name;
    }
    text += " (" + std::string{to_string(table.columns[i].type)} + ")";
    i = end;
  }
  return text;
}

json fields_json(const ColumnTable& table) {
  json fields = json::array();
  for (const Column& column : table.columns) {
    fields.push_back({{"name", column.name}, {"type", to_string(column.type)}, {"count", column.count}});
  }
  return fields;
}

/// Labels above 0, and points that have one.
void add_labels_of(const ColumnTable& table, json& cloud, Description& described) {
  const auto labels = labels_from_fields(table);
  if (!labels) return;
  std::set<std::uint32_t> known;
  std::size_t labelled = 0;
  for (const std::uint32_t label : *labels) {
    if (label == kUnlabelled) continue;
    known.insert(label);
    ++labelled;
  }
  cloud["labels"] = known.size();
  cloud["labelled_points"] = labelled;
  described.line("labels", std::to_string(known.size()) + ", of " + std::to_string(labelled) + " points");
}

/// The first line of a NumPy file's header, in braces.
std::string npy_description(const std::string& file) {
  const std::size_t open = file.find('{');
  const std::size_t close = file.find('}', open);
  constexpr std::size_t kMostHeader{4096};
  if (!file.starts_with("\x93NUMPY") || close == std::string::npos || close > kMostHeader) return {};
  return file.substr(open, close - open + 1);
}

json saved_map_json(const TsdfSnapshot& map) {
  const TsdfGrid::Usage usage = map.grid.usage();
  std::size_t occupied = 0;
  std::size_t known = 0;
  for (const Index3& key : map.grid.sorted_sectors()) {
    for (const BrickRef& brick : map.grid.find(key)->bricks) {
      occupied += static_cast<std::size_t>(brick.occupied_mask().count());
      known += static_cast<std::size_t>(kBrickVoxels - brick.unknown_mask().count());
    }
  }
  const IndexBox sectors = map.grid.sector_bounds();
  const double sector_m = kSectorVoxelEdge * map.config.voxel_size_m;
  const auto corner = [sector_m](const Index3& i) { return json{i.x * sector_m, i.y * sector_m, i.z * sector_m}; };
  json result{{"voxel_size_m", map.config.voxel_size_m},
              {"truncation_m", map.config.truncation_m()},
              {"max_weight", map.config.max_weight},
              {"free_weight", map.config.free_weight},
              {"clearing_percent", map.config.clearing_percent},
              {"color", map.config.color},
              {"workspace", nullptr},
              {"bounds_m", {{"min", corner(sectors.lo)}, {"max", corner(sectors.hi)}}},
              {"sectors", usage.sectors},
              {"bricks", usage.bricks()},
              {"constant_free_bricks", usage.constant_free_bricks},
              {"free_bricks", usage.free_bricks},
              {"dense_bricks", usage.dense_bricks},
              {"bytes", usage.bytes},
              {"occupied_voxels", occupied},
              {"empty_voxels", known - occupied}};
  if (const auto& w = map.config.workspace) result["workspace"] = box_json(*w);
  return result;
}

std::string json_corner_text(const json& corner) {
  return corner_text({corner[0].get<double>(), corner[1].get<double>(), corner[2].get<double>()});
}

}  // namespace

Description describe_map(const fs::path& path, const TsdfSnapshot& snapshot) {
  Description described;
  const json map = saved_map_json(snapshot);
  described.line("map", path.string());
  described.line("voxels", millimetres(map["voxel_size_m"].get<double>()) + ", truncated at " +
                               millimetres(map["truncation_m"].get<double>()));
  described.line("within",
                 json_corner_text(map["bounds_m"]["min"]) + " to " + json_corner_text(map["bounds_m"]["max"]) + " m");
  described.line("occupied", map["occupied_voxels"].dump() + " voxels");
  described.line("empty", map["empty_voxels"].dump() + " voxels");
  described.line("bricks", map["bricks"].dump() + ": " + map["dense_bricks"].dump() + " dense, " +
                               map["free_bricks"].dump() + " free, " + map["constant_free_bricks"].dump() +
                               " constant free");
  described.line("memory", mebibytes(map["bytes"].get<std::size_t>()));
  described.result = {{"kind", "map"}, {"map", map}};
  return described;
}

Result<Description> describe_cloud(const fs::path& path, const Executor& executor) {
  SACCADE_TRY(const CloudFile file, read_cloud(path));
  const ColumnTable& table = file.fields();
  Description described;
  json cloud{{"points", table.rows}, {"fields", fields_json(table)}};
  described.line("cloud", path.string());
  std::string points = std::to_string(table.rows);
  if (const auto* pcd = std::get_if<PcdFile>(&file.file); pcd != nullptr && pcd->height > 1) {
    cloud["width"] = pcd->width;
    cloud["height"] = pcd->height;
    points += ", organised in " + std::to_string(pcd->width) + " × " + std::to_string(pcd->height);
  }
  described.line("points", points);
  described.line("fields", fields_text(table));
  if (const auto points_of = cloud_from_fields(table)) {
    std::optional<Box> bounds = bounds_of(points_of->positions_m);
    if (bounds) bounds = Box{bounds->min + points_of->offset_m, bounds->max + points_of->offset_m};
    const std::optional<double> spacing_m = point_spacing_m(points_of->positions_m, executor);
    cloud["bounds_m"] = bounds ? box_json(*bounds) : json(nullptr);
    cloud["spacing_m"] = optional_json(spacing_m);
    if (bounds) described.line("within", box_text(*bounds));
    cloud["offset_m"] = point_json(points_of->offset_m);
    if (!points_of->offset_m.isZero(0.0)) described.line("offset", offset_text(points_of->offset_m));
    if (spacing_m) described.line("spacing", millimetres(*spacing_m) + ", median to the nearest point");
  }
  add_labels_of(table, cloud, described);
  described.result = {{"kind", "cloud"}, {"cloud", std::move(cloud)}};
  return described;
}

Result<Description> describe_mesh(const fs::path& path) {
  SACCADE_TRY(const TriangleMesh mesh, read_any_mesh(path));
  Description described;
  const std::optional<Box> bounds = bounds_of(mesh.vertices);
  described.line("mesh", path.string());
  described.line("triangles", std::to_string(mesh.triangles.size()) + ", of " + std::to_string(mesh.vertices.size()) +
                                  " vertices" + (mesh.colors.empty() ? "" : " with colours"));
  if (bounds) described.line("within", box_text(*bounds) + ", if its unit is the metre");
  described.result = {{"kind", "mesh"},
                      {"mesh",
                       {{"triangles", mesh.triangles.size()},
                        {"vertices", mesh.vertices.size()},
                        {"colors", !mesh.colors.empty()},
                        {"normals", !mesh.normals.empty()},
                        {"bounds_m", bounds ? box_json(*bounds) : json(nullptr)}}}};
  return described;
}

Result<Description> describe_urdf(const fs::path& path) {
  UrdfConfig config;
  config.cancelled = interrupted;
  SACCADE_TRY(const UrdfArm read, find_robot(path.string(), config));
  Description described;
  described.line("arm", read.arm.name() + ", " + std::to_string(read.arm.dof()) + " joints");
  described.line("reach", fixed(reach_bound_m(read.arm), 3) + " m at most, from the first joint to the camera");
  described.line("camera", read.arm.description().camera_name);
  described.line("more", "saccade robot check " + shell_quoted(path.string()));
  described.result = {{"kind", "arm"},
                      {"arm",
                       {{"name", read.arm.name()},
                        {"joints", read.arm.dof()},
                        {"camera", read.arm.description().camera_name},
                        {"reach_bound_m", reach_bound_m(read.arm)}}}};
  return described;
}

Result<Description> describe_scene(const fs::path& path) {
  SACCADE_TRY(const Scene scene, find_scene(path.string()));
  SACCADE_TRY(const Cell cell, read_cell(path));
  std::vector<std::string_view> devices;
  if (cell.arm) devices.emplace_back("arm");
  if (!cell.joints.command.empty()) devices.emplace_back("joints");
  if (!cell.robot.command.empty()) devices.emplace_back("robot");
  if (!cell.camera.command.empty()) devices.emplace_back("camera");
  if (!cell.hand.command.empty()) devices.emplace_back("hand");
  const char* kind = devices.empty() ? "scene" : "cell";
  Description described;
  described.line(kind, scene.name);
  described.line("workspace", box_text(scene.workspace));
  described.line("objects", joined(scene.objects, ", ", &SceneObject::name));
  described.line("regions", std::to_string(scene.regions.size()));
  described.line("scan", std::to_string(scene.scan.size()) + " poses");
  if (!devices.empty()) described.line("devices", joined(devices));
  json objects = json::array();
  for (const SceneObject& object : scene.objects) objects.push_back(object.name);
  described.result = {{"kind", kind},
                      {"scene",
                       {{"name", scene.name},
                        {"workspace_m", box_json(scene.workspace)},
                        {"objects", std::move(objects)},
                        {"regions", scene.regions.size()},
                        {"scan_poses", scene.scan.size()},
                        {"devices", devices}}}};
  return described;
}

Result<Description> describe_array(const fs::path& path) {
  constexpr std::uintmax_t kMostBytes{std::uintmax_t{4} << 30U};
  SACCADE_TRY(const std::string file, read_text_file(path, kMostBytes));
  const std::string header = npy_description(file);
  if (header.empty()) return Error{Errc::corrupt_data, "is not a NumPy array", path.string()};
  Description described;
  described.line("array", path.string());
  described.line("header", header);
  described.line("size", mebibytes(file.size()));
  described.result = {{"kind", "array"}, {"array", {{"header", header}, {"bytes", file.size()}}}};
  return described;
}

}  // namespace saccade::cli
