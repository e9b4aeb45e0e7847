// SPDX-License-Identifier: Apache-2.0
#pragma once
// hand_rates_table: precision and recall of detectors of hand actions beside the thesis', for Tables 2.2 to 2.4.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tables/hand_data.hpp"
#include "tables/thesis_table.hpp"
#include "thesis/hand_figures.hpp"

namespace saccade::cli {

struct HandAlgorithm {
  std::string_view name;    ///< in the thesis
  std::string_view method;  ///< of `saccade attend`
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
  std::optional<thesis::Rates> thesis;  ///< of ours there is none
  std::optional<HandTasks> tasks;       ///< none: all
  double speed{1.0};
  double sigma_m{0.0};
};

struct HandRatesSpec {
  std::string caption;
  std::string condition;  ///< name of the first column
  std::vector<HandRatesRow> rows;
  std::vector<std::string> notes;  ///< of this table, after those that all have
};

/// Runs every row's detector on the recorded hands, trajectories in parallel; rows with noise over options.noise_seeds
/// seeds from options.seed on, their counts summed. The same figures for every thread count.
/// @return what read_hand_data says; cancelled.
[[nodiscard]] Result<ReproducedTable> hand_rates_table(HandRatesSpec spec, const ReproduceOptions& options,
                                                       const Executor& executor, const Progress& progress);

}  // namespace saccade::cli
