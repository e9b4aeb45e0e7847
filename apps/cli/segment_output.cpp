// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <numeric>
#include <sstream>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/io/clouds/cloud_upright.hpp"
#include "saccade/report/segment_picture.hpp"
#include "score_json.hpp"
#include "segment.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

json segments_json(const SegmentOptions& options, const SegmentFindings& findings) {
  json segments = json::array();
  for (std::size_t s = 0; s < findings.measures.size(); ++s) {
    const SegmentMeasures& measures = findings.measures[s];
    if (measures.points < options.list_from) continue;
    segments.push_back(
        {{"id", s + 1},
         {"points", measures.points},
         {"saliency", findings.saliencies[s].value},
         {"why", findings.saliencies[s].why},
         {"roundness", measures.roundness},
         {"isolation", measures.isolation},
         {"mean_m", point_json(measures.mean_m)},
         {"sizes_m", point_json(measures.sizes_m)},
         {"bounds_m", {{"min", point_json(measures.lowest_m)}, {"max", point_json(measures.highest_m)}}}});
  }
  return segments;
}

json filling_json(const SegmentOptions& options) {
  return {{"threshold", options.flood_fill.threshold},
          {"weights", {{"normal", options.flood_fill.normal_weight}, {"color", options.flood_fill.color_weight}}},
          {"radius_m", optional_json(options.truth.radius_m)},
          {"saliency", options.saliency.names},
          {"isolation_distance_m", options.measures.isolation_distance_m}};
}

json parameters_json(const SegmentOptions& options) {
  if (options.fills()) return filling_json(options);
  const SupervoxelConfig& supervoxels = options.supervoxels;
  json parameters{{"voxel_size_m", supervoxels.voxels.voxel_size_m},
                  {"seed_size_m", supervoxels.seed_spacing_m},
                  {"weights",
                   {{"spatial", supervoxels.spatial_weight},
                    {"normal", supervoxels.normal_weight},
                    {"color", supervoxels.color_weight}}},
                  {"rounds", supervoxels.rounds},
                  {"transform", supervoxels.voxels.single_camera},
                  {"concavity_rad", options.lccp.concavity_tolerance_rad},
                  {"smoothness_vox", options.lccp.smoothness},
                  {"sanity", options.lccp.sanity},
                  {"extended", options.lccp.extended_convexity},
                  {"min_size", options.lccp.min_supervoxels},
                  {"saliency", options.saliency.names},
                  {"isolation_distance_m", options.measures.isolation_distance_m}};
  if (options.method == SegmentMethod::sv_lccp) parameters["threshold"] = options.max_color_difference;
  return parameters;
}

json timings_json(const SegmentOptions& options, const SegmentFindings& findings) {
  if (options.fills()) {
    return {
        {"surfels", findings.surfels_ms}, {"flood_fill", findings.flood_fill_ms}, {"saliency", findings.saliency_ms}};
  }
  return {{"supervoxels", findings.supervoxels_ms}, {"lccp", findings.lccp_ms}, {"saliency", findings.saliency_ms}};
}

json text_or_null(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

double longest_m(const SegmentMeasures& segment) { return segment.sizes_m.maxCoeff(); }

double scrap_length_m() {
  static const double length_m{SalientObjectsConfig{}.scrap_length_m};
  return length_m;
}

/// Whether a segment comes last in an exploration, too: specks stand alone and look round.
bool is_scrap(const SegmentMeasures& segment) { return longest_m(segment) <= scrap_length_m(); }

/// The most salient first, equal ones in their order, scraps after all others.
std::vector<std::size_t> by_saliency(const SegmentFindings& findings) {
  std::vector<std::size_t> order(findings.saliencies.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const bool is_last = is_scrap(findings.measures[b]);
    if (is_scrap(findings.measures[a]) != is_last) return is_last;
    return findings.saliencies[a].value > findings.saliencies[b].value;
  });
  return order;
}

/// "21.0 cm", and "0.58 mm" below a centimetre.
std::string length_text(double length_m) {
  constexpr double kSmall_m{0.01};
  return length_m < kSmall_m ? millimetres(length_m) : fixed(100.0 * length_m, 1) + " cm";
}

/// Says that scraps come last; empty where all segments are scraps, or none is.
std::string scraps_text(const SegmentFindings& findings) {
  const std::vector<SegmentMeasures>& all = findings.measures;
  const auto scraps = std::count_if(all.begin(), all.end(), is_scrap);
  if (scraps == 0 || static_cast<std::size_t>(scraps) == all.size()) return {};
  const std::string length = " no longer than " + length_text(scrap_length_m());
  return scraps == 1 ? "1 segment" + length + " comes last, whatever its saliency\n"
                     : std::to_string(scraps) + " segments" + length + " come last, whatever their saliency\n";
}

/// Returns the distance between neighbouring surfels, in metres, from the median radius.
double spacing_of_surfels(const SegmentInput& input, const SegmentFindings& findings) {
  std::vector<float> radii_m;
  for (std::size_t i = 0; i < findings.labels.size(); ++i) {
    if (findings.labels[i] != kUnlabelled) radii_m.push_back(input.cloud.radii_m[i]);
  }
  const auto middle = radii_m.begin() + static_cast<std::ptrdiff_t>(radii_m.size() / 2);
  std::nth_element(radii_m.begin(), middle, radii_m.end());
  return static_cast<double>(*middle) / std::numbers::sqrt2;
}

