// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/internal/azure_kinect.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/depth_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/internal/image_mapping.hpp"
#include "saccade/io/frames/internal/rgbd_layout.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile{"calibration.json"};

/// Mode of the depth camera: pixels of its sensor (binned or not), and the part of them that it gives.
struct DepthMode {
  int width;
  int height;
  int sensor_edge;
  int first_u;
  int first_v;
};
constexpr std::array<DepthMode, 4> kDepthModes{
    {{640, 576, 1024, 192, 180}, {320, 288, 512, 96, 90}, {512, 512, 512, 0, 0}, {1024, 1024, 1024, 0, 0}}};

Error bad_file(std::string what) { return {Errc::corrupt_data, std::move(what), {}}; }

/// Returns the member of a JSON object, or null.
const nlohmann::json& member(const nlohmann::json& object, const char* key) {
  static const nlohmann::json null;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found == object.end() ? null : *found;
}

Result<std::vector<double>> numbers(const nlohmann::json& list, std::size_t least, const std::string& name) {
  std::vector<double> values;
  const bool is_list = list.is_array() && list.size() >= least;
  for (std::size_t i = 0; is_list && i < list.size(); ++i) {
    if (list[i].is_number() && std::isfinite(list[i].get<double>())) values.push_back(list[i].get<double>());
  }
  if (is_list && values.size() == list.size()) return values;
  return bad_file(name + " is not a list of at least " + std::to_string(least) + " numbers");
}

Result<Pose> pose_of(const nlohmann::json& rt, const std::string& name) {
  SACCADE_TRY(const auto rotation, numbers(member(rt, "Rotation"), 9, name + ": Rt.Rotation"));
  SACCADE_TRY(const auto translation, numbers(member(rt, "Translation"), 3, name + ": Rt.Translation"));
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < 9; ++i) {
    matrix(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = rotation[i];
  }
  for (std::size_t i = 0; i < 3; ++i) matrix(static_cast<Eigen::Index>(i), 3) = translation[i];
  return pose_from_matrix(matrix);
}

/// Reads the camera at a location. Its parameters are cx, cy, fx, fy, k1 to k6, the lens' centre, p2 and p1.
Result<AzureKinectCamera> camera_at(const nlohmann::json& cameras, const std::string& location) {
  for (const nlohmann::json& entry : cameras) {
    if (member(entry, "Location") != location) continue;
    const nlohmann::json& intrinsics = member(entry, "Intrinsics");
    const nlohmann::json& model = member(intrinsics, "ModelType");
    if (model != "CALIBRATION_LensDistortionModelBrownConrady") {
      return Error{
          Errc::unsupported, location + ": the lens model " + model.dump().substr(0, 80) + " is not known", {}};
    }
    SACCADE_TRY(const auto p, numbers(member(intrinsics, "ModelParameters"), 14, location + ": ModelParameters"));
    AzureKinectCamera camera{
        p[0], p[1], p[2], p[3], Distortion{p[4], p[5], p[13], p[12], p[6], p[7], p[8], p[9]}, Pose::Identity()};
    const auto is_sound = [](double value) { return value > 0.0 && value < 10.0; };
    if (!is_sound(camera.fx) || !is_sound(camera.fy) || !is_sound(camera.cx) || !is_sound(camera.cy)) {
      return bad_file(location + ": focal lengths and centre must be within 0 and 10 sensor widths");
    }
    SACCADE_TRY(camera.T_camera_device, pose_of(member(entry, "Rt"), location));
    return camera;
  }
  return bad_file("there is no camera " + location);
}

Intrinsics on_sensor(const AzureKinectCamera& camera, double sensor_width, double sensor_height, double first_u,
                     double first_v) {
  Intrinsics intrinsics;
  intrinsics.fx = camera.fx * sensor_width;
  intrinsics.fy = camera.fy * sensor_height;
  intrinsics.cx = camera.cx * sensor_width - first_u - 0.5;  // ours counts from the middle of the first pixel
  intrinsics.cy = camera.cy * sensor_height - first_v - 0.5;
  intrinsics.distortion = camera.lens;
  return intrinsics;
}

