// SPDX-License-Identifier: Apache-2.0
#include "experiments/surfel_close_ups.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "saccade/report/segment_picture.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/surfel_picture.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::BestSegments;
using thesis::SurfelColors;
using thesis::SurfelTrial;

constexpr int kTileWidth_px{560};
constexpr int kTileHeight_px{420};
constexpr int kBetween_px{10};

Viewpoint view_of(const CloseUp& close_up) {
  Viewpoint view;
  view.camera.width = kTileWidth_px;
  view.camera.height = kTileHeight_px;
  view.camera.fx = view.camera.fy = 0.5 * kTileHeight_px / std::tan(0.5 * close_up.field_of_view_rad);
  view.camera.cx = 0.5 * (kTileWidth_px - 1);
  view.camera.cy = 0.5 * (kTileHeight_px - 1);
  view.T_world_camera = look_at(close_up.eye, close_up.target);
  return view;
}

SurfelDiscs discs_of(const PointCloud& cloud) { return {cloud.positions_m, cloud.normals, cloud.radii_m}; }

std::vector<Rgb8> own_colors(const PointCloud& cloud) {
  std::vector<Rgb8> colors;
  for (const Eigen::Vector3f& color : cloud.colors) colors.push_back(byte_color(color));
  return colors;
}

/// For each segment of `after` the one of `before` that it shares most surfels with, if that shares most with it.
std::vector<std::size_t> same_as_before(const BestSegments& before, const BestSegments& after) {
  std::unordered_map<std::uint64_t, std::size_t> shared;
  for (std::size_t i = 0; i < after.labels.size(); ++i) {
    if (before.labels[i] == kUnlabelled || after.labels[i] == kUnlabelled) continue;
    ++shared[(std::uint64_t{before.labels[i]} << 32U) | after.labels[i]];
  }
  struct Most {
    std::size_t surfels{0};
    std::size_t other{static_cast<std::size_t>(-1)};
    void offer(std::size_t count, std::size_t label) {
      if (count > surfels || (count == surfels && label < other)) *this = {count, label};
    }
  };
  std::vector<Most> of_before(before.count);
  std::vector<Most> of_after(after.count);
  for (const auto& [labels, surfels] : shared) {
    const auto a = static_cast<std::size_t>(labels >> 32U);
    const auto b = static_cast<std::size_t>(labels & 0xFFFFFFFFU);
    of_before[a].offer(surfels, b);
    of_after[b].offer(surfels, a);
  }
  std::vector<std::size_t> same(after.count, static_cast<std::size_t>(-1));
  for (std::size_t b = 0; b < after.count; ++b) {
    const std::size_t a = of_after[b].other;
    if (a < before.count && of_before[a].other == b) same[b] = a;
  }
  return same;
}

/// A colour per segment: the larger ones come first, so that those differ most; what is the same in both is coloured
/// alike.
std::array<std::vector<Rgb8>, 2> colors_of_segments(const std::array<BestSegments, 2>& segments) {
  std::vector<std::size_t> surfels(segments[0].count);
  for (const std::uint32_t label : segments[0].labels) {
    if (label != kUnlabelled) ++surfels[label];
  }
  std::vector<std::size_t> order(segments[0].count);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return surfels[a] > surfels[b]; });
  const std::vector<Rgb8> palette = segment_colors(segments[0].count + segments[1].count);
  std::array<std::vector<Rgb8>, 2> colors;
  colors[0].resize(segments[0].count);
  for (std::size_t i = 0; i < order.size(); ++i) colors[0][order[i]] = palette[i];
  std::size_t next{segments[0].count};
  for (const std::size_t same : same_as_before(segments[0], segments[1])) {
    colors[1].push_back(same < segments[0].count ? colors[0][same] : palette[next++]);
  }
  return colors;
}

/// What is seen in the picture.
struct Sight {
  std::size_t surfels{0};
  std::size_t segments{0};
  std::size_t single{0};   ///< segments of one surfel alone
  double background{0.0};  ///< share of the pixels that show no surfel
};

Sight sight_of(const PointCloud& cloud, const BestSegments* segments, const Viewpoint& view, const Executor& executor) {
  const SurfelView seen = view_surfels(discs_of(cloud), view.camera, view.T_world_camera, executor);
  std::vector<SurfelId> ids = seen.seen.pixels();
  Sight sight;
  sight.background = static_cast<double>(std::count(ids.begin(), ids.end(), kNoSurfel)) / double(ids.size());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  if (!ids.empty() && ids.back() == kNoSurfel) ids.pop_back();
  sight.surfels = ids.size();
  if (segments == nullptr) return sight;
  std::vector<std::size_t> sizes(segments->count);
  for (const std::uint32_t label : segments->labels) {
    if (label != kUnlabelled) ++sizes[label];
  }
  std::vector<std::uint32_t> labels;
  for (const SurfelId id : ids) labels.push_back(segments->labels[id]);
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  for (const std::uint32_t label : labels) {
    if (label == kUnlabelled) continue;
    ++sight.segments;
    sight.single += sizes[label] == 1 ? 1 : 0;
  }
  return sight;
}

