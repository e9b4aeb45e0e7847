// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/camera_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/internal/calibration.hpp"

namespace saccade {
namespace {

Error bad_intrinsics(std::string what) { return {Errc::corrupt_data, std::move(what), "camera intrinsics"}; }

Result<Intrinsics> checked(Intrinsics intrinsics) {
  const bool finite = std::isfinite(intrinsics.fx) && std::isfinite(intrinsics.fy) && std::isfinite(intrinsics.cx) &&
                      std::isfinite(intrinsics.cy);
  if (!finite || intrinsics.fx == 0.0 || intrinsics.fy == 0.0) {
    return bad_intrinsics("focal lengths must not be 0, and they and the principal point must be finite");
  }
  return intrinsics;
}

/// Reads K row by row.
Result<Intrinsics> from_matrix(const std::array<double, 9>& k) {
  constexpr double kTolerance{1e-6};
  const bool shape = std::abs(k[3]) < kTolerance && std::abs(k[6]) < kTolerance && std::abs(k[7]) < kTolerance &&
                     std::abs(k[8] - 1.0) < kTolerance;
  if (!shape) return bad_intrinsics("not of the form [fx 0 cx; 0 fy cy; 0 0 1]");
  if (!(std::abs(k[1]) < 1e-3 * std::abs(k[0]))) return bad_intrinsics("a skewed camera is not supported");
  return checked({k[0], k[4], k[2], k[5], {}, {}, {}, {}, {}});
}

Status read_number(const nlohmann::json& object, const char* key, std::optional<double>& out) {
  if (!object.contains(key)) return {};
  if (!object[key].is_number()) return bad_intrinsics(std::string{key} + " is not a number");
  out = object[key].get<double>();
  return {};
}

Status read_size(const nlohmann::json& object, const char* key, std::optional<int>& out) {
  if (!object.contains(key)) return {};
  const nlohmann::json& value = object[key];
  if (!value.is_number_integer() || value.get<std::int64_t>() <= 0 || value.get<std::int64_t>() > kMaxImageEdge) {
    return bad_intrinsics(std::string{key} + " must be an integer within 1 and " + std::to_string(kMaxImageEdge));
  }
  out = value.get<int>();
  return {};
}

Result<Distortion> distortion_from_json(const nlohmann::json& object) {
  if (!object.is_object()) return bad_intrinsics("distortion must be an object with k1, k2, p1, p2, k3, k4, k5, k6");
  Distortion distortion;
  const std::array<std::pair<const char*, double*>, Distortion::kMaxCoefficients> fields{{{"k1", &distortion.k1},
                                                                                          {"k2", &distortion.k2},
                                                                                          {"p1", &distortion.p1},
                                                                                          {"p2", &distortion.p2},
                                                                                          {"k3", &distortion.k3},
                                                                                          {"k4", &distortion.k4},
                                                                                          {"k5", &distortion.k5},
                                                                                          {"k6", &distortion.k6}}};
  for (const auto& [key, target] : fields) {
    std::optional<double> value;
    SACCADE_CHECK(read_number(object, key, value));
    *target = value.value_or(0.0);
  }
  return distortion;
}

Result<Intrinsics> open3d_matrix(const nlohmann::json& columns) {
  if (!columns.is_array() || columns.size() != 9) return bad_intrinsics("intrinsic_matrix must hold nine numbers");
  std::array<double, 9> rows{};
  for (std::size_t i = 0; i < 9; ++i) {
    if (!columns[i].is_number()) return bad_intrinsics("intrinsic_matrix must hold nine numbers");
    rows[(i % 3) * 3 + i / 3] = columns[i].get<double>();
  }
  return from_matrix(rows);
}

Result<Intrinsics> focal_lengths(const nlohmann::json& object) {
  std::array<std::optional<double>, 4> values;
  constexpr std::array<const char*, 4> kKeys{"fx", "fy", "cx", "cy"};
  for (std::size_t i = 0; i < 4; ++i) {
    SACCADE_CHECK(read_number(object, kKeys[i], values[i]));
    if (!values[i]) return bad_intrinsics(std::string{"the key "} + kKeys[i] + " is missing");
  }
  return checked({*values[0], *values[1], *values[2], *values[3], {}, {}, {}, {}, {}});
}

/// Reads "scale" of NICE-SLAM, samples per metre, or "depth_scale", which others write either way.
Status read_depth_scale(const nlohmann::json& object, std::optional<double>& units_per_m) {
  constexpr double kLeastPerMetre{100.0};
  constexpr double kMostMetres{0.05};
  std::optional<double> scale;
  SACCADE_CHECK(read_number(object, "scale", units_per_m));
  SACCADE_CHECK(read_number(object, "depth_scale", scale));
  if (units_per_m && !(std::isfinite(*units_per_m) && *units_per_m > 0.0))
    return bad_intrinsics("scale must be positive");
  if (!scale) return {};
  if (std::isfinite(*scale) && *scale >= kLeastPerMetre) {
    units_per_m = *scale;
  } else if (*scale > 0.0 && *scale < kMostMetres) {
    units_per_m = 1.0 / *scale;
  } else {
    return bad_intrinsics("depth_scale of " + nlohmann::json(*scale).dump() +
                          " is neither samples per metre (1000) nor metres per sample (0.001); correct it there, or "
                          "pass --intrinsics and --depth-scale");
  }
  return {};
}

Result<Intrinsics> from_json(std::string_view text) {
  SACCADE_TRY(const nlohmann::json document, parse_json(text));
  const bool is_wrapped = document.is_object() && document.contains("camera") && document["camera"].is_object();
  const nlohmann::json& object = is_wrapped ? document["camera"] : document;
  if (!object.is_object()) return bad_intrinsics("a JSON object is needed");
  SACCADE_TRY(Intrinsics intrinsics,
              object.contains("intrinsic_matrix") ? open3d_matrix(object["intrinsic_matrix"]) : focal_lengths(object));
  SACCADE_CHECK(read_size(object, "width", intrinsics.width));
  SACCADE_CHECK(read_size(object, "height", intrinsics.height));
  SACCADE_CHECK(read_size(object, "w", intrinsics.width));
  SACCADE_CHECK(read_size(object, "h", intrinsics.height));
  SACCADE_CHECK(read_depth_scale(object, intrinsics.depth_units_per_m));
  SACCADE_CHECK(read_number(object, "min_range_m", intrinsics.min_range_m));
  SACCADE_CHECK(read_number(object, "max_range_m", intrinsics.max_range_m));
  if (object.contains("distortion")) {
    SACCADE_TRY(intrinsics.distortion, distortion_from_json(object["distortion"]));
  }
  return intrinsics;
}

/// Returns the numbers of a text in order, without comments.
Result<std::vector<double>> all_numbers(std::string_view text) {
  std::vector<double> values;
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    TokenScanner tokens{*line, " \t,;"};
    while (const auto token = tokens.next()) {
      if (token->front() == '#') break;
      const auto value = parse_number(*token);
      if (!value) {
        return Error{Errc::corrupt_data, in_quotes(*token) + " is not a number",
                     "camera intrinsics, line " + std::to_string(lines.line())};
      }
      values.push_back(*value);
    }
  }
  return values;
}

/// Commented title and the lines under it.
struct Section {
  std::string title;
  std::string body;
  std::size_t line{0};
};

std::vector<Section> sections_of(std::string_view text) {
  std::vector<Section> sections;
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    if (!line->empty() && line->front() == '#') {
      sections.push_back({std::string{*line}, {}, lines.line()});
    } else if (!sections.empty()) {
      sections.back().body.append(*line).push_back('\n');
    }
  }
  return sections;
}

