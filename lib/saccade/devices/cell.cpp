// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/cell.hpp"
#include "saccade/core/length_limit.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "saccade/core/angle.hpp"
#include "saccade/core/length_limit.hpp"
#include "saccade/devices/internal/ros_device.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/yaml_map.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

bool yaml_flag(const YAML::Node& node) {
  bool value = false;
  if (!YAML::convert<bool>::decode(node, value)) yaml_problem(node, "expected true or false");
  return value;
}

double yaml_positive(const YAML::Node& node) {
  const double value = yaml_number(node);
  if (!(value > 0.0)) yaml_problem(node, "expected a positive number");
  return value;
}

std::optional<double> positive_in(YamlMap& map, const std::string& key) {
  const YAML::Node node = map.find(key);
  return node.IsDefined() ? std::optional{yaml_positive(node)} : std::nullopt;
}

std::string text_in(YamlMap& map, const std::string& key) {
  const YAML::Node node = map.find(key);
  return node.IsDefined() ? yaml_text(node) : std::string{};
}

/// Rejects a pose that is too far away to be right.
void check_near(const YAML::Node& node, const Pose& pose) {
  if (pose.translation().cwiseAbs().maxCoeff() <= kMaxLength_m) return;
  yaml_problem(node, "the pose is farther than a kilometre from the origin; lengths are metres");
}

