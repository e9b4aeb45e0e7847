// SPDX-License-Identifier: Apache-2.0
#pragma once
// SaliencyExample: a recorded hand whose mixture stands beside the one that the thesis shows, for Tables 2.5 and 2.6
// and Figs. 2.13 and 2.14.

#include <span>
#include <string>

#include "experiments/hand_data.hpp"
#include "reproduced_table.hpp"
#include "saccade/attention/gmm_as.hpp"
#include "saccade/core/progress.hpp"
#include "table_options.hpp"
#include "thesis/hand_figures.hpp"

namespace saccade::reproduce {

/// A recording whose mixture stands beside the thesis', and what it was chosen from.
struct SaliencyExample {
  RecordedHand hand;
  GmmAsResult result;
  std::size_t recordings{0};
  std::size_t least_gaussians{0};
  std::size_t most_gaussians{0};
};

/// Chooses, of the recordings of such tasks, the first by name whose number of Gaussians is nearest to `gaussians`.
/// Errors of read_hand_data and detect_by_gmm; cancelled.
[[nodiscard]] Result<SaliencyExample> choose_example(const TableOptions& options, HandTasks tasks,
                                                     std::size_t gaussians, const Progress& progress);

struct SaliencySpec {
  std::string caption;
  HandTasks tasks;
  std::span<const thesis::GaussianSaliency> printed;
};

/// Makes Table 2.5 or 2.6. Errors as above.
[[nodiscard]] Result<ReproducedTable> saliency_table(const SaliencySpec& spec, const TableOptions& options,
                                                     const Progress& progress);
/// Makes Fig. 2.13 or 2.14: where the Gaussians are. Errors as above.
[[nodiscard]] Result<ReproducedTable> mixture_figure(const SaliencySpec& spec, const std::string& file,
                                                     const TableOptions& options, const Progress& progress);

}  // namespace saccade::reproduce