/// Returns "frame-000003" from "... for frame-000003".
std::optional<std::string> frame_name(const std::string& title) {
  const std::size_t begin = title.rfind("frame-");
  if (begin == std::string::npos) return std::nullopt;
  const std::size_t end = title.find_first_of(" \t\r", begin);
  return title.substr(begin, end == std::string::npos ? end : end - begin);
}

Error at_section(Error error, const Section& section) {
  error.context = "section at line " + std::to_string(section.line);
  return error;
}

Status add_section(CamInfo& info, const Section& section) {
  const bool color = section.title.find("Color camera intrinsic") != std::string::npos;
  const bool depth = section.title.find("Depth camera intrinsic") != std::string::npos;
  if (color || depth) {
    auto intrinsics = parse_intrinsics(section.body);
    if (!intrinsics) return at_section(intrinsics.error(), section);
    (color ? info.color : info.depth) = *intrinsics;
    return {};
  }
  const auto name = frame_name(section.title);
  if (!name) return {};
  const auto poses = parse_pose_list(section.body);
  if (!poses) return at_section(poses.error(), section);
  if (poses->size() != 1) {
    return at_section({Errc::corrupt_data, "one 4x4 matrix expected for " + *name, {}}, section);
  }
  info.T_world_camera.insert_or_assign(*name, poses->front());
  return {};
}

}  // namespace

