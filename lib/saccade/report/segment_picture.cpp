// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/segment_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/internal/orientation_marks.hpp"
#include "saccade/report/internal/shading.hpp"
#include "saccade/report/mesh_picture.hpp"

namespace saccade {

namespace {

constexpr Rgb8 kSegmentGround{236, 239, 243};
constexpr Rgb8 kNoSegment{150, 154, 160};
constexpr Rgb8 kNameColor{16, 18, 24};
constexpr std::size_t kNamed{20};  // segments that are named, at most
constexpr int kNameSteps{4};       // that a name needs around it
constexpr double kNameWidth_px{36.0};
constexpr double kNameHeight_px{17.0};

Rgb8 from_hue(double hue, double saturation, double value) {
  Rgb8 color{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double k = std::fmod(5.0 - 2.0 * static_cast<double>(channel) + 6.0 * hue, 6.0);
    const double share = value * (1.0 - saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0));
    color[channel] = static_cast<std::uint8_t>(std::lround(255.0 * share));
  }
  return color;
}

const Rgb8& color_of(std::uint32_t label, std::span<const Rgb8> colors) {
  return label < colors.size() ? colors[label] : kNoSegment;
}

void draw_points(Canvas& canvas, const DrawnSegments& segments, std::span<const Rgb8> colors) {
  constexpr double kOverlap{1.5};  // so that no gaps show between discs
  constexpr double kLeast_px{1.2};
  constexpr double kMostOfWidth{0.03};  // limit where points are few or coincide, and the camera is near
  const Viewpoint& view = canvas.view();
  const double most_px = std::max(kLeast_px, kMostOfWidth * view.camera.width);
  const Pose T_camera_world = view.T_world_camera.inverse(Eigen::Isometry);
  const Eigen::Vector3d lamp = lamp_of(view);
  for (std::size_t i = 0; i < segments.positions_m.size(); ++i) {
    if (!segments.positions_m[i].allFinite()) continue;
    const Eigen::Vector3d p = segments.positions_m[i].cast<double>();
    const double z_m = (T_camera_world * p).z();
    if (!(z_m > 0.0)) continue;
    Rgb8 color = color_of(segments.labels[i], colors);
    if (!segments.normals.empty()) {
      const Eigen::Vector3d normal = segments.normals[i].cast<double>();
      const Eigen::Vector3d direction = p - view.T_world_camera.translation();
      if (normal.allFinite()) color = shaded(color, normal.stableNormalized(), direction, lamp, kColorLight);
    }
    canvas.point(p, std::clamp(kOverlap * segments.spacing_m * view.camera.fx / z_m, kLeast_px, most_px), color);
  }
}

void draw_triangles(Canvas& canvas, const DrawnSegments& segments, std::span<const Rgb8> colors,
                    const Executor& executor) {
  TriangleMesh mesh;
  mesh.vertices.assign(segments.positions_m.begin(), segments.positions_m.end());
  mesh.normals.assign(segments.normals.begin(), segments.normals.end());
  mesh.triangles.assign(segments.triangles.begin(), segments.triangles.end());
  for (const std::uint32_t label : segments.labels) mesh.colors.push_back(color_of(label, colors));
  draw_mesh(canvas, mesh, executor);
}

Canvas canvas_with(const DrawnSegments& segments, const Viewpoint& view, std::span<const Rgb8> colors,
                   const Executor& executor) {
  SACCADE_EXPECTS(segments.labels.size() == segments.positions_m.size());
  SACCADE_EXPECTS(segments.normals.empty() || segments.normals.size() == segments.positions_m.size());
  Canvas canvas{view, kSegmentGround};
  if (segments.triangles.empty()) {
    draw_points(canvas, segments, colors);
  } else {
    draw_triangles(canvas, segments, colors, executor);
  }
  return canvas;
}

/// The mean of the finite points; none without one.
std::optional<Eigen::Vector3d> middle_of(std::span<const Eigen::Vector3f> positions_m) {
  Eigen::Vector3d sum{0.0, 0.0, 0.0};
  double count{0.0};
  for (const Eigen::Vector3f& p : positions_m) {
    if (!p.allFinite()) continue;
    sum += p.cast<double>();
    count += 1.0;
  }
  return count > 0.0 ? std::optional{Eigen::Vector3d{sum / count}} : std::nullopt;
}

/// The segments with the most points, equal ones in their order.
std::vector<std::size_t> largest(std::span<const SegmentMeasures> measures) {
  std::vector<std::size_t> order(measures.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return measures[a].points > measures[b].points; });
  order.resize(std::min(order.size(), kNamed));
  return order;
}

