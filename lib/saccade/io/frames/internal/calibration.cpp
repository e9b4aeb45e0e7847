// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/internal/calibration.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/files/yaml_map.hpp"

namespace saccade {
namespace {

constexpr double kMillimetresPerMetre{1000.0};

using Numbers = std::vector<double>;

/// Makes intrinsics of a matrix of 3×3, 3×4 or 4×4 by the reader of such matrices.
Result<Intrinsics> intrinsics_of(const Numbers& matrix) {
  std::string text;
  for (const double value : matrix) text += nlohmann::json(value).dump() + ' ';
  return parse_intrinsics(text);
}

Result<Pose> pose_of_rows(const Numbers& rows) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = rows[i];
  }
  return pose_from_matrix(matrix);
}

/// Returns the document without OpenCV's first line, which YAML 1.2 does not know.
Result<YAML::Node> load_opencv(std::string_view text) {
  if (text.starts_with("%YAML")) text.remove_prefix(std::min(text.find('\n'), text.size()));
  try {
    YAML::Node node = YAML::Load(std::string{text});
    if (!node.IsMap()) return Error{Errc::corrupt_data, "no mapping of camera_matrix and the like", {}};
    return node;
  } catch (const YAML::Exception& exception) {
    return yaml_error(exception);
  }
}

/// Returns the numbers of a matrix of OpenCV: {rows, cols, data}.
Numbers matrix_numbers(const YAML::Node& node, std::size_t count) {
  if (!node.IsMap() || !node["data"]) yaml_problem(node, "a matrix with rows, cols and data is expected");
  return yaml_numbers(node["data"], count);
}

Result<Distortion> lens_of(const Numbers& k) {
  if (const auto lens = Distortion::from_coefficients(k)) return *lens;
  return Error{
      Errc::unsupported, "a lens model of more than k1 k2 p1 p2 k3 k4 k5 k6; write the images undistorted", {}};
}

Result<Intrinsics> opencv_intrinsics(const YAML::Node& node) {
  SACCADE_TRY(Intrinsics intrinsics, intrinsics_of(matrix_numbers(node["camera_matrix"], 9)));
  for (const auto& [key, size] : {std::pair{"image_width", &intrinsics.width}, {"image_height", &intrinsics.height}}) {
    if (!node[key]) continue;
    const double edge = yaml_number(node[key]);
    if (edge == std::floor(edge) && edge >= 1.0 && edge <= 16384.0) *size = static_cast<int>(edge);
  }
  if (!node["distortion_coefficients"]) return intrinsics;
  SACCADE_TRY(const Distortion lens, lens_of(matrix_numbers(node["distortion_coefficients"], 0)));
  const bool is_fisheye = node["distortion_model"] && node["distortion_model"].IsScalar() &&
                          node["distortion_model"].Scalar() != "plumb_bob" &&
                          node["distortion_model"].Scalar() != "rational_polynomial";
  if (lens.is_zero()) return intrinsics;
  if (is_fisheye) {
    return Error{Errc::unsupported,
                 "the lens model " + in_quotes(node["distortion_model"].Scalar()) + "; write the images undistorted",
                 {}};
  }
  intrinsics.distortion = lens;
  return intrinsics;
}

std::optional<std::pair<std::string_view, std::string_view>> key_and_value(std::string_view line) {
  const std::size_t equal = line.find('=');
  if (equal == std::string_view::npos) return std::nullopt;
  return std::pair{trimmed(line.substr(0, equal)), trimmed(line.substr(equal + 1))};
}

Result<Numbers> numbers_of(std::string_view text, std::size_t line) {
  Numbers values;
  TokenScanner tokens{text};
  while (const auto token = tokens.next()) {
    const auto value = parse_number(*token);
    if (!value) return bad_line(line, in_quotes(*token) + " is not a number");
    values.push_back(*value);
  }
  return values;
}

std::optional<int> edge_of(const std::map<std::string, Numbers, std::less<>>& values, std::string_view key) {
  const auto found = values.find(key);
  if (found == values.end() || found->second.size() != 1) return std::nullopt;
  const double edge = found->second.front();
  return edge >= 1.0 && edge <= 16384.0 ? std::optional{static_cast<int>(edge)} : std::nullopt;
}

Result<Intrinsics> sensor_camera(const std::map<std::string, Numbers, std::less<>>& values, const std::string& name) {
  const auto matrix = values.find("m_calibration" + name + "Intrinsic");
  if (matrix == values.end()) {
    return Error{Errc::not_found, "m_calibration" + name + "Intrinsic is missing", {}};
  }
  SACCADE_TRY(Intrinsics intrinsics, intrinsics_of(matrix->second));
  std::string lower = name;
  lower[0] = static_cast<char>(lower[0] - 'A' + 'a');
  intrinsics.width = edge_of(values, "m_" + lower + "Width");
  intrinsics.height = edge_of(values, "m_" + lower + "Height");
  return intrinsics;
}

/// Returns an extrinsic matrix; the identity where there is none.
Result<Pose> sensor_pose(const std::map<std::string, Numbers, std::less<>>& values, const std::string& name) {
  const auto matrix = values.find("m_calibration" + name + "Extrinsic");
  if (matrix == values.end()) return Pose{Pose::Identity()};
  if (matrix->second.size() != 16) return Error{Errc::corrupt_data, matrix->first + " is not a 4x4 matrix", {}};
  return pose_of_rows(matrix->second);
}