Result<PinholeCamera> Intrinsics::camera(int image_width, int image_height) const {
  if ((width && *width != image_width) || (height && *height != image_height)) {
    return Error{Errc::size_mismatch,
                 "they are for images of " + std::to_string(width.value_or(image_width)) + "x" +
                     std::to_string(height.value_or(image_height)) + ", the images are " + std::to_string(image_width) +
                     "x" + std::to_string(image_height),
                 "camera intrinsics"};
  }
  if (fx < 0.0 || fy < 0.0) {
    return Error{Errc::unsupported, "a negative focal length mirrors an axis of the image, which is not possible here",
                 "camera intrinsics"};
  }
  PinholeCamera camera;
  camera.width = image_width;
  camera.height = image_height;
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
  camera.min_range_m = min_range_m.value_or(kRecordedMinRange_m);
  camera.max_range_m = max_range_m.value_or(camera.max_range_m);
  SACCADE_CHECK(camera.validate());
  return camera;
}

std::string Intrinsics::doubt(const PinholeCamera& camera) {
  constexpr double kFarOutside{0.5};  // images that were cropped have it a little outside
  const auto outside = [](double at_px, int size_px) {
    return std::max({0.0, -at_px, at_px - static_cast<double>(size_px)}) / static_cast<double>(size_px);
  };
  const double widths = outside(camera.cx, camera.width);
  const double heights = outside(camera.cy, camera.height);
  if (!(std::max(widths, heights) > kFarOutside)) return {};
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%.1f", std::max(widths, heights));
  return std::string{"the principal point lies "} + number.data() +
         (widths >= heights ? " image widths" : " image heights") + " outside of the image of " +
         std::to_string(camera.width) + "x" + std::to_string(camera.height) +
         " pixels: check the intrinsics fx,fy,cx,cy";
}

Result<Intrinsics> parse_intrinsics(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && text[first] == '{') return from_json(text);
  if (text.find("camera_matrix:") != std::string_view::npos) return parse_opencv_camera(text);
  SACCADE_TRY(const std::vector<double> values, all_numbers(text));
  if (values.size() == 4) return checked({values[0], values[1], values[2], values[3], {}, {}, {}, {}, {}});
  if (values.size() == 9) {
    std::array<double, 9> k{};
    std::copy(values.begin(), values.end(), k.begin());
    return from_matrix(k);
  }
  if (values.size() == 12 || values.size() == 16) {
    return from_matrix(
        {values[0], values[1], values[2], values[4], values[5], values[6], values[8], values[9], values[10]});
  }
  return bad_intrinsics("four numbers fx,fy,cx,cy or a matrix of 3x3, 3x4 or 4x4 expected, not " +
                        std::to_string(values.size()) + " numbers");
}

Result<Intrinsics> read_intrinsics(const std::filesystem::path& path) {
  SACCADE_TRY(const std::string text, read_text_file(path));
  auto intrinsics = parse_intrinsics(text);
  if (!intrinsics) {
    Error error = intrinsics.error();
    error.context = path.string() + ", " + error.context;
    return error;
  }
  return intrinsics;
}

nlohmann::json camera_to_json(const PinholeCamera& camera) {
  return {{"width", camera.width},
          {"height", camera.height},
          {"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"min_range_m", camera.min_range_m},
          {"max_range_m", camera.max_range_m}};
}

Result<CamInfo> parse_cam_info(std::string_view text) {
  CamInfo info;
  for (const Section& section : sections_of(text)) SACCADE_CHECK(add_section(info, section));
  if (info.color.fx <= 0.0) return Error{Errc::corrupt_data, "no 'Color camera intrinsic matrix' section", {}};
  return info;
}

Result<std::vector<PixelPolygon>> parse_polygons(std::string_view json_text) {
  const Error shape{Errc::corrupt_data, "a mask must be an array of polygons, each an array of [u, v] points", {}};
  SACCADE_TRY(const nlohmann::json document, parse_json(json_text));
  if (!document.is_array()) return shape;
  std::vector<PixelPolygon> polygons;
  for (const nlohmann::json& element : document) {
    if (!element.is_array()) return shape;
    PixelPolygon polygon;
    for (const nlohmann::json& point : element) {
      if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number()) return shape;
      polygon.emplace_back(point[0].get<double>(), point[1].get<double>());
    }
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

}  // namespace saccade
