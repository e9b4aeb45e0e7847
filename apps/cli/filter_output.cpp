// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "filter.hpp"
#include "saccade/core/statistics.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

std::size_t sum(const FilterResult& result, std::size_t FilteredFrame::*count) {
  std::size_t total{0};
  for (const FilteredFrame& frame : result.frames) total += frame.*count;
  return total;
}

double median_ms(const FilterResult& result) {
  std::vector<double> ms;
  for (const FilteredFrame& frame : result.frames) ms.push_back(frame.ms);
  return median(std::move(ms));
}

json frame_json(const FilteredFrame& frame) {
  return {{"frame", frame.file.string()},       {"points", frame.points},
          {"shadow", frame.shadow_points},      {"veil", frame.veil_points},
          {"out_of_range", frame.out_of_range}, {"ms", frame.ms}};
}

std::string count_and_share(std::size_t count, std::size_t of) {
  return std::to_string(count) + " (" + percent(static_cast<double>(count) / static_cast<double>(of)) + ")";
}

}  // namespace

std::size_t FilterResult::points() const { return sum(*this, &FilteredFrame::points); }

std::size_t FilterResult::out_of_range() const { return sum(*this, &FilteredFrame::out_of_range); }

json filter_json(const FilterOptions& options, const std::string& out, const FilterResult& result, bool interrupted) {
  json details = json::array();
  for (const FilteredFrame& frame : result.frames) details.push_back(frame_json(frame));
  json planned = json::array();  // for the next run into the folder, should this one not come to its end
  if (!result.is_complete()) {
    for (const std::filesystem::path& file : result.planned) planned.push_back(file.string());
  }
  json left_out = json::array();
  for (const auto& [file, error] : result.left_out) {
    const std::string name = file.string();
    const bool has_place = error.context.starts_with(name + ", ");
    const std::string place = has_place ? error.context.substr(name.size() + 2) + ": " : "";
    left_out.push_back({{"frame", name}, {"reason", place + error.message}});
  }
  return {{"out", out},
          {"frames", result.frames.size()},
          {"points", result.points()},
          {"shadow", sum(result, &FilteredFrame::shadow_points)},
          {"veil", sum(result, &FilteredFrame::veil_points)},
          {"out_of_range", result.out_of_range()},
          {"ms_per_frame", {{"median", median_ms(result)}}},
          {"method", kDepthFilterMethodNames.of(options.filter.method)},
          {"baseline_m", options.filter.baseline_m},
          {"emitter_side", kEmitterSideNames.of(options.filter.emitter_side)},
          {"veil_angle_rad", options.filter.veil_angle_rad},
          {"steps", {{"shadow", options.filter.remove_shadow_points}, {"veil", options.filter.remove_veil_points}}},
          {"depth_scale", options.encoding.units_per_m},
          {"interrupted", interrupted},
          {"complete", result.is_complete()},
          {"planned", std::move(planned)},
          {"left_out", std::move(left_out)},
          {"details", std::move(details)}};
}

std::string filter_text(const std::string& out, const FilterResult& result) {
  std::ostringstream text;
  const std::size_t points = result.points();
  const Summary summary{text};
  summary.line("frames", std::to_string(result.frames.size()) + " filtered, " + std::to_string(result.left_out.size()) +
                             " left out");
  summary.line("points", std::to_string(points));
  summary.line("shadow", count_and_share(sum(result, &FilteredFrame::shadow_points), points));
  summary.line("veil", count_and_share(sum(result, &FilteredFrame::veil_points), points));
  const std::size_t out_of_range = result.out_of_range();
  if (out_of_range > 0) summary.line("out of range", std::to_string(out_of_range) + " more, removed as well");
  summary.line("per frame", fixed(median_ms(result), 2) + " ms (median, of the filter alone)");
  summary.line("results", out);
  return text.str();
}

std::string filter_range_warning(const FilterResult& result) {
  constexpr double kMost{0.9};  // a room behind the subject is often out of range
  const std::size_t measured = result.points() + result.out_of_range();
  const double share =
      static_cast<double>(result.out_of_range()) / static_cast<double>(std::max<std::size_t>(1, measured));
  if (!(share > kMost)) return {};
  return "warning: " + percent(share) +
         " of the measured pixels lie outside of the camera's range and were removed: see --depth-scale, --min-range "
         "and --max-range";
}

}  // namespace saccade::cli