ColorImage one_above_the_other(const ColorImage& above, const ColorImage& below) {
  ColorImage both{above.width(), above.height() + kBetween_px + below.height(), Rgb8{255, 255, 255}};
  paste(both, 0, 0, above);
  paste(both, 0, above.height() + kBetween_px, below);
  return both;
}

constexpr std::array<const char*, 2> kCloudTitles{"not enhanced", "enhanced"};

}  // namespace

Result<ReproducedTable> reproduce_segments(const CloseUp& close_up, const TableOptions& options,
                                           const Executor& executor, const Progress& progress, SurfelExperiments& all) {
  SACCADE_TRY(const auto trial, surfel_trial(options, close_up.scene, executor, progress, all));
  const Viewpoint view = view_of(close_up);
  std::array<BestSegments, 2> segments;
  for (const SurfelColors colors : thesis::kSurfelColors) {
    SACCADE_TRY(segments[static_cast<std::size_t>(colors)],
                best_segments(*trial, close_up.by_flood_fill, colors, executor));
  }
  const std::array<std::vector<Rgb8>, 2> colors = colors_of_segments(segments);
  ReproducedTable table;
  const char* const algorithm = close_up.by_flood_fill ? "flood fill" : "supervoxels and LCCP";
  table.caption = std::string{"Fig. "} + close_up.number + ": close-up of " + trial->scene +
                  ", surfels and segments by " + algorithm + "; " + close_up.shows;
  table.columns = {"cloud", "threshold of least BCE", "BCE", "surfels in sight", "segments in sight", "of one surfel"};
  json rows = json::array();
  Sheet sheet;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const PointCloud& cloud = trial->clouds[i];
    const Sight sight = sight_of(cloud, &segments[i], view, executor);
    table.rows.push_back({kCloudTitles[i], fixed(segments[i].threshold, 3), fixed(segments[i].bce, 3),
                          std::to_string(sight.surfels), std::to_string(sight.segments), std::to_string(sight.single)});
    rows.push_back({{"cloud", kCloudTitles[i]},
                    {"threshold", segments[i].threshold},
                    {"bce", segments[i].bce},
                    {"surfels", sight.surfels},
                    {"segments", sight.segments},
                    {"of_one_surfel", sight.single}});
    std::vector<Rgb8> of_surfel;
    for (const std::uint32_t label : segments[i].labels) {
      of_surfel.push_back(label == kUnlabelled ? Rgb8{110, 112, 118} : colors[i][label]);
    }
    sheet.panels.push_back({one_above_the_other(draw_surfels(discs_of(cloud), own_colors(cloud), view, executor),
                                                draw_surfels(discs_of(cloud), of_surfel, view, executor)),
                            kCloudTitles[i],
                            {},
                            {},
                            {}});
  }
  table.notes = {
      "Segments are those at the threshold where the whole scene's BCE is least. What is in sight is what the "
      "picture shows; segments that are the same on both sides are coloured alike."};
  add_surfel_notes(options, !close_up.by_flood_fill, table);
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({std::string{close_up.file}, compose(sheet)});
  return table;
}

Result<ReproducedTable> reproduce_positions(const CloseUp& close_up, const TableOptions& options,
                                            const Executor& executor, const Progress& progress,
                                            SurfelExperiments& all) {
  SACCADE_TRY(const auto trial, surfel_trial(options, close_up.scene, executor, progress, all));
  const Viewpoint view = view_of(close_up);
  const std::vector<Rgb8> colors = own_colors(trial->clouds.back());
  ReproducedTable table;
  table.caption = std::string{"Fig. "} + close_up.number + ": close-up of " + trial->scene + ", " + close_up.shows;
  table.columns = {"positions", "surfels in sight", "background, share of the pixels"};
  json rows = json::array();
  Sheet sheet;
  for (std::size_t i = 0; i < trial->clouds.size(); ++i) {
    PointCloud cloud = trial->clouds[i];
    if (i == 1) cloud.positions_m = trial->mode_positions_m;
    const Sight sight = sight_of(cloud, nullptr, view, executor);
    table.rows.push_back({kCloudTitles[i], std::to_string(sight.surfels), fixed(sight.background, 3)});
    rows.push_back({{"cloud", kCloudTitles[i]}, {"surfels", sight.surfels}, {"background", sight.background}});
    sheet.panels.push_back({draw_surfels(discs_of(cloud), colors, view, executor), kCloudTitles[i], {}, {}, {}});
  }
  table.notes = {
      "Colours are those of the mode filter on both sides. Positions on the right are those of the modes with guided "
      "depths" +
      std::string{options.as_printed ? "" : ", which elsewhere are not used (decision 20)"} +
      ". The gap between panel and wall, which the thesis shows to open, is open on both: depths that differ by more "
      "than 2 cm never meet in a surfel here."};
  add_surfel_notes(options, false, table);
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({std::string{close_up.file}, compose(sheet)});
  return table;
}

}  // namespace saccade::reproduce