/// Which segment is seen in each pixel, counted from 1; 0: none.
Image<std::uint32_t> seen_segments(const DrawnSegments& segments, std::size_t count, const Viewpoint& view) {
  std::vector<Rgb8> numbers;  // the segment's number in the bits of a colour
  for (std::uint32_t n = 1; n <= count; ++n) {
    numbers.push_back({static_cast<std::uint8_t>(n >> 16U), static_cast<std::uint8_t>(n >> 8U & 0xFFU),
                       static_cast<std::uint8_t>(n & 0xFFU)});
  }
  Canvas canvas{view, Rgb8{}, 1};
  DrawnSegments flat{segments};
  flat.normals = {};
  draw_points(canvas, flat, numbers);
  Image<std::uint32_t> seen{view.camera.width, view.camera.height};
  const ColorImage& picture = canvas.samples();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Rgb8& c = picture.pixels()[i];
    seen.data()[i] = std::uint32_t{c[0]} << 16U | std::uint32_t{c[1]} << 8U | c[2];
  }
  return seen;
}

/// How many steps, left, right, up or down, lead out of the segment that is seen in a pixel.
Image<int> steps_inside(const Image<std::uint32_t>& seen) {
  Image<int> steps{seen.width(), seen.height(), seen.width() + seen.height()};
  const auto lower = [&](int u, int v, int du, int dv) {
    const int x = u + du;
    const int y = v + dv;
    const bool same = x >= 0 && y >= 0 && x < seen.width() && y < seen.height() && seen(x, y) == seen(u, v);
    steps(u, v) = std::min(steps(u, v), same ? steps(x, y) + 1 : 1);
  };
  for (int v = 0; v < seen.height(); ++v) {
    for (int u = 0; u < seen.width(); ++u) {
      lower(u, v, -1, 0);
      lower(u, v, 0, -1);
    }
  }
  for (int v = seen.height() - 1; v >= 0; --v) {
    for (int u = seen.width() - 1; u >= 0; --u) {
      lower(u, v, 1, 0);
      lower(u, v, 0, 1);
    }
  }
  return steps;
}

/// Writes the numbers of the largest segments where most of each is seen around, if there is room.
void name_segments(Canvas& canvas, const DrawnSegments& segments, std::span<const SegmentMeasures> measures) {
  const Image<std::uint32_t> seen = seen_segments(segments, measures.size(), canvas.view());
  const Image<int> steps = steps_inside(seen);
  std::vector<int> most(measures.size(), 0);
  std::vector<Eigen::Vector3d> places(measures.size());
  for (std::size_t i = 0; i < segments.positions_m.size(); ++i) {
    const std::uint32_t label = segments.labels[i];
    if (label >= measures.size() || !segments.positions_m[i].allFinite()) continue;
    const Eigen::Vector3d p = segments.positions_m[i].cast<double>();
    const auto at = canvas.project(p);
    if (!at) continue;
    const auto u = static_cast<int>(std::lround(at->x()));
    const auto v = static_cast<int>(std::lround(at->y()));
    if (u < 0 || v < 0 || u >= seen.width() || v >= seen.height() || seen(u, v) != label + 1) continue;
    if (steps(u, v) <= most[label]) continue;
    most[label] = steps(u, v);
    places[label] = p;
  }
  std::vector<Eigen::Vector2d> taken;
  for (const std::size_t s : largest(measures)) {
    if (most[s] < kNameSteps) continue;
    const Eigen::Vector2d at = canvas.project(places[s]).value();
    const auto is_near = [&](const Eigen::Vector2d& other) {
      return std::abs(other.x() - at.x()) < kNameWidth_px && std::abs(other.y() - at.y()) < kNameHeight_px;
    };
    if (std::any_of(taken.begin(), taken.end(), is_near)) continue;
    taken.push_back(at);
    canvas.label(places[s], std::to_string(s + 1), kNameColor, 13.0);
  }
}

std::vector<Eigen::Vector3d> finite_points(std::span<const Eigen::Vector3f> positions_m) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : positions_m) {
    if (p.allFinite()) points.emplace_back(p.cast<double>());
  }
  return points;
}

}  // namespace

std::vector<Rgb8> segment_colors(std::size_t segments) {
  std::vector<Rgb8> colors;
  for (std::size_t s = 0; s < segments; ++s) {
    const auto turn = static_cast<double>(s);
    const double hue = std::fmod(0.58 + turn * (std::numbers::phi - 1.0), 1.0);
    constexpr std::array<double, 3> kSaturations{0.62, 0.85, 0.42};
    constexpr std::array<double, 3> kValues{0.92, 0.70, 0.98};
    colors.push_back(from_hue(hue, kSaturations[s % 3], kValues[s / 3 % 3]));
  }
  return colors;
}

ColorImage draw_segments(const DrawnSegments& segments, const Viewpoint& view, std::span<const Rgb8> colors,
                         const Executor& executor) {
  return canvas_with(segments, view, colors, executor).finish();
}

