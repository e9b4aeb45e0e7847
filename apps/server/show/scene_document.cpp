// SPDX-License-Identifier: Apache-2.0
#include "server/show/scene_document.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "saccade/core/fnv1a.hpp"
#include "saccade/io/files/json_io.hpp"

namespace saccade::server {
namespace {

using nlohmann::json;

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

template <class T>
void append(std::vector<std::uint8_t>& bytes, std::span<const T> values) {
  const auto added = std::as_bytes(values);
  const auto* first = reinterpret_cast<const std::uint8_t*>(added.data());
  bytes.insert(bytes.end(), first, first + added.size());
}

void append_colors(std::vector<std::uint8_t>& bytes, std::span<const Rgb8> colors) {
  bytes.reserve(bytes.size() + 4 * colors.size());
  for (const Rgb8& color : colors) bytes.insert(bytes.end(), {color[0], color[1], color[2], 255});
}

std::string name_of(const std::vector<std::uint8_t>& bytes) {
  Fnv1a hash;
  std::size_t i{0};
  for (; i + sizeof(std::uint64_t) <= bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word{0};
    std::memcpy(&word, bytes.data() + i, sizeof word);
    hash.add(word);
  }
  for (; i < bytes.size(); ++i) hash.add(std::uint64_t{bytes[i]});
  return hash.text() + "-" + std::to_string(bytes.size());
}

std::shared_ptr<const LayerBuffer> buffer_of(std::vector<std::uint8_t> bytes) {
  std::string content = name_of(bytes);
  return std::make_shared<const LayerBuffer>(LayerBuffer{std::move(content), std::move(bytes)});
}

Layer layer_of(std::string id, std::string name, LayerKind kind, std::size_t count, std::vector<std::uint8_t> bytes) {
  Layer layer;
  layer.id = std::move(id);
  layer.name = std::move(name);
  layer.kind = kind;
  layer.count = count;
  layer.buffer = buffer_of(std::move(bytes));
  return layer;
}

std::string hex(const Rgb8& color) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", color[0], color[1], color[2]);
  return text.data();
}

json layer_json(const Layer& layer) {
  json out{{"id", layer.id},       {"name", layer.name},       {"kind", kLayerKindNames.of(layer.kind)},
           {"count", layer.count}, {"visible", layer.visible}, {"buffer", layer.buffer->name}};
  if (layer.step) out["step"] = *layer.step;
  if (layer.kind == LayerKind::views) {
    out["fov_rad"] = layer.fov_rad;
  } else {
    out["colors"] = layer.colors;
    if (!layer.colors) out["color"] = hex(layer.color);
  }
  if (layer.kind == LayerKind::triangles) out["vertices"] = layer.vertices;
  if (layer.size_m) out["size_m"] = *layer.size_m;
  if (layer.diameters) out["diameters"] = true;
  if (layer.fields) {
    out["fields"] = json::array();
    for (const LayerField& field : *layer.fields) {
      out["fields"].push_back({{"name", field.name}, {"width", field.width}, {"buffer", field.buffer->name}});
    }
  }
  if (layer.opacity < 1.0) out["opacity"] = layer.opacity;
  if (layer.holds_camera) out["holds_camera"] = true;
  for (const LegendEntry& entry : layer.legend) out["legend"].push_back({entry.text, hex(entry.color)});
  return out;
}

json step_json(const Step& step) {
  json out{{"name", step.name},
           {"T_world_camera", step.T_world_camera ? pose_to_json(*step.T_world_camera) : json(nullptr)},
           {"fov_rad", step.fov_rad},
           {"facts", step.facts},
           {"pictures", json::array()}};
  for (const StepPicture& picture : step.pictures) {
    out["pictures"].push_back({{"name", picture.name}, {"title", picture.title}});
  }
  return out;
}

json frame_of(const SceneDocument& document) {
  const Box& box = document.bounds;
  json out{{"title", document.title},
           {"kind", to_string(document.kind)},
           {"live", document.live},
           {"up", {document.up.x(), document.up.y(), document.up.z()}},
           {"bounds", {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()}},
           {"facts", document.facts},
           {"layers", json::array()},
           {"steps", json::array()}};
  if (document.towards_viewer) {
    const Eigen::Vector3d& towards = *document.towards_viewer;
    out["towards_viewer"] = {towards.x(), towards.y(), towards.z()};
  }
  return out;
}

}  // namespace

json document_json(const SceneDocument& document) {
  json out = frame_of(document);
  out["report"] = !document.record.is_null();
  for (const Layer& layer : document.layers) out["layers"].push_back(layer_json(layer));
  for (const Step& step : document.steps) out["steps"].push_back(step_json(step));
  return out;
}

json summary_json(const SceneDocument& document) {
  json out = frame_of(document);
  for (const Layer& layer : document.layers) {
    json shown{{"name", layer.name},
               {"kind", kLayerKindNames.of(layer.kind)},
               {"count", layer.count},
               {"bytes", layer.buffer->bytes.size()}};
    if (layer.step) shown["step"] = *layer.step;
    out["layers"].push_back(std::move(shown));
  }
  for (const Step& step : document.steps) out["steps"].push_back(step_json(step));
  return out;
}

