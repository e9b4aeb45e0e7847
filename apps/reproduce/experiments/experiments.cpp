// SPDX-License-Identifier: Apache-2.0
#include "experiments/experiments.hpp"

namespace saccade::reproduce {

Status carry_out_update_task(const TableOptions& options, const Executor& executor, const Progress& progress,
                             std::optional<thesis::UpdateTask>& task) {
  if (task) return {};
  SACCADE_TRY(task, thesis::make_update_task(options.seed, executor, progress));
  return {};
}

}  // namespace saccade::reproduce
