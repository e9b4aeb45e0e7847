// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/trajectory_io.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

Error at_line(Error error, std::size_t line) {
  const std::string where = "line " + std::to_string(line);
  error.context = error.context.empty() ? where : where + ", " + error.context;
  return error;
}

PoseEntry entry_of(Result<Pose> pose, std::optional<double> time_s, std::size_t line) {
  if (!pose) return {at_line(pose.error(), line), time_s, line};
  return {std::move(pose), time_s, line};
}

/// Makes a pose of x y z qx qy qz qw, which follow one other number.
Result<Pose> pose_from_tum(const std::vector<double>& v) {
  constexpr double kNormTolerance{1e-3};
  const Eigen::Quaterniond q{v[7], v[4], v[5], v[6]};
  const Eigen::Vector3d t{v[1], v[2], v[3]};
  if (!t.allFinite() || !q.coeffs().allFinite()) return Error{Errc::invalid_argument, "the pose is not finite", {}};
  if (std::abs(q.norm() - 1.0) > kNormTolerance) {
    return Error{Errc::invalid_argument, "the quaternion has length " + std::to_string(q.norm()) + ", not 1", {}};
  }
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = t;
  return pose;
}

std::optional<std::int64_t> whole_number(double value) {
  constexpr double kExact{9007199254740992.0};  // 2⁵³
  if (!(std::abs(value) <= kExact) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

/// Reads lines of `columns` numbers: 8, or 9 with an id.
Result<std::vector<PoseEntry>> tum_entries(const std::vector<NumberLine>& lines, std::size_t columns) {
  std::vector<PoseEntry> entries;
  for (const NumberLine& line : lines) {
    if (line.values.size() != columns) {
      return bad_line(line.line, columns == 8 ? "8 numbers expected: time tx ty tz qx qy qz qw"
                                              : "9 numbers expected: time tx ty tz qx qy qz qw id");
    }
    if (!std::isfinite(line.values[0])) return bad_line(line.line, "the time is not finite");
    entries.push_back(entry_of(pose_from_tum(line.values), line.values[0], line.line));
    if (columns == 8) continue;
    entries.back().id = whole_number(line.values[8]);
    if (!entries.back().id) return bad_line(line.line, "the id, the ninth number, is not a whole number");
  }
  return entries;
}

/// Makes a pose of x y z roll pitch yaw, which follow one other number.
Result<Pose> pose_from_angles(const std::vector<double>& v) {
  const Eigen::Map<const Eigen::Matrix<double, 7, 1>> all{v.data()};
  if (!all.allFinite()) return Error{Errc::invalid_argument, "the pose is not finite", {}};
  Pose pose = Pose::Identity();
  pose.linear() =
      (Eigen::AngleAxisd{v[6], Eigen::Vector3d::UnitZ()} * Eigen::AngleAxisd{v[5], Eigen::Vector3d::UnitY()} *
       Eigen::AngleAxisd{v[4], Eigen::Vector3d::UnitX()})
          .toRotationMatrix();
  pose.translation() = Eigen::Vector3d{v[1], v[2], v[3]};
  return pose;
}

bool is_graph(std::string_view text) {
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    TokenScanner tokens{*line};
    const auto word = tokens.next();
    if (!word || word->front() == '#') continue;
    return word->starts_with("VERTEX") || word->starts_with("EDGE") || word->starts_with("PARAMS") || *word == "FIX";
  }
  return false;
}

/// Reads the poses of a graph of g2o or TORO.
Result<std::vector<PoseEntry>> graph_entries(std::string_view text) {
  std::vector<PoseEntry> entries;
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    TokenScanner tokens{*line};
    const auto word = tokens.next();
    if (!word || word->front() == '#') continue;
    const bool is_quaternion = *word == "VERTEX_SE3:QUAT";
    if (!is_quaternion && *word != "VERTEX3") {
      if (word->starts_with("VERTEX2") || word->starts_with("VERTEX_SE2")) {
        return bad_line(lines.line(), "poses in the plane are not poses of a camera");
      }
      continue;  // edges, points, parameters
    }
    std::vector<double> values;
    while (const auto token = tokens.next()) {
      const auto value = parse_number(*token);
      if (!value) return bad_line(lines.line(), in_quotes(*token) + " is not a number");
      values.push_back(*value);
    }
    if (values.size() != (is_quaternion ? 8U : 7U)) {
      return bad_line(lines.line(),
                      is_quaternion ? "id x y z qx qy qz qw expected" : "id x y z roll pitch yaw expected");
    }
    entries.push_back(entry_of(is_quaternion ? pose_from_tum(values) : pose_from_angles(values), {}, lines.line()));
    entries.back().id = whole_number(values[0]);
    if (!entries.back().id) return bad_line(lines.line(), "the id is not a whole number");
  }
  return entries;
}

