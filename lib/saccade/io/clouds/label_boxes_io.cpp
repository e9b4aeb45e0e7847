// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/label_boxes_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr double kAligned{0.99985};  // cosine of 1°

const NamedLabel* definition_of(std::uint32_t label, std::span<const NamedLabel> names) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const NamedLabel& n) { return n.number == label; });
  return found == names.end() ? nullptr : &*found;
}

nlohmann::json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::json json_of(const LabelBox& box, std::span<const NamedLabel> names, const Eigen::Vector3d& offset_m) {
  const NamedLabel* label = definition_of(box.label, names);
  nlohmann::json made{{"label", box.label},
                      {"name", label != nullptr ? label->name : ""},
                      {"class", label != nullptr ? label->class_name : ""},
                      {"instance", label != nullptr ? label->instance : 0},
                      {"points", box.points},
                      {"center_m", numbers(box.center_m + offset_m)},
                      {"size_m", numbers(box.size_m)},
                      {"yaw_rad", nullptr}};
  made["axes"] = {numbers(box.axes.col(0)), numbers(box.axes.col(1)), numbers(box.axes.col(2))};
  if (box.axes(2, 2) > kAligned) made["yaw_rad"] = std::atan2(box.axes(1, 0), box.axes(0, 0));
  return made;
}

/// Returns the rotation from the cloud's frame to a camera's: x right, y down, z forward.
Result<Eigen::Matrix3d> camera_axes(const LabelBox& box) {
  if (box.axes(2, 2) > kAligned) {  // a laser scanner's frame: x forward, y left, z up
    Eigen::Matrix3d axes;
    axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    return axes;
  }
  if (box.axes(1, 2) < -kAligned) return Eigen::Matrix3d{Eigen::Matrix3d::Identity()};
  return Error{Errc::unsupported,
               "KITTI's boxes stand upright in the cloud's frame, but up is neither its z nor its -y here; write .json",
               {}};
}

std::string type_of(const LabelBox& box, std::span<const NamedLabel> names) {
  const NamedLabel* label = definition_of(box.label, names);
  std::string type = label == nullptr ? "" : label->class_name.empty() ? label->name : label->class_name;
  if (type.empty()) type = std::to_string(box.label);
  for (char& c : type) c = static_cast<unsigned char>(c) <= ' ' ? '_' : c;
  return type;
}

Result<std::string> kitti_line(const LabelBox& box, std::span<const NamedLabel> names,
                               const Eigen::Vector3d& offset_m) {
  SACCADE_TRY(const Eigen::Matrix3d to_camera, camera_axes(box));
  const Eigen::Vector3d bottom = to_camera * (box.center_m + offset_m - 0.5 * box.size_m.z() * box.axes.col(2));
  const Eigen::Vector3d length = to_camera * box.axes.col(0);
  const double rotation_y = std::atan2(-length.z(), length.x());
  const double alpha = std::remainder(rotation_y - std::atan2(bottom.x(), bottom.z()), 2.0 * std::numbers::pi);
  std::array<char, 256> numbers{};
  std::snprintf(numbers.data(), numbers.size(), " -1 -1 %.4f -1 -1 -1 -1 %.4f %.4f %.4f %.4f %.4f %.4f %.4f\n", alpha,
                box.size_m.z(), box.size_m.y(), box.size_m.x(), bottom.x(), bottom.y(), bottom.z(), rotation_y);
  return type_of(box, names) + numbers.data();
}

}  // namespace

Status check_label_boxes_path(const fs::path& path) {
  if (path.extension() == ".json" || path.extension() == ".txt") return {};
  return Error{Errc::invalid_argument, "boxes are written as .json, or as .txt in KITTI's format", path.string()};
}

Status write_label_boxes(const fs::path& path, std::span<const LabelBox> boxes, std::span<const NamedLabel> names,
                         const Eigen::Vector3d& offset_m) {
  SACCADE_CHECK(check_label_boxes_path(path));
  if (path.extension() == ".json") {
    nlohmann::json made{{"schema", "saccade-boxes-1"}, {"boxes", nlohmann::json::array()}};
    for (const LabelBox& box : boxes) made["boxes"].push_back(json_of(box, names, offset_m));
    return write_file_atomically(path, made.dump(1) + "\n");
  }
  std::string text;
  for (const LabelBox& box : boxes) {
    SACCADE_TRY(const std::string line, in_file(kitti_line(box, names, offset_m), path));
    text += line;
  }
  return write_file_atomically(path, text);
}

}  // namespace saccade
