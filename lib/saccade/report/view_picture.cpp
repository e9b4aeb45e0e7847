// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/view_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/internal/orientation_marks.hpp"
#include "saccade/report/sheet.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kBestColor{214, 28, 92};
constexpr Rgb8 kNoGain{176, 180, 188};

/// Poses that share a centre (rolls), with the best gain among them.
struct Center {
  Eigen::Vector3d p_world;
  double gain{0.0};
  std::string ranks;
};

std::vector<Center> centers_of(std::span<const ScoredPose> ranked, std::size_t best) {
  std::vector<Center> centers;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const Eigen::Vector3d p = ranked[i].T_world_camera.translation();
    auto it = std::find_if(centers.begin(), centers.end(),
                           [&](const Center& c) { return (c.p_world - p).squaredNorm() < 1e-10; });
    if (it == centers.end()) it = centers.insert(centers.end(), {p, ranked[i].gain, {}});
    it->gain = std::max(it->gain, ranked[i].gain);
    if (i < best && ranked[i].gain > 0.0) it->ranks += (it->ranks.empty() ? "" : ", ") + std::to_string(i + 1);
  }
  return centers;
}

Box scene_box(const Region& region, const std::vector<Center>& centers, double margin_m) {
  Box box = bounds(region);
  for (const Center& c : centers) {
    box.min = box.min.cwiseMin(c.p_world);
    box.max = box.max.cwiseMax(c.p_world);
  }
  box.min.array() -= margin_m;
  box.max.array() += margin_m;
  return box;
}

void draw_views(Canvas& canvas, std::span<const ScoredPose> ranked, const std::vector<Center>& centers,
                const Box& scene, double full_gain, const ViewPictureConfig& config) {
  for (const Center& c : centers) {
    const bool scores = c.gain > 0.0;
    canvas.point(c.p_world, scores ? 8.0 : 5.0, scores ? amount_colors()(c.gain / full_gain) : kNoGain, 0.35);
  }
  const double frustum_m = 0.05 * (scene.max - scene.min).norm();
  const std::size_t best = std::min(config.best, ranked.size());
  for (std::size_t i = best; i-- > 0;) {  // the best last, on top
    if (ranked[i].gain <= 0.0) continue;
    const LineStyle style{kBestColor, i == 0 ? 2.6 : 1.6, 0.35};
    canvas.frustum(config.sensor, ranked[i].T_world_camera, frustum_m, style);
  }
  const Eigen::Vector3d picture_up = -canvas.view().T_world_camera.linear().col(1);
  for (const Center& c : centers) {
    if (!c.ranks.empty()) canvas.label(c.p_world + 0.35 * frustum_m * picture_up, c.ranks, kBestColor, 12.0);
  }
}

}  // namespace

ColorImage view_picture(const TsdfSnapshot& map, const Region& region, std::span<const ScoredPose> ranked,
                        const Executor& executor, const ViewPictureConfig& config) {
  const std::vector<Center> centers = centers_of(ranked, config.best);
  const Box scene = scene_box(region, centers, config.margin_m);
  const TernaryPictureConfig ternary{.unknown_within = {region}, .crop = scene, .samples = config.samples};
  const Box around = bounds(region);
  std::vector<Eigen::Vector3d> shown{around.min, around.max};
  for (const Center& c : centers) shown.push_back(c.p_world);
  Canvas canvas = draw_ternary(map, overview_of(shown, config.overview), executor, ternary);

  std::optional<ColorBar> bar;
  const auto best = std::max_element(centers.begin(), centers.end(),
                                     [](const Center& a, const Center& b) { return a.gain < b.gain; });
  if (best != centers.end() && best->gain > 0.0) {
    bar = round_bar(best->gain, "gain [" + config.gain_unit + "], best of all rolls at each position");
  }
  draw_views(canvas, ranked, centers, scene, bar ? bar->high : 1.0, config);
  draw_orientation(canvas, 0.5 * (around.min + around.max));
  std::vector<LegendEntry> legend = ternary_legend(ternary);
  legend.push_back({kBestColor, "best views, with rank"});
  legend.push_back({kNoGain, "views without gain"});
  std::array<char, 160> note{};
  if (!ranked.empty()) {
    const Eigen::Vector3d p = ranked.front().T_world_camera.translation();
    std::snprintf(note.data(), note.size(), "%zu views evaluated; the best, at (%.2f, %.2f, %.2f) m, gains %.0f %s",
                  ranked.size(), p.x(), p.y(), p.z(), ranked.front().gain, config.gain_unit.c_str());
  }
  Panel panel{canvas.finish(), {}, bar, {}, std::move(legend)};
  if (bar) panel.colors = amount_colors();
  return compose({config.title, {std::move(panel)}, note.data()});
}

}  // namespace saccade