/// Returns the size of the first image that can be read.
template <class Read>
std::optional<std::pair<int, int>> first_size(const RgbdListing& listing, Read read) {
  constexpr std::size_t kMostTried{100};
  std::size_t tried = 0;
  for (const RgbdFrameFiles& frame : listing.frames) {
    const auto size = read(frame);
    if (size || ++tried == kMostTried) return size;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Intrinsics> AzureKinectCalibration::of_depth_images(int width, int height) const {
  for (const DepthMode& mode : kDepthModes) {
    if (mode.width != width || mode.height != height) continue;
    Intrinsics intrinsics = on_sensor(depth, mode.sensor_edge, mode.sensor_edge, mode.first_u, mode.first_v);
    intrinsics.width = width;
    intrinsics.height = height;
    return intrinsics;
  }
  return std::nullopt;
}

std::optional<Intrinsics> AzureKinectCalibration::of_color_images(int width, int height) const {
  const bool is_whole = 4 * height == 3 * width;
  const bool is_middle = 16 * height == 9 * width;
  if (!is_whole && !is_middle) return std::nullopt;
  const double sensor_height = 0.75 * width;
  Intrinsics intrinsics = on_sensor(color, width, sensor_height, 0.0, 0.5 * (sensor_height - height));
  intrinsics.width = width;
  intrinsics.height = height;
  return intrinsics;
}

bool is_azure_kinect_calibration(std::string_view text) {
  return text.find("\"CalibrationInformation\"") != std::string_view::npos;
}

Result<AzureKinectCalibration> parse_azure_kinect_calibration(std::string_view text) {
  SACCADE_TRY(const nlohmann::json document, parse_json(text));
  const nlohmann::json& cameras = member(member(document, "CalibrationInformation"), "Cameras");
  if (!cameras.is_array()) return bad_file("CalibrationInformation has no list of Cameras");
  AzureKinectCalibration calibration;
  SACCADE_TRY(calibration.depth, camera_at(cameras, "CALIBRATION_CameraLocationD0"));
  SACCADE_TRY(calibration.color, camera_at(cameras, "CALIBRATION_CameraLocationPV0"));
  return calibration;
}

Status complete_open3d(const fs::path& folder, const RgbdLayoutRule& /*rule*/, const RgbdFolderConfig& config,
                       RgbdListing& listing) {
  const fs::path path = folder / kFile;
  std::error_code ignored;
  if (config.intrinsics || !fs::is_regular_file(path, ignored) || has_intrinsics_file(folder)) return {};
  SACCADE_TRY(const std::string text, read_text_file(path));
  if (!is_azure_kinect_calibration(text)) return {};
  SACCADE_TRY(const AzureKinectCalibration calibration, in_file(parse_azure_kinect_calibration(text), path));
  const auto depth_size = first_size(listing, [](const RgbdFrameFiles& frame) -> std::optional<std::pair<int, int>> {
    const auto image = frame.depth ? read_depth_image(*frame.depth, {{1000.0, false}, UnitsSource::given})
                                   : Result<DepthImage>{Error{Errc::not_found, "", {}}};
    return image ? std::optional{std::pair{image->width(), image->height()}} : std::nullopt;
  });
  if (!depth_size) return {};  // opening the folder says why
  const auto [width, height] = *depth_size;
  listing.intrinsics_from = path.string();
  listing.intrinsics = calibration.of_depth_images(width, height);
  if (!listing.intrinsics) {  // depths that were moved onto the colour camera
    listing.intrinsics = calibration.of_color_images(width, height);
    if (listing.intrinsics) return {};
    return Error{Errc::size_mismatch,
                 "is of an Azure Kinect, which has no depth images of " + size_text(width, height) +
                     "; expected are 640x576, 320x288, 512x512 and 1024x1024, or a size of its colours",
                 path.string()};
  }
  const auto color_size = first_size(listing, [](const RgbdFrameFiles& frame) -> std::optional<std::pair<int, int>> {
    const auto image = frame.color ? read_color(*frame.color) : Result<ColorImage>{Error{Errc::not_found, "", {}}};
    return image ? std::optional{std::pair{image->width(), image->height()}} : std::nullopt;
  });
  const bool is_aligned = color_size == depth_size;  // colours that were moved onto the depth camera
  if (!color_size || is_aligned) return {};
  listing.color_intrinsics = calibration.of_color_images(color_size->first, color_size->second);
  listing.T_color_depth = calibration.color.T_camera_device * calibration.depth.T_camera_device.inverse();
  return {};
}

}  // namespace saccade
