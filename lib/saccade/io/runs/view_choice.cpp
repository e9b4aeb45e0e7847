// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/runs/run_json.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"

namespace saccade {
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

Status read_candidates(const json& document, ViewChoice& choice) {
  const json& gains = document.at("gains");
  for (const json& pose : document.at("candidates")) {
    SACCADE_TRY(const Pose T_world_candidate, pose_from_json(pose));
    choice.candidates.push_back({T_world_candidate});
  }
  if (gains.size() != choice.candidates.size()) {
    return Error{Errc::corrupt_data, "there must be one gain per candidate", ""};
  }
  for (std::size_t i = 0; i < gains.size(); ++i) {
    if (!gains[i].is_null()) choice.candidates[i].gain = gains[i].get<double>();
  }
  return {};
}

Result<ViewRecord> record_from(const json& document) {
  ViewChoice choice;
  choice.region = region_from(document.at("region"));
  choice.sensor = camera_from(document.at("sensor"));
  SACCADE_CHECK(read_candidates(document, choice));
  choice.saliency = document.at("saliency").get<std::vector<double>>();
  if (!document.at("segment").is_null()) choice.segment = document.at("segment").get<std::uint32_t>();
  SACCADE_CHECK(validate(choice.region));
  SACCADE_CHECK(choice.sensor.validate());
  constexpr int kMostPixels{8192};
  if (choice.sensor.width > kMostPixels || choice.sensor.height > kMostPixels) {
    return Error{Errc::corrupt_data, "the sensor has too many pixels", ""};
  }
  ViewRecord record;
  for (const json& place : document.at("path")) record.path.push_back(point_from(place));
  record.choice = std::make_shared<const ViewChoice>(std::move(choice));
  return record;
}

}  // namespace

std::string view_file(std::size_t view, const std::string& suffix) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "view-%02zu", view);
  return number.data() + suffix;
}

Status write_view_choice(const std::filesystem::path& folder, std::size_t view, const ViewRecord& record) {
  SACCADE_EXPECTS(record.choice != nullptr);
  const ViewChoice& choice = *record.choice;
  json document{{"schema", kViewSchema},
                {"view", view},
                {"region", region_json(choice.region)},
                {"sensor", camera_to_json(choice.sensor)},
                {"candidates", json::array()},
                {"gains", json::array()},
                {"saliency", choice.saliency},
                {"segment", choice.segment ? json(*choice.segment) : json(nullptr)},
                {"path", json::array()}};
  for (const RankedView& candidate : choice.candidates) {
    document["candidates"].push_back(pose_to_json(candidate.T_world_camera));
    document["gains"].push_back(candidate.gain);
  }
  for (const Eigen::Vector3d& place : record.path) document["path"].push_back(point_of(place));
  return write_file_atomically(folder / view_file(view, ".json"), document.dump() + "\n");
}

Result<ViewRecord> read_view_choice(const std::filesystem::path& folder, std::size_t view) {
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
    return Error{Errc::corrupt_data, message_of(e), path.string()};
  }
}

}  // namespace saccade
