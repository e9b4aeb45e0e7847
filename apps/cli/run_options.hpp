// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunOptions: how a simulated exploration goes, as the command line says it.

#include "options.hpp"
#include "saccade/explore/simulated_run.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

struct RunOptions {
  SimulatedRunConfig run;

  // As they were given, before they are checked together.
  double radius_m{0.8};
  CameraOptions camera;
};

/// Adds --max-views, --min-gain, --gain-width, --radius, --voxel-size, --no-noise, --sensor and the camera's options.
void add_run_options(CLI::App& command, RunOptions& options);
/// After parsing: fills `run` but for its strategy and seed, and throws a usage error for what makes no sense.
void check_run_options(RunOptions& options);
/// Of the simulated camera's depth, for people.
[[nodiscard]] std::string noise_name(const SimulatedRunConfig& run);

}  // namespace saccade::cli
