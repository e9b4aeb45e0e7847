// SPDX-License-Identifier: Apache-2.0
#pragma once
// hand_rates_table: precision and recall of detectors of hand actions beside the thesis', for Tables 2.2 to 2.4.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/hand_data.hpp"
#include "reproduced_table.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "table_options.hpp"
#include "thesis/hand_figures.hpp"

namespace saccade::reproduce {

struct HandAlgorithm {
  std::string_view name;    ///< in the thesis
  std::string_view method;  ///< as `saccade attend` names it
  bool as_printed{false};
};
constexpr HandAlgorithm kZvcLike{"ZVC-like", "zvc"};
constexpr HandAlgorithm kGmmAs{"GMM-AS", "gmm-as"};
constexpr HandAlgorithm kOurDetector{"ours", "ours"};

/// A row of such a table.
struct HandRatesRow {
  std::string condition;      ///< the first cell
  nlohmann::json conditions;  ///< the same for machines
  HandAlgorithm algorithm;
  std::optional<thesis::Rates> thesis;  ///< none for our detector
  std::optional<HandTasks> tasks;       ///< none: all
  double speed{1.0};
  double sigma_m{0.0};
};

struct HandRatesSpec {
  std::string caption;
  std::string condition;  ///< name of the first column
  std::vector<HandRatesRow> rows;
  std::vector<std::string> notes;  ///< added to those that all tables have
};

/// Adds the rows of one condition: both algorithms of the thesis with its figures, and Saccade's.
void add_rows(std::vector<HandRatesRow>& rows, HandRatesRow row, const thesis::Rates& zvc, const thesis::Rates& gmm);

/// Runs every row's detector on the recorded hands, trajectories in parallel; rows with noise over options.noise_seeds
/// seeds from options.seed on, their counts summed. Figures are equal for every thread count.
/// @return what read_hand_data says; cancelled.
[[nodiscard]] Result<ReproducedTable> hand_rates_table(HandRatesSpec spec, const TableOptions& options,
                                                       const Executor& executor, const Progress& progress);

}  // namespace saccade::reproduce
