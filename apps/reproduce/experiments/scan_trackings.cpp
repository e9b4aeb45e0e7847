// SPDX-License-Identifier: Apache-2.0
#include "experiments/scan_trackings.hpp"

#include <algorithm>

#include "saccade/core/angle.hpp"
#include "saccade/report/plot.hpp"
#include "thesis/scan_motion.hpp"

namespace saccade::reproduce {
namespace {

using thesis::ScanTracking;

/// Fig. 2.12, one picture per quantity.
class DriftPlots {
 public:
  DriftPlots() {
    translation_.title = "Drift of egomotion: translation (thesis Fig. 2.12)";
    translation_.y_label = "translation error, mm";
    rotation_.title = "Drift of egomotion: rotation (thesis Fig. 2.12)";
    rotation_.y_label = "rotation error, °";
    for (Plot* plot : {&translation_, &rotation_}) plot->x_label = "time, s";
  }
  void add(const UpdateScenario& scenario, const ScanTracking& tracking) {
    PlotSeries series;
    series.name = "scenario " + std::to_string(scenario.number);
    if (!is_as_it_is(tracking)) series.name += ", depth too long";
    for (std::size_t i = 0; i < tracking.translation_m.size(); ++i) {
      series.x.push_back(static_cast<double>(i) / thesis::kFrameRate_hz);
    }
    PlotSeries turned = series;
    for (const double error_m : tracking.translation_m) series.y.push_back(1e3 * error_m);
    for (const double error_rad : tracking.rotation_rad) turned.y.push_back(to_deg(error_rad));
    translation_.series.push_back(std::move(series));
    rotation_.series.push_back(std::move(turned));
  }
  [[nodiscard]] std::vector<TablePlot> draw() const {
    return {{"fig-2-12-translation.svg", plot_svg(translation_)}, {"fig-2-12-rotation.svg", plot_svg(rotation_)}};
  }

 private:
  Plot translation_;
  Plot rotation_;
};

}  // namespace

thesis::ScanTrackingConfig tracking_config(const TableOptions& options) {
  thesis::ScanTrackingConfig config;
  config.frames = options.frames;
  config.seed = options.seed;
  return config;
}

Status carry_out_tracked_scans(const TableOptions& options, const Executor& executor, const Progress& progress,
                               std::optional<TrackedScans>& scans) {
  if (scans) return {};
  TrackedScans made;
  for (std::size_t i = 0; i < kScenarios.size(); ++i) {
    SACCADE_TRY(made.at(i), thesis::track_scan(kScenarios.at(i).scene, tracking_config(options), executor, progress));
  }
  scans = std::move(made);
  return {};
}

double greatest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

bool is_as_it_is(const ScanTracking& tracking) { return tracking.depth_scale == 1.0; }

std::vector<TablePlot> drift_plots(const TrackedScans& scans) {
  DriftPlots plots;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (const ScanTracking& tracking : scans.at(i)) {
      if (tracking.egomotion) plots.add(kScenarios.at(i), tracking);
    }
  }
  return plots.draw();
}

}  // namespace saccade::reproduce