Panel segments_panel(const DrawnSegments& segments, std::span<const SegmentMeasures> measures, const Viewpoint& view,
                     const Executor& executor) {
  const std::vector<Rgb8> colors = segment_colors(measures.size());
  Canvas canvas = canvas_with(segments, view, colors, executor);
  name_segments(canvas, segments, measures);
  if (const auto middle = middle_of(segments.positions_m)) draw_orientation(canvas, *middle);
  return {
      canvas.finish(), std::to_string(measures.size()) + (measures.size() == 1 ? " segment" : " segments"), {}, {}, {}};
}

Panel saliency_panel(const DrawnSegments& segments, std::span<const double> values, double most, const Viewpoint& view,
                     std::string title, const Executor& executor) {
  const ColorBar bar = round_bar(most > 0.0 ? most : 1.0, "saliency");
  std::vector<Rgb8> colors;
  for (const double value : values) colors.push_back(amount_colors()(value / bar.high));
  return {draw_segments(segments, view, colors, executor), std::move(title), bar, amount_colors(), {}};
}

Panel marked_panel(const DrawnSegments& segments, std::span<const Rgb8> colors, std::span<const std::uint32_t> marked,
                   const Viewpoint& view, std::string title, const Executor& executor) {
  constexpr double kRim_px{11.0};
  constexpr double kHiddenOpacity{0.4};
  constexpr double kNearer{0.002};  // each disc lies before the one around it
  Canvas canvas = canvas_with(segments, view, colors, executor);
  const Eigen::Vector3d p_eye = view.T_world_camera.translation();
  for (const std::uint32_t point : marked) {
    const Eigen::Vector3d p = segments.positions_m[point].cast<double>();
    const double towards_eye = 3.0 * segments.spacing_m / std::max((p_eye - p).norm(), 3.0 * segments.spacing_m);
    const auto disc = [&](double diameter_px, const Rgb8& color, double steps) {
      const double share = std::min(0.5, towards_eye + steps * kNearer);
      canvas.point(p + share * (p_eye - p), diameter_px, color, kHiddenOpacity);
    };
    disc(kRim_px, kNameColor, 0.0);
    disc(0.75 * kRim_px, {255, 255, 255}, 1.0);
    disc(0.5 * kRim_px, color_of(segments.labels[point], colors), 2.0);
  }
  return {canvas.finish(), std::move(title), {}, {}, {}};
}

Viewpoint camera_view_of(std::span<const Eigen::Vector3f> positions_m, int width, int height) {
  Viewpoint view;
  Eigen::Array2d low{Eigen::Array2d::Constant(1e9)};
  Eigen::Array2d high{-low};
  for (const Eigen::Vector3d& p : finite_points(positions_m)) {
    if (!(p.z() > 0.0)) continue;
    const Eigen::Array2d at = p.head<2>().array() / p.z();
    low = low.min(at);
    high = high.max(at);
  }
  if ((low > high).any()) low = high = Eigen::Array2d::Zero();
  const Eigen::Array2d middle = 0.5 * (low + high);
  const Eigen::Array2d half = (0.5 * (high - low)).max(1e-3);
  constexpr double kMargin{0.96};
  PinholeCamera& camera = view.camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = kMargin * std::min(0.5 * width / half.x(), 0.5 * height / half.y());
  camera.cx = (width - 1) / 2.0 - camera.fx * middle.x();
  camera.cy = (height - 1) / 2.0 - camera.fy * middle.y();
  return view;
}

Viewpoint overview_of_points(std::span<const Eigen::Vector3f> positions_m, const OverviewConfig& config) {
  std::vector<Eigen::Vector3d> points = finite_points(positions_m);
  SACCADE_EXPECTS(!points.empty());
  // The box of all but half a percent at either end, and a tenth around it.
  Eigen::Array3d low, high;
  std::vector<double> values(points.size());
  for (const int axis : {0, 1, 2}) {
    std::transform(points.begin(), points.end(), values.begin(), [&](const Eigen::Vector3d& p) { return p[axis]; });
    std::sort(values.begin(), values.end());
    const std::size_t outliers = values.size() / 200;
    low[axis] = values[outliers];
    high[axis] = values[values.size() - 1 - outliers];
  }
  const Eigen::Array3d margin = 0.1 * (high - low);
  std::vector<Eigen::Vector3d> most;
  for (const Eigen::Vector3d& p : points) {
    if ((p.array() >= low - margin).all() && (p.array() <= high + margin).all()) most.push_back(p);
  }
  return overview_of(most.empty() ? points : most, config);
}

Viewpoint upright_view_of(std::span<const Eigen::Vector3f> positions_m, const Upright& upright, int width, int height) {
  if (upright.source == UprightSource::camera_frame) return camera_view_of(positions_m, width, height);
  OverviewConfig config;
  config.width = width;
  config.height = height;
  config.up = upright.up;
  if (upright.towards_viewer) config.azimuth_rad = azimuth_towards(*upright.towards_viewer, upright.up);
  return overview_of_points(positions_m, config);
}

}  // namespace saccade
