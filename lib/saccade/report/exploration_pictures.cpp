// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/exploration_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/internal/orientation_marks.hpp"
#include "saccade/report/internal/surfel_canvas.hpp"
#include "saccade/report/sheet.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kChosen{214, 28, 92};
constexpr Rgb8 kEarlier{112, 119, 131};
constexpr Rgb8 kWithoutGain{176, 180, 188};
constexpr Rgb8 kMapGround{236, 239, 243};  // that of the maps

/// Averages of the pixels that a smaller picture's pixels cover.
ColorImage averaged(const ColorImage& image, int width, int height) {
  ColorImage out{width, height};
  for (int v = 0; v < height; ++v) {
    const int v0 = v * image.height() / height;
    const int v1 = std::max(v0 + 1, (v + 1) * image.height() / height);
    for (int u = 0; u < width; ++u) {
      const int u0 = u * image.width() / width;
      const int u1 = std::max(u0 + 1, (u + 1) * image.width() / width);
      std::array<int, 3> sum{};
      for (int y = v0; y < v1; ++y) {
        for (int x = u0; x < u1; ++x) {
          for (std::size_t c = 0; c < 3; ++c) sum[c] += image(x, y)[c];
        }
      }
      const int n = (v1 - v0) * (u1 - u0);
      for (std::size_t c = 0; c < 3; ++c) out(u, v)[c] = static_cast<std::uint8_t>((sum[c] + n / 2) / n);
    }
  }
  return out;
}

/// Depths as measured at the middles of a smaller picture's pixels: averages across an edge would be depths of nothing.
DepthImage thinned(const DepthImage& depth, int width, int height) {
  DepthImage out{width, height};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      out(u, v) = depth((2 * u + 1) * depth.width() / (2 * width), (2 * v + 1) * depth.height() / (2 * height));
    }
  }
  return out;
}

/// A place where candidates are: they differ in roll alone.
struct Place {
  Eigen::Vector3d p_world;
  double gain;  ///< the best; NaN: none was evaluated
};

std::vector<Place> places_of(std::span<const ScoredPose> candidates) {
  constexpr double kSame_m{1e-4};
  std::map<std::array<std::int64_t, 3>, std::size_t> index;
  std::vector<Place> places;
  for (const ScoredPose& candidate : candidates) {
    const Eigen::Vector3d p = candidate.T_world_camera.translation();
    std::array<std::int64_t, 3> key{};
    for (int axis = 0; axis < 3; ++axis) key[static_cast<std::size_t>(axis)] = std::llround(p[axis] / kSame_m);
    const auto [it, is_new] = index.try_emplace(key, places.size());
    if (is_new) places.push_back({p, candidate.gain});
    double& best = places[it->second].gain;
    if (std::isnan(best) || candidate.gain > best) best = candidate.gain;
  }
  return places;
}

/// The surfels, where there are some, else the map.
Canvas draw_known(const TsdfSnapshot& map, const DrawnSurfels* surfels, const Viewpoint& view, const Executor& executor,
                  const TernaryPictureConfig& config) {
  if (surfels == nullptr) return draw_ternary(map, view, executor, config);
  Canvas canvas{view, kMapGround, config.samples};
  draw_surfels_into(canvas, surfels->discs(), surfels->colors, executor);
  return canvas;
}

void draw_places(Canvas& canvas, const std::vector<Place>& places, double full_gain) {
  constexpr double kHidden{0.35};
  for (const Place& place : places) {
    if (place.gain > 0.0) {
      canvas.point(place.p_world, 8.0, amount_colors()(place.gain / full_gain), kHidden);
    } else {  // without gain, or NaN: not evaluated
      canvas.point(place.p_world, std::isnan(place.gain) ? 3.0 : 5.0, kWithoutGain, kHidden);
    }
  }
}

}  // namespace

