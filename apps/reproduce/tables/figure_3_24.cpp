// SPDX-License-Identifier: Apache-2.0
// Fig. 3.24: the simulated bar before a wall, and what of it the emitter does not light.
#include <array>
#include <map>

#include "saccade/report/sheet.hpp"
#include "tables.hpp"
#include "text.hpp"
#include "thesis/filter_trials.hpp"

namespace saccade::reproduce {
namespace {

constexpr std::array<double, 2> kShownWidths_m{0.04, 0.16};  // the thesis'
constexpr double kRange_m{8.0};                              // as in Table 3.5

Rgb8 color_of(MeasuredPixel pixel) {
  switch (pixel) {
    case MeasuredPixel::no_return: return {34, 36, 42};
    case MeasuredPixel::good: return {170, 174, 180};
    case MeasuredPixel::in_shadow: return {214, 40, 40};
    case MeasuredPixel::veil: return {49, 130, 189};
  }
  return {0, 0, 0};
}

}  // namespace

Result<ReproducedTable> figure_3_24(const TableOptions& options, Experiments& /*experiments*/, const Executor& executor,
                                    const Progress& progress) {
  ReproducedTable table;
  table.caption = "Fig. 3.24: a bar before a wall, straight from before: pixels that the emitter lights, and others";
  table.columns = {"bar", "lit", "in the emitter's shadow", "veil between bar and wall", "without a return"};
  nlohmann::json rows = nlohmann::json::array();
  Sheet sheet{"A bar before a wall (thesis Fig. 3.24)", {}, "grey: lit; red: in shadow; blue: veil"};
  SACCADE_TRY(PinholeCamera camera, camera_preset("kinect-v2"));
  camera.max_range_m = kRange_m;
  for (std::size_t i = 0; i < kShownWidths_m.size(); ++i) {
    progress.report("rendering", i, kShownWidths_m.size());
    const double width_m = kShownWidths_m.at(i);
    SACCADE_TRY(const thesis::FilterScene bar, thesis::bar_before_wall(width_m, 0.0));
    TimeOfFlightConfig measuring;
    measuring.noise.seed = options.seed;
    SACCADE_TRY(const TimeOfFlightFrame frame,
                capture_time_of_flight(bar.scene, camera, measuring, bar.T_world_camera, 0, executor));
    std::map<MeasuredPixel, std::size_t> counts;
    ColorImage picture{camera.width, camera.height};
    for (std::size_t pixel = 0; pixel < frame.truth.size(); ++pixel) {
      const MeasuredPixel measured = frame.truth.data()[pixel];
      ++counts[measured];
      picture.data()[pixel] = color_of(measured);
    }
    const std::string name = fixed(100.0 * width_m, 0) + " cm";
    table.rows.push_back({name, std::to_string(counts[MeasuredPixel::good]),
                          std::to_string(counts[MeasuredPixel::in_shadow]), std::to_string(counts[MeasuredPixel::veil]),
                          std::to_string(counts[MeasuredPixel::no_return])});
    rows.push_back({{"width_m", width_m},
                    {"lit", counts[MeasuredPixel::good]},
                    {"in_shadow", counts[MeasuredPixel::in_shadow]},
                    {"veil", counts[MeasuredPixel::veil]},
                    {"no_return", counts[MeasuredPixel::no_return]}});
    sheet.panels.push_back({std::move(picture), "bar of " + name, {}, {}, {}});
  }
  table.notes = {
      "Pixels, as the camera sees them, with the emitter 8 cm to its left. The thesis shows pictures without figures; "
      "what lies in the blue band of its right picture, which neither the emitter nor the camera sees, has no pixel."};
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws) table.pictures.push_back({"fig-3-24.png", compose(sheet)});
  return table;
}

}  // namespace saccade::reproduce