/// Appends the last row that lines of 3×4 matrices leave out.
std::vector<NumberLine> with_last_rows(std::vector<NumberLine> lines) {
  const std::vector<double> last{0.0, 0.0, 0.0, 1.0};
  for (NumberLine& line : lines) {
    if (line.values.size() == 12) line.values.insert(line.values.end(), last.begin(), last.end());
  }
  return lines;
}

/// Reads matrices from rows of `lines`, each block preceded by `header_lines` lines of 3 numbers.
Result<std::vector<PoseEntry>> matrix_entries(const std::vector<NumberLine>& lines, std::size_t header_lines) {
  std::vector<PoseEntry> entries;
  std::size_t i = 0;
  while (i < lines.size()) {
    const std::size_t first_line = lines[i].line;
    for (std::size_t h = 0; h < header_lines; ++h, ++i) {
      if (lines[i].values.size() != 3) return bad_line(lines[i].line, "3 integers expected before a matrix");
    }
    std::vector<double> values;
    while (values.size() < 16 && i < lines.size()) {
      const NumberLine& row = lines[i++];
      if (row.values.size() != 4 && row.values.size() != 16) {
        return bad_line(row.line, "4 numbers of a matrix row expected, not " + std::to_string(row.values.size()));
      }
      values.insert(values.end(), row.values.begin(), row.values.end());
    }
    if (values.size() != 16) return bad_line(first_line, "this 4x4 matrix is cut");
    const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>{values.data()};
    const bool is_lost = matrix.isZero(0.0);
    entries.push_back(
        entry_of(is_lost ? Error{Errc::invalid_argument, "the pose is lost: all zeros", {}} : pose_from_matrix(matrix),
                 std::nullopt, first_line));
  }
  return entries;
}

bool is_matrix(const nlohmann::json& value) {
  return value.is_array() && value.size() == 4 && value[0].is_array() && !value[0].empty() && value[0][0].is_number();
}

/// Returns the array of poses within a document, or nullptr.
const nlohmann::json* pose_array(const nlohmann::json& document) {
  if (document.is_array()) return &document;
  if (!document.is_object()) return nullptr;
  for (const char* key : {"poses", "views"}) {
    if (document.contains(key) && document[key].is_array()) return &document[key];
  }
  if (document.contains("result")) return pose_array(document["result"]);
  return nullptr;
}

Result<std::vector<PoseEntry>> json_entries(std::string_view text) {
  SACCADE_TRY(const nlohmann::json document, parse_json(text));
  std::vector<PoseEntry> entries;
  if (is_matrix(document)) {
    entries.push_back({pose_from_json(document), std::nullopt, 0});
    return entries;
  }
  const nlohmann::json* poses = pose_array(document);
  if (poses == nullptr) return Error{Errc::corrupt_data, "no array of poses in this JSON", {}};
  for (const nlohmann::json& element : *poses) {
    const bool wrapped = element.is_object() && element.contains("T_world_camera");
    auto pose = pose_from_json(wrapped ? element["T_world_camera"] : element);
    if (!pose) {
      Error error = pose.error();
      error.context = "pose " + std::to_string(entries.size());
      if (error.code == Errc::corrupt_data) return error;
      pose = error;
    }
    entries.push_back({std::move(pose), std::nullopt, 0});
  }
  return entries;
}

