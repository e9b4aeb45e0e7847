// SPDX-License-Identifier: Apache-2.0
#include "server/show/view_record.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "saccade/io/atomic_file.hpp"
#include "saccade/io/camera_io.hpp"
#include "saccade/io/json_io.hpp"

namespace saccade::server {
namespace {

using nlohmann::json;

constexpr const char* kViewSchema{"saccade-view/1"};

json point_of(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

Eigen::Vector3d point_from(const json& value) {
  const auto p = value.get<std::array<double, 3>>();
  return {p[0], p[1], p[2]};
}

json region_json(const Region& region) {
  if (const auto* sphere = std::get_if<Sphere>(&region)) {
    return {{"sphere", {{"center", point_of(sphere->center)}, {"radius_m", sphere->radius_m}}}};
  }
  if (const auto* box = std::get_if<Box>(&region)) {
    return {{"box", {{"min", point_of(box->min)}, {"max", point_of(box->max)}}}};
  }
  const auto& cylinder = std::get<Cylinder>(region);
  return {{"cylinder",
           {{"base", point_of(cylinder.base)}, {"top", point_of(cylinder.top)}, {"radius_m", cylinder.radius_m}}}};
}

Region region_from(const json& value) {
  if (value.contains("sphere")) {
    return Sphere{point_from(value["sphere"].at("center")), value["sphere"].at("radius_m").get<double>()};
  }
  if (value.contains("box")) return Box{point_from(value["box"].at("min")), point_from(value["box"].at("max"))};
  const json& cylinder = value.at("cylinder");
  return Cylinder{point_from(cylinder.at("base")), point_from(cylinder.at("top")),
                  cylinder.at("radius_m").get<double>()};
}

PinholeCamera camera_from(const json& value) {
  PinholeCamera camera;
  camera.width = value.at("width").get<int>();
  camera.height = value.at("height").get<int>();
  camera.fx = value.at("fx").get<double>();
  camera.fy = value.at("fy").get<double>();
  camera.cx = value.at("cx").get<double>();
  camera.cy = value.at("cy").get<double>();
  camera.min_range_m = value.at("min_range_m").get<double>();
  camera.max_range_m = value.at("max_range_m").get<double>();
  return camera;
}

Result<ViewRecord> record_from(const json& document) {
  ViewRecord record;
  record.view = document.at("view").get<std::size_t>();
  record.region = region_from(document.at("region"));
  record.sensor = camera_from(document.at("sensor"));
  for (const json& pose : document.at("candidates")) {
    SACCADE_TRY(const Pose T_world_candidate, pose_from_json(pose));
    record.T_world_candidates.push_back(T_world_candidate);
  }
  for (const json& gain : document.at("gains")) {
    record.gains.push_back(gain.is_null() ? std::numeric_limits<double>::quiet_NaN() : gain.get<double>());
  }
  record.saliency = document.at("saliency").get<std::vector<double>>();
  if (!document.at("segment").is_null()) record.segment = document.at("segment").get<std::uint32_t>();
  for (const json& place : document.at("path")) record.path.push_back(point_from(place));
  if (record.gains.size() != record.T_world_candidates.size()) {
    return Error{Errc::corrupt_data, "there must be one gain per candidate", ""};
  }
  SACCADE_CHECK(validate(record.region));
  SACCADE_CHECK(record.sensor.validate());
  constexpr int kMostPixels{8192};
  if (record.sensor.width > kMostPixels || record.sensor.height > kMostPixels) {
    return Error{Errc::corrupt_data, "the sensor has too many pixels", ""};
  }
  return record;
}

}  // namespace

std::string view_file(std::size_t view, const std::string& suffix) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "view-%02zu", view);
  return number.data() + suffix;
}

Status write_view_record(const std::filesystem::path& folder, const ViewRecord& record) {
  json document{{"schema", kViewSchema},
                {"view", record.view},
                {"region", region_json(record.region)},
                {"sensor", camera_to_json(record.sensor)},
                {"candidates", json::array()},
                {"gains", record.gains},
                {"saliency", record.saliency},
                {"segment", record.segment ? json(*record.segment) : json(nullptr)},
                {"path", json::array()}};
  for (const Pose& pose : record.T_world_candidates) document["candidates"].push_back(pose_to_json(pose));
  for (const Eigen::Vector3d& place : record.path) document["path"].push_back(point_of(place));
  return write_file_atomically(folder / view_file(record.view, ".json"), document.dump() + "\n");
}

Result<ViewRecord> read_view_record(const std::filesystem::path& folder, std::size_t view) {
  const std::filesystem::path path = folder / view_file(view, ".json");
  SACCADE_TRY(const json document, read_json(path));
  try {
    if (document.at("schema") != kViewSchema) {
      return Error{Errc::unsupported, "is of another version", path.string()};
    }
    auto record = record_from(document);
    if (!record) return Error{Errc::corrupt_data, record.error().message, path.string()};
    return record;
  } catch (const json::exception& e) {
    return Error{Errc::corrupt_data, e.what(), path.string()};
  }
}

}  // namespace saccade::server