Result<Numbers> json_numbers(const nlohmann::json& entry, const char* key, std::size_t count) {
  const auto found = entry.find(key);
  const bool is_list = found != entry.end() && found->is_array() && found->size() == count;
  Numbers values;
  for (std::size_t i = 0; is_list && i < count; ++i) {
    if ((*found)[i].is_number()) values.push_back((*found)[i].get<double>());
  }
  if (values.size() == count) return values;
  return Error{Errc::corrupt_data, std::string{key} + " is not a list of " + std::to_string(count) + " numbers", {}};
}

Result<BopCamera> bop_camera(const nlohmann::json& entry) {
  if (!entry.is_object()) return Error{Errc::corrupt_data, "the entry is not an object", {}};
  BopCamera camera;
  SACCADE_TRY(const Numbers k, json_numbers(entry, "cam_K", 9));
  SACCADE_TRY(camera.intrinsics, intrinsics_of(k));
  if (entry.contains("depth_scale")) {
    const double scale = entry["depth_scale"].is_number() ? entry["depth_scale"].get<double>() : 0.0;
    if (!(std::isfinite(scale) && scale > 0.0)) return Error{Errc::corrupt_data, "depth_scale must be positive", {}};
    camera.intrinsics.depth_units_per_m = kMillimetresPerMetre / scale;
  }
  if (!entry.contains("cam_R_w2c") && !entry.contains("cam_t_w2c")) return camera;
  SACCADE_TRY(const Numbers r, json_numbers(entry, "cam_R_w2c", 9));
  SACCADE_TRY(const Numbers t, json_numbers(entry, "cam_t_w2c", 3));
  SACCADE_TRY(const Pose T_camera_world,
              pose_of_rows({r[0], r[1], r[2], t[0] / kMillimetresPerMetre, r[3], r[4], r[5],
                            t[1] / kMillimetresPerMetre, r[6], r[7], r[8], t[2] / kMillimetresPerMetre}));
  camera.T_world_camera = T_camera_world.inverse();
  return camera;
}

}  // namespace

Result<Intrinsics> parse_opencv_camera(std::string_view text) {
  SACCADE_TRY(const YAML::Node node, load_opencv(text));
  try {
    if (!node["camera_matrix"]) return Error{Errc::corrupt_data, "camera_matrix is missing", {}};
    return opencv_intrinsics(node);
  } catch (const YamlProblem& problem) {
    return problem.error;
  } catch (const YAML::Exception& exception) {
    return yaml_error(exception);
  }
}

Result<std::optional<Pose>> parse_local_transform(std::string_view text) {
  SACCADE_TRY(const YAML::Node node, load_opencv(text));
  try {
    if (!node["local_transform"]) return std::optional<Pose>{};
    SACCADE_TRY(const Pose pose, pose_of_rows(matrix_numbers(node["local_transform"], 12)));
    return std::optional{pose};
  } catch (const YamlProblem& problem) {
    return problem.error;
  } catch (const YAML::Exception& exception) {
    return yaml_error(exception);
  }
}

Result<SensorInfo> parse_sensor_info(std::string_view text) {
  std::map<std::string, Numbers, std::less<>> values;
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    const auto pair = key_and_value(*line);
    if (!pair || pair->first == "m_sensorName" || !pair->first.starts_with("m_")) continue;
    SACCADE_TRY(values[std::string{pair->first}], numbers_of(pair->second, lines.line()));
  }
  SensorInfo info;
  SACCADE_TRY(info.depth, sensor_camera(values, "Depth"));
  if (const auto shift = values.find("m_depthShift"); shift != values.end()) {
    const bool is_scale = shift->second.size() == 1 && std::isfinite(shift->second[0]) && shift->second[0] > 0.0;
    if (!is_scale) return Error{Errc::corrupt_data, "m_depthShift, samples per metre, must be a positive number", {}};
    info.depth.depth_units_per_m = shift->second[0];
  }
  if (values.contains("m_calibrationColorIntrinsic")) {
    SACCADE_TRY(info.color, sensor_camera(values, "Color"));
  }
  SACCADE_TRY(const Pose T_body_depth, sensor_pose(values, "Depth"));
  SACCADE_TRY(const Pose T_body_color, sensor_pose(values, "Color"));
  info.T_color_depth = T_body_color.inverse() * T_body_depth;
  info.is_depth_off_body = !T_body_depth.isApprox(Pose::Identity(), 1e-6);
  return info;
}

Result<std::map<std::int64_t, Result<BopCamera>>> parse_bop_cameras(std::string_view text) {
  SACCADE_TRY(const nlohmann::json document, parse_json(text));
  if (!document.is_object()) return Error{Errc::corrupt_data, "an object with an entry per image is expected", {}};
  std::map<std::int64_t, Result<BopCamera>> cameras;
  for (const auto& [key, entry] : document.items()) {
    const auto number = parse_integer<std::int64_t>(key);
    if (!number) return Error{Errc::corrupt_data, "the key " + in_quotes(key) + " is not the number of an image", {}};
    auto camera = bop_camera(entry);
    if (!camera) {
      Error error = camera.error();
      error.context = "entry " + key;
      camera = error;
    }
    cameras.insert_or_assign(*number, std::move(camera));
  }
  return cameras;
}

}  // namespace saccade