/// Reads a matrix of three or four rows.
Pose read_matrix(const YAML::Node& node) {
  if (!node.IsSequence() || (node.size() != 3 && node.size() != 4)) yaml_problem(node, "expected the rows of a pose");
  Pose pose = Pose::Identity();
  for (std::size_t row = 0; row < 3; ++row) {
    const std::vector<double> values = yaml_numbers(node[row], 4);
    for (std::size_t column = 0; column < 4; ++column) {
      pose.matrix()(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = values[column];
    }
  }
  if (!((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) ||
      pose.linear().determinant() < 0.0) {
    yaml_problem(node, "the first three columns are not a rotation");
  }
  check_near(node, pose);
  pose.linear() = Eigen::Quaterniond{pose.linear()}.normalized().toRotationMatrix();
  return pose;
}

Pose read_base_at(const YAML::Node& node) {
  const std::vector<double> n = yaml_numbers(node, 0);
  if (n.size() != 3 && n.size() != 4) yaml_problem(node, "expected [x, y, z] or [x, y, z, degrees]");
  const double turn_rad = n.size() == 4 ? to_rad(n[3]) : 0.0;
  const Pose T_world_base =
      Eigen::Translation3d{n[0], n[1], n[2]} * Eigen::AngleAxisd{turn_rad, Eigen::Vector3d::UnitZ()};
  check_near(node, T_world_base);
  return T_world_base;
}

Box read_cell_box(const YAML::Node& node) {
  YamlMap map{node, "a box", {"min", "max"}};
  const Box box{yaml_place(map.need("min"), "a box"), yaml_place(map.need("max"), "a box")};
  map.finish();
  if (!(box.min.array() < box.max.array()).all()) yaml_problem(node, "the box is empty: min must be below max");
  return box;
}

std::vector<Box> read_boxes(const YAML::Node& node) {
  std::vector<Box> boxes;
  if (!node.IsDefined()) return boxes;
  if (!node.IsSequence()) yaml_problem(node, "expected a list of boxes");
  for (const YAML::Node& item : node) boxes.push_back(read_cell_box(item));
  return boxes;
}

CellArm read_cell_arm(const YAML::Node& node, const fs::path& folder) {
  YamlMap map{node,
              "an arm",
              {"urdf", "robot", "base", "tip", "camera_frame", "base_at", "T_flange_camera", "packages",
               "package_paths", "drop_beyond_tip", "speed"}};
  CellArm arm;
  const std::string urdf = text_in(map, "urdf");
  arm.robot = urdf.empty() ? text_in(map, "robot") : (folder / urdf).string();
  if (arm.robot.empty()) yaml_problem(node, "an arm needs the key urdf (a file), or robot (a built-in one)");
  arm.base = text_in(map, "base");
  arm.tip = text_in(map, "tip");
  arm.camera_frame = text_in(map, "camera_frame");
  if (const YAML::Node at = map.find("base_at"); at.IsDefined()) arm.T_world_base = read_base_at(at);
  if (const YAML::Node mount = map.find("T_flange_camera"); mount.IsDefined()) {
    arm.T_flange_camera = read_matrix(mount);
  }
  if (const YAML::Node packages = map.find("packages"); packages.IsDefined()) {
    if (!packages.IsMap()) yaml_problem(packages, "expected NAME: FOLDER");
    for (const auto& entry : packages) arm.packages[yaml_text(entry.first)] = folder / yaml_text(entry.second);
  }
  if (const YAML::Node paths = map.find("package_paths"); paths.IsDefined()) {
    if (!paths.IsSequence()) yaml_problem(paths, "expected a list of folders");
    for (const YAML::Node& path : paths) arm.package_paths.push_back(folder / yaml_text(path));
  }
  if (const YAML::Node drop = map.find("drop_beyond_tip"); drop.IsDefined()) arm.drop_beyond_tip = yaml_flag(drop);
  if (const YAML::Node speed = map.find("speed"); speed.IsDefined()) {
    arm.speed = yaml_positive(speed);
    if (arm.speed > 1.0) yaml_problem(speed, "the speed is a share of the arm's own: at most 1");
  }
  map.finish();
  return arm;
}

/// Reads a device over ROS in full form: {ros: /camera/depth, info: /camera/camera_info}. Returns "ros:/camera/depth
/// --info …".
std::string ros_command(YamlMap& map, const std::string& role, const YAML::Node& name, const std::string& prefix) {
  std::string command = prefix + shell_quoted(yaml_text(name));
  for (const std::string_view option : ros_options(role)) {
    std::string key{option};
    std::replace(key.begin(), key.end(), '-', '_');
    const std::string value = text_in(map, key);
    if (!value.empty()) command += " --" + std::string{option} + " " + shell_quoted(value);
  }
  return command;
}

/// Rejects devices that no program over ROS can be.
void check_ros_name(const YAML::Node& node, const std::string& role, const std::string& command) {
  if (const Status status = check_over_ros(role, command); !status.ok()) yaml_problem(node, status.error().message);
}

std::string read_command(YamlMap& map, const std::string& role) {
  for (const char* prefix : {"ros", "ros2"}) {
    const YAML::Node name = map.find(prefix);
    if (!name.IsDefined()) continue;
    if (map.find("command").IsDefined()) yaml_problem(name, "command and ros exclude each other");
    const std::string command = ros_command(map, role, name, std::string{prefix} + ":");
    check_ros_name(name, role, command);
    return command;
  }
  const YAML::Node node = map.need("command");
  const std::string command = yaml_text(node);
  if (command.find_first_not_of(" \t") == std::string::npos) yaml_problem(node, "the command is empty");
  check_ros_name(node, role, command);
  return command;
}

/// Keys of a device; or, instead of all of them, ros:NAME.
class ProgramKeys {
 public:
  ProgramKeys(const YAML::Node& node, const std::string& role) {
    if (node.IsScalar() && is_over_ros(yaml_text(node))) {
      program_.command = yaml_text(node);
      check_ros_name(node, role, program_.command);
      return;
    }
    map_.emplace(node, role);
    program_.command = read_command(*map_, role);
    program_.timeout_s = positive("timeout");
    tell("timeout", program_.timeout_s);
  }
  [[nodiscard]] std::optional<double> positive(const std::string& key) {
    return map_ ? positive_in(*map_, key) : std::nullopt;
  }
  [[nodiscard]] double number(const std::string& key) { return map_ ? map_->number(key, 0.0) : 0.0; }
  /// Passes Saccade's time limit to a program over ROS, so that it gives up slightly earlier, and says why.
  void tell(const char* option, std::optional<double> limit_s) {
    constexpr double kEarlier{0.8};
    if (!limit_s || !is_over_ros(program_.command)) return;
    program_.command += std::string{" --"} + option + " " + std::to_string(kEarlier * *limit_s);
  }
  [[nodiscard]] CellProgram finish() const {
    if (map_) map_->finish();
    return program_;
  }

 private:
  std::optional<YamlMap> map_;
  CellProgram program_;
};

CellProgram program_under(YamlMap& cell, const std::string& key) {
  const YAML::Node node = cell.find(key);
  return node.IsDefined() ? ProgramKeys{node, key}.finish() : CellProgram{};
}

Cell read_cell_document(const YAML::Node& document, const fs::path& folder) {
  YamlMap map{document, "a cell"};
  Cell cell;
  cell.folder = folder;
  if (const YAML::Node arm = map.find("arm"); arm.IsDefined()) cell.arm = read_cell_arm(arm, folder);
  if (const YAML::Node camera = map.find("camera"); camera.IsDefined()) {
    ProgramKeys keys{camera, "camera"};
    cell.camera_clock_offset_s = keys.number("clock_offset");
    cell.camera = keys.finish();
  }
  if (const YAML::Node joints = map.find("joints"); joints.IsDefined()) {
    ProgramKeys keys{joints, "joints"};
    cell.watch = {keys.positive("tolerance"), keys.positive("lag"), keys.positive("watchdog")};
    keys.tell("silence", cell.watch.watchdog_s);
    cell.joints = keys.finish();
    if (!cell.arm) yaml_problem(joints, "joints need an arm that plans: add the key arm, with its URDF");
  }
  cell.robot = program_under(map, "robot");
  if (!cell.robot.command.empty() && cell.arm) {
    yaml_problem(map.find("robot"), "a robot that plans for itself and an arm exclude each other");
  }
  cell.hand = program_under(map, "hand");
  if (const YAML::Node tracking = map.find("tracking"); tracking.IsDefined()) {
    cell.tracking = yaml_text(tracking);
    if (cell.tracking != "forced" && cell.tracking != "hint" && cell.tracking != "icp" && cell.tracking != "rgbd") {
      yaml_problem(tracking, "tracking is forced, hint, icp or rgbd");
    }
  }
  cell.fixtures = read_boxes(map.find("fixtures"));
  cell.free = read_boxes(map.find("free"));
  return cell;
}

}  // namespace

Result<Cell> parse_cell(std::string_view yaml, const fs::path& folder) {
  try {
    return read_cell_document(YAML::Load(std::string{yaml}), folder);
  } catch (const YamlProblem& problem) {
    return problem.error;
  } catch (const YAML::Exception& exception) {
    return yaml_error(exception);
  }
}

Result<Cell> read_cell(const fs::path& path) {
  SACCADE_TRY(const std::string text, read_yaml_file(path));
  auto cell = parse_cell(text, path.parent_path());
  if (cell) return cell;
  Error error = cell.error();
  error.context = path.string() + (error.context.empty() ? "" : ", " + error.context);
  return error;
}

}  // namespace saccade
