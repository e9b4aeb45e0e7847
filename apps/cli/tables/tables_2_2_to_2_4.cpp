// SPDX-License-Identifier: Apache-2.0
// Tables 2.2 to 2.4: GMM-AS and the ZVC-like detector on the recorded hands; as recorded, at other speeds, with noise.
#include "summary.hpp"
#include "tables/hand_rates.hpp"

namespace saccade::cli {
namespace {

/// The rows of one condition, the thesis' first.
void add_rows(std::vector<HandRatesRow>& rows, HandRatesRow row, const thesis::Rates& zvc, const thesis::Rates& gmm) {
  row.algorithm = kZvcLike;
  row.thesis = zvc;
  rows.push_back(row);
  row.algorithm = kGmmAs;
  row.thesis = gmm;
  rows.push_back(row);
  row.algorithm = kOurDetector;
  row.thesis = std::nullopt;
  rows.push_back(std::move(row));
}

HandRatesRow as_printed(HandRatesRow row) {
  row.algorithm.as_printed = true;
  return row;
}

void add_tasks(std::vector<HandRatesRow>& rows, const char* name, const char* figure, HandTasks tasks,
               const thesis::TaskRates& thesis) {
  HandRatesRow row;
  row.condition = name;
  row.conditions = {{"tasks", figure}};
  row.tasks = tasks;
  const std::size_t first = rows.size();
  add_rows(rows, std::move(row), thesis.zvc, thesis.gmm);
  rows.push_back(as_printed(rows[first]));
  rows.push_back(as_printed(rows[first + 1]));
}

}  // namespace

Result<ReproducedTable> reproduce_table_2_2(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  HandRatesSpec spec;
  spec.caption = "Table 2.2: detectors of hand actions: precision / recall, %";
  spec.condition = "tasks";
  add_tasks(spec.rows, "placements and removals", "placements_removals", HandTasks::placements_and_removals,
            thesis::kTable2_2PlacementsAndRemovals);
  add_tasks(spec.rows, "pick-and-place", "pick_and_place", HandTasks::pick_and_place, thesis::kTable2_2PickAndPlace);
  spec.notes = {
      "As printed: eq. 2.13 and POITh = 2.5; ZVCTh = 1.72, and nothing about ends. A saliency with a unit is hardly "
      "ever "
      "2.5 times that of the neighbours."};
  return hand_rates_table(std::move(spec), options, executor, progress);
}

Result<ReproducedTable> reproduce_table_2_3(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  HandRatesSpec spec;
  spec.caption = "Table 2.3: detectors of hand actions at other speeds: precision / recall, %";
  spec.condition = "speed";
  for (const thesis::ConditionRates& thesis : thesis::kTable2_3) {
    HandRatesRow row;
    row.condition = fixed(thesis.speed, 2);
    row.conditions = {{"speed", thesis.speed}};
    row.speed = thesis.speed;
    add_rows(spec.rows, std::move(row), thesis.zvc, thesis.gmm);
  }
  spec.notes = {"Speed is so many times the samples, resampled linearly: 0.25 gives a quarter of them."};
  return hand_rates_table(std::move(spec), options, executor, progress);
}

Result<ReproducedTable> reproduce_table_2_4(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  HandRatesSpec spec;
  spec.caption = "Table 2.4: detectors of hand actions under noise: precision / recall, %";
  spec.condition = "noise";
  for (const thesis::ConditionRates& thesis : thesis::kTable2_4) {
    HandRatesRow row;
    row.condition = fixed(100.0 * thesis.sigma_m, 1) + " cm";
    row.conditions = {{"noise_m", thesis.sigma_m}};
    row.sigma_m = thesis.sigma_m;
    add_rows(spec.rows, std::move(row), thesis.zvc, thesis.gmm);
  }
  spec.notes = {"Normal noise of this standard deviation on each coordinate, at speed 1. Counts are summed over " +
                    std::to_string(options.noise_seeds) + " seeds of the noise, from " + std::to_string(options.seed) +
                    " on.",
                "10 of the 440 labels of all four users are farther than 20 cm from every sample: the thesis' recall "
                "of 98.4 % is "
                "above what these labels allow, 97.7 %."};
  return hand_rates_table(std::move(spec), options, executor, progress);
}

}  // namespace saccade::cli