/// Formats one line of text by a printf format.
template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 512> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, values...);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string matrix_text(const Pose& pose) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const auto row = pose.matrix().row(i);
    text += formatted("%.17g %.17g %.17g %.17g\n", row[0], row[1], row[2], row[3]);
  }
  return text;
}

}  // namespace

Result<std::vector<PoseEntry>> parse_pose_list(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && (text[first] == '[' || text[first] == '{')) return json_entries(text);
  if (is_graph(text)) return graph_entries(text);
  SACCADE_TRY(const auto lines, number_lines(text));
  if (lines.empty()) return std::vector<PoseEntry>{};
  switch (const std::size_t columns = lines.front().values.size(); columns) {
    case 8:
    case 9: return tum_entries(lines, columns);
    case 3: return matrix_entries(lines, 1);
    case 4:
    case 12:
    case 16: return matrix_entries(with_last_rows(lines), 0);
    default:
      return bad_line(lines.front().line,
                      "not a list of poses: 8 or 9 (TUM), 12 (KITTI), 3 (Open3D log), 4 or 16 (4x4 matrix) numbers a "
                      "line expected, "
                      "not " +
                          std::to_string(lines.front().values.size()));
  }
}

Result<std::vector<PoseEntry>> read_pose_list(const std::filesystem::path& path) {
  SACCADE_TRY(const std::string text, read_text_file(path));
  auto entries = parse_pose_list(text);
  if (!entries) return in_file(entries.error(), path);
  return entries;
}

Result<std::vector<Pose>> read_poses(const std::filesystem::path& path) {
  SACCADE_TRY(const auto entries, read_pose_list(path));
  if (entries.empty()) return Error{Errc::not_found, "holds no pose", path.string()};
  std::vector<Pose> poses;
  for (const PoseEntry& entry : entries) {
    if (!entry.T_world_camera) return in_file(entry.T_world_camera.error(), path);
    poses.push_back(*entry.T_world_camera);
  }
  return poses;
}

Result<std::vector<StampedPose>> read_tum_trajectory(const std::filesystem::path& path) {
  SACCADE_TRY(const auto entries, read_pose_list(path));
  std::vector<StampedPose> poses;
  for (const PoseEntry& entry : entries) {
    if (!entry.time_s) return Error{Errc::corrupt_data, "not a TUM trajectory: no times", path.string()};
    if (!entry.T_world_camera) return in_file(entry.T_world_camera.error(), path);
    poses.push_back({*entry.time_s, *entry.T_world_camera});
  }
  return poses;
}

Status write_tum_trajectory(const std::filesystem::path& path, std::span<const StampedPose> poses) {
  std::string text{"# time tx ty tz qx qy qz qw\n"};
  for (const StampedPose& pose : poses) {
    const Eigen::Vector3d t = pose.T_world_camera.translation();
    const Eigen::Quaterniond q{pose.T_world_camera.rotation()};
    text += formatted("%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", pose.time_s, t.x(), t.y(), t.z(), q.x(),
                      q.y(), q.z(), q.w());
  }
  return write_file_atomically(path, text);
}

Status write_matrices(const std::filesystem::path& path, std::span<const Pose> poses) {
  std::string text;
  for (const Pose& pose : poses) text += matrix_text(pose);
  return write_file_atomically(path, text);
}

Status write_open3d_log(const std::filesystem::path& path, std::span<const Pose> poses) {
  std::string text;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    text += formatted("%zu %zu %zu\n", i, i, i + 1) + matrix_text(poses[i]);
  }
  return write_file_atomically(path, text);
}

}  // namespace saccade