/// Returns the distance, in metres, between points that fill the voxels of a surface as evenly as these on average.
double spacing_of(const SegmentOptions& options, const SegmentInput& input, const SegmentFindings& findings) {
  if (options.fills()) return spacing_of_surfels(input, findings);
  const double per_voxel = static_cast<double>(findings.points) / static_cast<double>(findings.supervoxels.voxels);
  double edge_m = options.supervoxels.voxels.voxel_size_m;
  if (options.supervoxels.voxels.single_camera) {
    double depth_m{0.0};
    for (std::size_t i = 0; i < input.cloud.positions_m.size(); ++i) {
      if (findings.labels[i] != kUnlabelled) depth_m += static_cast<double>(input.cloud.positions_m[i].z());
    }
    edge_m *= depth_m / static_cast<double>(findings.points);
  }
  return edge_m / std::sqrt(per_voxel);
}

/// Returns the normals of the points; where these have none, those of their supervoxels.
std::vector<Eigen::Vector3f> normals_of(const SegmentInput& input, const SegmentFindings& findings) {
  if (!input.cloud.normals.empty()) return input.cloud.normals;
  std::vector<Eigen::Vector3f> normals(input.cloud.positions_m.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const std::uint32_t supervoxel = findings.supervoxels.labels[i];
    if (supervoxel != kUnlabelled) normals[i] = findings.supervoxels.supervoxels[supervoxel].normal;
  }
  return normals;
}

}  // namespace

json segment_json(const SegmentOptions& options, const SegmentInput& input, const SegmentFindings& findings) {
  const auto unless_filled = [&](std::size_t count) { return options.fills() ? json(nullptr) : json(count); };
  const bool has_normals = options.fills() ? input.normals != Origin::estimate : !input.cloud.normals.empty();
  json result{{"input", options.input.string()},
              {"kind", input.is_map() ? "map" : "cloud"},
              {"method", kSegmentMethodNames.of(options.method)},
              {"as_printed", options.as_printed},
              {"parameters", parameters_json(options)},
              {"rows", input.cloud.positions_m.size()},
              {"points", findings.points},
              {"voxels", unless_filled(findings.supervoxels.voxels)},
              {"supervoxels", unless_filled(findings.supervoxels.supervoxels.size())},
              {"normals", !has_normals ? "estimated" : (input.is_map() ? "tsdf gradient" : "given")},
              {"ms", timings_json(options, findings)},
              {"found", findings.segments},
              {"listed_from", options.list_from},
              {"segments", segments_json(options, findings)},
              {"out", text_or_null(options.out.string())},
              {"picture", text_or_null(findings.points == 0 ? "" : options.picture.string())},
              {"label_kept_as", text_or_null(findings.label_kept_as)}};
  result["offset_m"] = point_json(input.cloud.offset_m);
  if (options.fills()) result["radii"] = to_string(input.radii);
  if (findings.curve) result["curve"] = curve_json(options, *findings.curve);
  return result;
}

std::string segments_text(const SegmentOptions& options, const SegmentFindings& findings) {
  std::ostringstream text;
  const Summary summary{text};
  summary.line("points", std::to_string(findings.points));
  if (!options.fills()) summary.line("supervoxels", std::to_string(findings.supervoxels.supervoxels.size()));
  summary.line("segments", std::to_string(findings.measures.size()));
  if (options.fills()) {
    summary.line("time", fixed(findings.surfels_ms, 1) + " ms surfels, " + fixed(findings.flood_fill_ms, 1) +
                             " ms flood fill, " + fixed(findings.saliency_ms, 1) + " ms saliency");
  } else {
    summary.line("time", fixed(findings.supervoxels_ms, 1) + " ms supervoxels, " + fixed(findings.lccp_ms, 1) +
                             " ms LCCP, " + fixed(findings.saliency_ms, 1) + " ms saliency");
  }
  if (!options.out.empty()) summary.line("labels", options.out.string());
  if (!options.picture.empty()) summary.line("picture", options.picture.string());
  if (!options.report.empty()) summary.line("report", options.report.string());
  constexpr std::size_t kShown{10};
  const std::vector<std::size_t> order = by_saliency(findings);
  text << "\nsegment   points    longest  saliency  roundness  isolation  why\n";
  for (std::size_t i = 0; i < std::min(kShown, order.size()); ++i) {
    const std::size_t s = order[i];
    text << std::right << std::setw(7) << s + 1 << std::setw(9) << findings.measures[s].points << std::setw(11)
         << length_text(longest_m(findings.measures[s])) << std::setw(10) << fixed(findings.saliencies[s].value, 3)
         << std::setw(11) << fixed(findings.measures[s].roundness, 3) << std::setw(11)
         << fixed(findings.measures[s].isolation, 3) << "  " << findings.saliencies[s].why << '\n';
  }
  if (order.size() > kShown) text << "... and " << order.size() - kShown << " more, all in the JSON result\n";
  text << scraps_text(findings);
  return text.str();
}

ColorImage segment_sheet(const SegmentOptions& options, const SegmentInput& input, const SegmentFindings& findings,
                         const Executor& executor) {
  const std::vector<Eigen::Vector3f> normals = normals_of(input, findings);
  const DrawnSegments drawn{input.cloud.positions_m, normals, findings.labels, input.triangles,
                            spacing_of(options, input, findings)};
  constexpr int kWidth_px{800};
  constexpr int kHeight_px{600};
  const Upright upright = upright_of(input.file, input.cloud.positions_m, options.saliency.up);
  const Viewpoint view = upright_view_of(input.cloud.positions_m, upright, kWidth_px, kHeight_px);
  std::vector<double> values;
  for (const Saliency& saliency : findings.saliencies) values.push_back(saliency.value);
  const double most = values.empty() ? 1.0 : *std::max_element(values.begin(), values.end());
  return compose({options.input.filename().string(),
                  {segments_panel(drawn, findings.measures, view, executor),
                   saliency_panel(drawn, values, most, view, "saliency: " + options.saliency.names, executor)},
                  {}});
}

}  // namespace saccade::cli