Layer triangles_layer(std::string id, std::string name, const TriangleMesh& mesh) {
  SACCADE_EXPECTS(mesh.colors.empty() || mesh.colors.size() == mesh.vertices.size());
  std::vector<std::uint8_t> bytes;
  append(bytes, std::span{mesh.vertices});
  append_colors(bytes, mesh.colors);
  append(bytes, std::span{mesh.triangles});
  Layer layer = layer_of(std::move(id), std::move(name), LayerKind::triangles, mesh.triangles.size(), std::move(bytes));
  layer.vertices = mesh.vertices.size();
  layer.colors = !mesh.colors.empty();
  return layer;
}

Layer points_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> points,
                   std::span<const Rgb8> colors) {
  SACCADE_EXPECTS(colors.empty() || colors.size() == points.size());
  std::vector<std::uint8_t> bytes;
  append(bytes, points);
  append_colors(bytes, colors);
  Layer layer = layer_of(std::move(id), std::move(name), LayerKind::points, points.size(), std::move(bytes));
  layer.colors = !colors.empty();
  return layer;
}

Layer discs_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> points,
                  std::span<const Rgb8> colors, std::span<const float> diameters_m) {
  SACCADE_EXPECTS(diameters_m.size() == points.size());
  Layer layer = points_layer(std::move(id), std::move(name), points, colors);
  std::vector<std::uint8_t> bytes = layer.buffer->bytes;
  append(bytes, diameters_m);
  layer.buffer = buffer_of(std::move(bytes));
  layer.diameters = true;
  layer.size_m = 1.0;
  return layer;
}

LayerField layer_field(std::string name, int width, std::span<const float> values) {
  std::vector<std::uint8_t> bytes;
  append(bytes, values);
  return {std::move(name), width, buffer_of(std::move(bytes))};
}

Layer voxels_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> centers, double size_m) {
  Layer layer = points_layer(std::move(id), std::move(name), centers);
  layer.kind = LayerKind::voxels;
  layer.size_m = size_m;
  return layer;
}

Layer lines_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> ends,
                  std::span<const Rgb8> colors) {
  SACCADE_EXPECTS(ends.size() % 2 == 0);
  Layer layer = points_layer(std::move(id), std::move(name), ends, colors);
  layer.kind = LayerKind::lines;
  layer.count = ends.size() / 2;
  return layer;
}

Layer views_layer(std::string id, std::string name, std::span<const Pose> T_world_camera, std::span<const double> gains,
                  const std::array<double, 2>& fov_rad) {
  SACCADE_EXPECTS(gains.size() == T_world_camera.size());
  std::vector<float> numbers;
  numbers.reserve(17 * gains.size());
  for (const Pose& pose : T_world_camera) {
    const Eigen::Matrix<float, 4, 4, Eigen::RowMajor> rows = pose.matrix().cast<float>();
    numbers.insert(numbers.end(), rows.data(), rows.data() + rows.size());
  }
  for (const double gain : gains) numbers.push_back(static_cast<float>(gain));
  std::vector<std::uint8_t> bytes;
  append(bytes, std::span<const float>{numbers});
  Layer layer = layer_of(std::move(id), std::move(name), LayerKind::views, gains.size(), std::move(bytes));
  layer.fov_rad = fov_rad;
  return layer;
}

Layer box_layer(std::string id, std::string name, const Box& box) {
  std::vector<Eigen::Vector3f> ends;
  const auto corner = [&box](unsigned i) {
    return Eigen::Vector3d{(i & 1U) != 0 ? box.max.x() : box.min.x(), (i & 2U) != 0 ? box.max.y() : box.min.y(),
                           (i & 4U) != 0 ? box.max.z() : box.min.z()};
  };
  for (unsigned from = 0; from < 8; ++from) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((from & axis) != 0) continue;
      ends.emplace_back(corner(from).cast<float>());
      ends.emplace_back(corner(from | axis).cast<float>());
    }
  }
  return lines_layer(std::move(id), std::move(name), ends);
}

std::array<double, 2> fov_of(const PinholeCamera& camera) {
  const auto angle = [](double focal_px, double center_px, int size_px) {
    return std::atan((center_px + 0.5) / focal_px) + std::atan((size_px - 0.5 - center_px) / focal_px);
  };
  return {angle(camera.fx, camera.cx, camera.width), angle(camera.fy, camera.cy, camera.height)};
}

Box bounds_of_points(std::span<const Eigen::Vector3f> points) {
  constexpr double kLeast_m{1e-3};
  constexpr double kInfinity{std::numeric_limits<double>::infinity()};
  Box box{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
  for (const Eigen::Vector3f& point : points) {
    if (!point.allFinite()) continue;
    box.min = box.min.cwiseMin(point.cast<double>());
    box.max = box.max.cwiseMax(point.cast<double>());
  }
  if (!box.min.allFinite()) return {Eigen::Vector3d::Constant(-0.5), Eigen::Vector3d::Constant(0.5)};
  box.max = box.max.cwiseMax(box.min + Eigen::Vector3d::Constant(kLeast_m));
  return box;
}

}  // namespace saccade::server