ColorImage seen_picture(const Frame& frame, const DepthScale& scale, int panel_width) {
  SACCADE_EXPECTS(!frame.depth.empty() && panel_width > 0);
  SACCADE_EXPECTS(!frame.color ||
                  (frame.color->width() == frame.depth.width() && frame.color->height() == frame.depth.height()));
  constexpr int kGap{12};
  const int width = std::min(panel_width, frame.depth.width());
  const int height = std::max(1, frame.depth.height() * width / frame.depth.width());
  const int depth_x = frame.color ? width + kGap : 0;
  ColorImage page{depth_x + width, height + kScaleHeight_px, kMapGround};
  if (frame.color) paste(page, 0, 0, averaged(*frame.color, width, height));
  const Panel depth = depth_panel(thinned(frame.depth, width, height), scale, {});
  paste(page, depth_x, 0, depth.image);
  constexpr int kWide{480};    // room for the whole title
  constexpr int kNarrow{240};  // room for two ticks
  ColorBar bar = *depth.bar;
  if (width < kWide) bar.title = width < kNarrow ? "depth [m]" : "depth [m], dark: no return";
  if (width < kNarrow) bar.ticks = 2;
  draw_scale(page, depth_x, height, width, *depth.colors, bar);
  return page;
}

ColorImage candidates_picture(const CandidatesScene& scene, const Executor& executor,
                              const CandidatesPictureConfig& config) {
  const std::vector<Place> places = places_of(scene.candidates);
  const Box around = bounds(scene.region);
  std::vector<Eigen::Vector3d> shown = corners_of(around);
  shown.push_back(scene.T_world_chosen.translation());
  for (const Place& place : places) shown.push_back(place.p_world);
  Box box = around;
  for (const Eigen::Vector3d& p : shown) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  const double frustum_m = 0.08 * (box.max - box.min).norm();
  box.min.array() -= config.margin_m;
  box.max.array() += config.margin_m;
  const TernaryPictureConfig ternary{.unknown_within = {scene.region}, .crop = box, .samples = config.samples};
  const Eigen::Vector3d middle = 0.5 * (around.min + around.max);
  Canvas canvas = draw_known(scene.map, scene.surfels,
                             overview_with(scene.robot, std::move(shown), middle, config.overview), executor, ternary);
  if (scene.robot != nullptr) draw_robot(canvas, *scene.robot, executor);

  double best{0.0};
  for (const Place& place : places) best = place.gain > best ? place.gain : best;  // NaN is not greater
  std::optional<ColorBar> bar;
  if (std::isfinite(best) && best > 0.0) bar = round_bar(best, "gain [" + config.gain_unit + "]");
  draw_places(canvas, places, bar ? bar->high : 1.0);
  for (const Pose& T_world_camera : scene.T_world_earlier) {
    canvas.frustum(config.sensor, T_world_camera, 0.75 * frustum_m, {kEarlier, 1.4, 0.3});
  }
  canvas.frustum(config.sensor, scene.T_world_chosen, frustum_m, {kChosen, 3.0, 0.5});
  draw_orientation(canvas, middle);
  ColorImage map = canvas.finish();
  if (!bar) return map;
  return with_scale(map, amount_colors(), *bar, kMapGround);
}

ColorImage map_picture(const TsdfSnapshot& map, const Box& box, const Executor& executor,
                       const MapPictureConfig& config) {
  TernaryPictureConfig ternary;
  ternary.crop = Box{box.min.array() - config.margin_m, box.max.array() + config.margin_m};
  ternary.samples = config.samples;
  const Eigen::Vector3d middle = 0.5 * (box.min + box.max);
  Canvas canvas = draw_known(map, config.surfels, overview_with(config.robot, corners_of(box), middle, config.overview),
                             executor, ternary);
  if (config.robot != nullptr) draw_robot(canvas, *config.robot, executor);
  draw_orientation(canvas, middle);
  return canvas.finish();
}

}  // namespace saccade
